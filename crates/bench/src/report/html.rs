//! A report as a self-contained HTML page: style, script, plots and images are embedded. Scripts sort tables, nothing else.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::document::{Block, Cell, Column, Document, Figure, Image, Section, Table};
use super::escape::escaped;
use super::summary;

const STYLE: &str = include_str!("report.css");
const SCRIPT: &str = include_str!("report.js");

/// The whole page.
pub(crate) fn page(document: &Document) -> String {
    let title = escaped(&document.title);
    let sections = || document.sections.iter().enumerate();
    let contents: String = sections()
        .map(|(index, section)| format!("<li><a href=\"#s{index}\">{}</a></li>\n", escaped(&section.title)))
        .collect();
    let body: String = sections().map(|(index, section)| self::section(index, section)).collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<h1>{title}</h1>\n{}<nav><ol>\n{contents}</ol></nav>\n</header>\n<main>\n{body}</main>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        figures(&document.figures)
    )
}

fn figures(figures: &[Figure]) -> String {
    let item = |Figure { value, label }: &Figure| {
        format!("<div><dd>{}</dd><dt>{}</dt></div>\n", escaped(value), escaped(label))
    };
    let items: String = figures.iter().map(item).collect();
    if items.is_empty() { items } else { format!("<dl class=\"figures\">\n{items}</dl>\n") }
}

fn section(index: usize, section: &Section) -> String {
    let blocks: String = section.blocks.iter().map(block).collect();
    format!("<section id=\"s{index}\">\n<h2>{}</h2>\n{blocks}</section>\n", escaped(&section.title))
}

fn block(block: &Block) -> String {
    match block {
        Block::Text(text) => format!("<p>{}</p>\n", escaped(text)),
        Block::Table(table) => self::table(table),
        Block::Plot(plot) => figure("plot", &String::from_utf8_lossy(&plot.bytes), &plot.title),
        Block::Pictures(images) => {
            format!("<div class=\"pictures\">\n{}</div>\n", images.iter().map(picture).collect::<String>())
        }
    }
}

fn picture(image: &Image) -> String {
    let [title, data] = [escaped(&image.title), STANDARD.encode(&image.bytes)];
    figure("picture", &format!("<img src=\"data:image/png;base64,{data}\" alt=\"{title}\"/>"), &image.title)
}

fn figure(class: &str, content: &str, caption: &str) -> String {
    format!("<figure class=\"{class}\">\n{content}\n<figcaption>{}</figcaption>\n</figure>\n", escaped(caption))
}

fn table(table: &Table) -> String {
    let groups: String = table.groups().iter().map(|(group, span)| heading(group, *span)).collect();
    let grouped = table.columns.iter().any(|column| !column.group.is_empty());
    let groups = if grouped { format!("<tr class=\"groups\">{groups}</tr>\n") } else { String::new() };
    let title = |column: &Column| format!("<th scope=\"col\"{}>{}</th>", class(column), escaped(&column.title));
    let titles: String = table.columns.iter().map(title).collect();
    let above = std::iter::once(None).chain(table.rows.iter().map(Some));
    let rows: String = table.rows.iter().zip(above).map(|(row, above)| line(row, above, &table.columns)).collect();
    let caption = if table.caption.is_empty() { "All rows.".to_owned() } else { escaped(&table.caption) };
    let open = if table.folded { "" } else { " open=\"\"" };
    let facts = if table.name == summary::TABLE { " class=\"facts\"" } else { "" };
    format!(
        "<details{open}>\n<summary>{caption}</summary>\n<div class=\"scroll\" tabindex=\"0\">\n<table{facts}>\n\
         <thead>\n{groups}<tr>{titles}</tr>\n</thead>\n<tbody>\n{rows}</tbody>\n</table>\n</div>\n</details>\n"
    )
}

fn heading(group: &str, span: usize) -> String {
    let [element, scope] = if group.is_empty() { ["td", ""] } else { ["th", " scope=\"colgroup\""] };
    format!("<{element}{scope} colspan=\"{span}\">{}</{element}>", escaped(group))
}

/// A row. Leading cells that repeat the cells above are dimmed, to make groups visible.
fn line(row: &[Cell], above: Option<&Vec<Cell>>, columns: &[Column]) -> String {
    let repeated = above.map_or(0, |above| row.iter().zip(above).take_while(|(cell, above)| cell == above).count());
    let cell = |(place, (cell, column)): (usize, (&Cell, &Column))| {
        let value = cell.value.map_or_else(String::new, |value| format!(" data-value=\"{value}\""));
        let repeated = if place < repeated { " data-repeated=\"\"" } else { "" };
        format!("<td{}{value}{repeated}>{}</td>", class(column), escaped(&cell.text))
    };
    format!("<tr>{}</tr>\n", row.iter().zip(columns).enumerate().map(cell).collect::<String>())
}

fn class(column: &Column) -> &'static str {
    if column.number { " class=\"number\"" } else { "" }
}
