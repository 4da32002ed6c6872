//! The files that go with a report: plots and pictures.

use std::collections::BTreeMap;

use super::document::{Block, Document};

/// A picture as PNG.
#[derive(Clone, Debug)]
struct Picture {
    size: [u32; 2],
    png: Vec<u8>,
}

/// Plots and pictures by their names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Assets {
    pictures: BTreeMap<String, Picture>,
    /// As they stand in a page, and as files.
    plots: BTreeMap<String, (String, String)>,
}

impl Assets {
    /// Keeps a picture; gives the name of its file, made from `title`.
    pub(crate) fn add_picture(&mut self, title: &str, size: [u32; 2], png: Vec<u8>) -> String {
        let base = slug(title);
        let names = std::iter::once(String::new()).chain((2..).map(|number| format!("-{number}")));
        let mut names = names.map(|ending| format!("pictures/{base}{ending}.png"));
        let file = names.find(|name| !self.pictures.contains_key(name)).unwrap_or_default();
        self.pictures.insert(file.clone(), Picture { size, png });
        file
    }

    /// Draws the plots of a document. Those without a point are taken out of it.
    pub(crate) fn draw_plots(&mut self, document: &mut Document) {
        for section in &mut document.sections {
            section.blocks.retain_mut(|block| {
                let Block::Plot(plot) = block else { return true };
                let (Some(svg), Some(file)) = (plot.svg(), plot.file()) else { return false };
                self.plots.insert(plot.name.clone(), (svg, file));
                true
            });
        }
    }

    /// A plot as it stands in a page.
    pub(crate) fn plot(&self, name: &str) -> Option<&str> {
        self.plots.get(name).map(|(svg, _)| svg.as_str())
    }

    /// Name, size and PNG of every picture.
    pub(crate) fn pictures(&self) -> impl Iterator<Item = (&str, [u32; 2], &[u8])> {
        self.pictures.iter().map(|(name, picture)| (name.as_str(), picture.size, &picture.png[..]))
    }

    /// Every file with its name in the folder.
    pub(crate) fn files(&self) -> impl Iterator<Item = (String, &[u8])> {
        let plots = self.plots.iter().map(|(name, (_, file))| (format!("plots/{name}.svg"), file.as_bytes()));
        plots.chain(self.pictures.iter().map(|(name, picture)| (name.clone(), &picture.png[..])))
    }
}

/// A name for a file from any text: small letters, digits and hyphens.
pub(crate) fn slug(text: &str) -> String {
    let words = text.to_lowercase();
    let words: Vec<&str> =
        words.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
    if words.is_empty() { "picture".to_owned() } else { words.join("-") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_are_harmless_and_distinct() {
        let mut assets = Assets::default();
        let mut add = |title| assets.add_picture(title, [1, 1], vec![]);
        let names = ["../R = 2.1", "r-2-1", "…", ""].map(&mut add);
        assert_eq!(
            names,
            ["pictures/r-2-1.png", "pictures/r-2-1-2.png", "pictures/picture.png", "pictures/picture-2.png"]
        );
    }
}
