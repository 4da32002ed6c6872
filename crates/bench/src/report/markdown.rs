//! A report as Markdown, with plots and images as separate files.

use lightmesh_files::visible;

use super::document::{Block, Column, Document, Finding, Pair, Shot, Table};
use super::numbers;

/// Maximum width of an image in a row, in pixels.
const WIDTH: u32 = 260;

/// The whole text.
pub(crate) fn text(document: &Document) -> String {
    let mut out = format!("# {}\n", escaped(&document.title));
    for section in &document.sections {
        out += &format!("\n## {}\n", escaped(&section.title));
        for block in &section.blocks {
            out.push('\n');
            out += &self::block(block);
        }
    }
    out
}

/// Escapes tables, tags, emphasis, and what would not be seen.
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
        Block::Findings(findings) => findings.iter().map(finding).collect(),
        Block::Table(table) => format!("{}\n\n{}", escaped(&table.caption), self::table(table)),
        Block::Plot(plot) => {
            let caption = escaped(&plot.caption);
            format!("![{caption}](plots/{}.svg)\n\n{caption}\n", plot.name)
        }
        Block::Strip(shots) => row(&shots.iter().collect::<Vec<_>>()),
        Block::Pair(pair) => self::pair(pair),
    }
}

fn finding(Finding { verdict, text }: &Finding) -> String {
    format!("- **{}**: {}\n", verdict.word(), escaped(text))
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
fn row(shots: &[&Shot]) -> String {
    let cells = |cell: &dyn Fn(&Shot) -> String| {
        format!("| {} |\n", shots.iter().map(|shot| cell(shot)).collect::<Vec<_>>().join(" | "))
    };
    let pictures = cells(&|shot| {
        let width = shot.size[0].min(WIDTH);
        format!(
            "<img src=\"{}\" width=\"{width}\" alt=\"{}\"/>",
            shot.file,
            super::html::escaped(&visible(&shot.title))
        )
    });
    format!("{}|{}\n{pictures}", cells(&|shot| escaped(&shot.title)), "---|".repeat(shots.len()))
}

fn pair(pair: &Pair) -> String {
    let figures = format!("Mean FLIP {}, RMSE {}.", numbers::small(pair.mean_flip), numbers::small(pair.rmse));
    format!("{}\n{figures}\n", row(&[&pair.picture, &pair.reference, &pair.difference]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cannot_end_a_table() {
        let columns = vec![Column::words("a", "a|b"), Column::numbers("n", "n").below("CPU")];
        let mut table = Table::new("t", "", columns);
        table.rows.push(vec!["<i> x_y\n\u{202e}\u{1b}".into(), "1".into()]);
        let cells = r"| &lt;i> x\_y \\u{202e}\\u{1b} | 1 |";
        assert_eq!(super::table(&table), format!("| a\\|b | CPU: n |\n|---|--:|\n{cells}\n"));
    }
}
