//! A report as Markdown, with plots and images as separate files.

use lightmesh_files::visible;

use super::document::{Block, Column, Document, Image, Table};
use super::escape;

/// Width of an image in a row, in pixels.
const WIDTH: u32 = 260;

/// The whole text.
pub(crate) fn text(document: &Document) -> String {
    let mut out = format!("# {}\n", escaped(&document.title));
    if !document.figures.is_empty() {
        let figures = document.figures.iter().map(|figure| format!("**{}** {}", figure.value, escaped(&figure.label)));
        out += &format!("\n{}\n", figures.map(|figure| format!("- {figure}")).collect::<Vec<_>>().join("\n"));
    }
    for section in &document.sections {
        out += &format!("\n## {}\n", escaped(&section.title));
        for block in &section.blocks {
            out.push('\n');
            out += &self::block(block);
        }
    }
    out
}

/// Escapes tables, tags, emphasis and invisible letters.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in visible(&text.replace('\n', " ")).chars() {
        match letter {
            '|' | '*' | '_' | '`' | '\\' => out.extend(['\\', letter]),
            '<' => out.push_str("&lt;"),
            _ => out.push(letter),
        }
    }
    out
}

fn block(block: &Block) -> String {
    match block {
        Block::Text(text) => format!("{}\n", escaped(text)),
        Block::Table(table) if table.caption.is_empty() => self::table(table),
        Block::Table(table) => format!("{}\n\n{}", escaped(&table.caption), self::table(table)),
        Block::Plot(plot) => {
            let caption = escaped(&plot.title);
            format!("![{caption}]({})\n\n{caption}\n", plot.file)
        }
        Block::Pictures(images) => row(images),
    }
}

/// The table without its caption; group headings are prepended to titles.
pub(crate) fn table(table: &Table) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut out = line(table.columns.iter().map(title).collect());
    let rules = table.columns.iter().map(|column| if column.number { "--:" } else { "---" });
    out += &format!("|{}|\n", rules.collect::<Vec<_>>().join("|"));
    for row in &table.rows {
        out += &line(row.iter().map(|cell| escaped(&cell.text)).collect());
    }
    out
}

fn title(column: &Column) -> String {
    if column.group.is_empty() {
        escaped(&column.title)
    } else {
        escaped(&format!("{}: {}", column.group, column.title))
    }
}

/// Images side by side, as a table with one row.
fn row(images: &[Image]) -> String {
    let cells =
        |cell: &dyn Fn(&Image) -> String| format!("| {} |\n", images.iter().map(cell).collect::<Vec<_>>().join(" | "));
    let pictures = cells(&|image| {
        let title = escape::escaped(&visible(&image.title));
        format!("<img src=\"{}\" width=\"{WIDTH}\" alt=\"{title}\"/>", image.file)
    });
    format!("{}|{}\n{pictures}", cells(&|image| escaped(&image.title)), "---|".repeat(images.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cannot_end_a_table() {
        let mut table = Table::new("t", "", 1);
        table.add(Column::words("a", "a|b"), ["<i> x_y\n\u{202e}\u{1b}".into()]);
        table.add(Column::numbers("n", "n").below("CPU"), ["1".into()]);
        let cells = r"| &lt;i> x\_y \\u{202e}\\u{1b} | 1 |";
        assert_eq!(super::table(&table), format!("| a\\|b | CPU: n |\n|---|--:|\n{cells}\n"));
    }
}
