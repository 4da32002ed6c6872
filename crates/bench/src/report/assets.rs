//! The files of a report: plots and images.

use std::collections::BTreeMap;

use super::document::{Block, Document};

/// An image as PNG.
#[derive(Clone, Debug)]
struct Picture {
    size: [u32; 2],
    png: Vec<u8>,
}

/// Plots and images by name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Assets {
    pictures: BTreeMap<String, Picture>,
    /// As embedded in a page, and as files.
    plots: BTreeMap<String, (String, String)>,
}

impl Assets {
    /// Adds an image; returns its file name, derived from `title`.
    pub(crate) fn add_picture(&mut self, title: &str, size: [u32; 2], png: Vec<u8>) -> String {
        let file = free_name(&format!("pictures/{}", slug(title)), ".png", |name| self.pictures.contains_key(name));
        self.pictures.insert(file.clone(), Picture { size, png });
        file
    }

    /// Draws the plots of a document. Plots without points are removed from it.
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

    /// A plot as embedded in a page.
    pub(crate) fn plot(&self, name: &str) -> Option<&str> {
        self.plots.get(name).map(|(svg, _)| svg.as_str())
    }

    /// Name, size and PNG of every image.
    pub(crate) fn pictures(&self) -> impl Iterator<Item = (&str, [u32; 2], &[u8])> {
        self.pictures.iter().map(|(name, picture)| (name.as_str(), picture.size, &picture.png[..]))
    }

    /// All files with their names in the folder.
    pub(crate) fn files(&self) -> impl Iterator<Item = (String, &[u8])> {
        let plots = self.plots.iter().map(|(name, (_, file))| (format!("plots/{name}.svg"), file.as_bytes()));
        plots.chain(self.pictures.iter().map(|(name, picture)| (name.clone(), &picture.png[..])))
    }
}

/// The base with the extension, numbered if that name is taken.
pub(crate) fn free_name(base: &str, extension: &str, taken: impl Fn(&str) -> bool) -> String {
    let endings = std::iter::once(String::new()).chain((2..).map(|number| format!("-{number}")));
    let mut names = endings.map(|ending| format!("{base}{ending}{extension}"));
    names.find(|name| !taken(name)).unwrap_or_default()
}

/// A file name from any text: lower-case letters, digits and hyphens.
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
