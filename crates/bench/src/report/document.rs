//! The content of a report, independent of its presentation: [`markdown`](super::markdown) and [`html`](super::html) both render
//! it. It holds its plots and images.

/// A whole report.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    pub(crate) title: String,
    /// The figures that it begins with.
    pub(crate) figures: Vec<Figure>,
    pub(crate) sections: Vec<Section>,
}

/// A large number and its meaning.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Figure {
    pub(crate) value: String,
    pub(crate) label: String,
}

/// A part with a heading.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub(crate) title: String,
    pub(crate) blocks: Vec<Block>,
}

/// One thing in a section.
#[derive(Clone, Debug)]
pub(crate) enum Block {
    /// A paragraph.
    Text(String),
    Table(Table),
    /// An SVG file.
    Plot(Image),
    /// PNG files, in a row.
    Pictures(Vec<Image>),
}

/// A plot or an image, with its file.
#[derive(Clone, Debug)]
pub(crate) struct Image {
    pub(crate) title: String,
    /// Relative to the folder of the report.
    pub(crate) file: String,
    pub(crate) bytes: Vec<u8>,
}

/// A table. Every row has a cell for each column.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// Its stable name.
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<Vec<Cell>>,
    /// Detailed: a page collapses it.
    pub(crate) folded: bool,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    /// Its stable name.
    pub(crate) name: String,
    /// Its heading.
    pub(crate) title: String,
    /// The common heading of this and neighbouring columns; empty for none.
    pub(crate) group: String,
    /// Whether it holds numbers, which are right-aligned.
    pub(crate) number: bool,
}

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Cell {
    pub(crate) text: String,
    /// The number behind the text, by which a page sorts.
    pub(crate) value: Option<f64>,
}

impl Document {
    /// Plots and images.
    pub(crate) fn images(&self) -> impl Iterator<Item = &Image> {
        self.sections.iter().flat_map(|section| &section.blocks).flat_map(|block| match block {
            Block::Plot(image) => std::slice::from_ref(image),
            Block::Pictures(images) => images,
            _ => &[],
        })
    }

    /// Numbers files that would have the same name.
    pub(crate) fn name_files(&mut self) {
        let mut taken: Vec<String> = Vec::new();
        for block in self.sections.iter_mut().flat_map(|section| &mut section.blocks) {
            let images = match block {
                Block::Plot(image) => std::slice::from_mut(image),
                Block::Pictures(images) => images,
                _ => continue,
            };
            for image in images {
                let (base, extension) = image.file.rsplit_once('.').unwrap_or((&image.file, ""));
                image.file = free_name(base, &format!(".{extension}"), |name| taken.iter().any(|known| known == name));
                taken.push(image.file.clone());
            }
        }
    }
}

impl Image {
    /// A plot, with the name of its file.
    pub(crate) fn plot(name: &str, title: String, svg: String) -> Image {
        Image { file: format!("plots/{}.svg", slug(name)), title, bytes: svg.into_bytes() }
    }

    /// An image, in a file that is named after its experiment and title.
    pub(crate) fn picture(experiment: &str, title: String, png: Vec<u8>) -> Image {
        Image { file: format!("pictures/{}.png", slug(&format!("{experiment} {title}"))), title, bytes: png }
    }
}

impl Column {
    /// A column of words.
    pub(crate) fn words(name: impl Into<String>, title: impl Into<String>) -> Column {
        Column { name: name.into(), title: title.into(), group: String::new(), number: false }
    }

    /// A column of numbers.
    pub(crate) fn numbers(name: impl Into<String>, title: impl Into<String>) -> Column {
        Column { number: true, ..Column::words(name, title) }
    }

    /// The same below a common heading.
    pub(crate) fn below(self, group: impl Into<String>) -> Column {
        Column { group: group.into(), ..self }
    }
}

impl Cell {
    /// A number, or an empty cell if there is none.
    pub(crate) fn number(value: Option<f64>, text: impl Fn(f64) -> String) -> Cell {
        Cell { text: value.map(text).unwrap_or_default(), value }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Cell {
        Cell { text: text.into(), value: None }
    }
}

impl Table {
    /// A table with a number of rows, without columns.
    pub(crate) fn new(name: impl Into<String>, caption: impl Into<String>, rows: usize) -> Table {
        let rows = vec![Vec::new(); rows];
        Table { name: name.into(), caption: caption.into(), columns: Vec::new(), rows, folded: false }
    }

    /// Adds a column with a cell for each row, unless all cells are empty.
    pub(crate) fn add(&mut self, column: Column, cells: impl IntoIterator<Item = Cell>) {
        let cells: Vec<Cell> = cells.into_iter().collect();
        if cells.iter().any(|cell| !cell.text.is_empty()) {
            self.columns.push(column);
            self.rows.iter_mut().zip(cells).for_each(|(row, cell)| row.push(cell));
        }
    }

    /// Adjacent columns under one heading, with their number.
    pub(crate) fn groups(&self) -> Vec<(&str, usize)> {
        let groups = self.columns.chunk_by(|a, b| a.group == b.group);
        groups.map(|columns| (columns[0].group.as_str(), columns.len())).collect()
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
    fn empty_columns_are_left_out_and_neighbours_share_a_heading() {
        let mut table = Table::new("t", "", 2);
        for (name, group, cells) in
            [("a", "", ["1", ""]), ("b", "CPU", ["", ""]), ("c", "CPU", ["2", "3"]), ("d", "CPU", ["4", ""])]
        {
            table.add(Column::numbers(name, name).below(group), cells.map(Cell::from));
        }
        assert_eq!(table.groups(), [("", 1), ("CPU", 2)]);
        assert_eq!(table.rows[1], ["".into(), "3".into(), "".into()]);
    }

    #[test]
    fn names_of_files_are_harmless_and_distinct() {
        let pictures = ["../R = 2.1", "r-2-1", "…", ""].map(|title| Image::picture("", title.to_owned(), vec![]));
        let section = Section { title: String::new(), blocks: vec![Block::Pictures(pictures.to_vec())] };
        let mut document = Document { title: String::new(), figures: vec![], sections: vec![section] };
        document.name_files();
        let files: Vec<&str> = document.images().map(|image| image.file.as_str()).collect();
        let expected = ["r-2-1", "r-2-1-2", "picture", "picture-2"].map(|name| format!("pictures/{name}.png"));
        assert_eq!(files, expected);
    }
}
