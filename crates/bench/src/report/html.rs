//! A report as a self-contained HTML page: style, script, plots and images are embedded.
//!
//! The page begins with figures, then come the sections with plots and images. Tables can be folded, and sorted by
//! scripts.
//!
//! Each image is embedded once, in a hidden list, and referenced wherever it appears. Without scripts an image is shown next to its
//! reference; with scripts they are overlaid, with a slider.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::assets::Assets;
use super::document::{Block, Cell, Column, Document, Finding, Pair, Section, Shot, Table};
use super::headline::Figure;
use super::plot::Plot;
use super::{numbers, summary};

const STYLE: &str = include_str!("report.css");
const SCRIPT: &str = include_str!("report.js");

/// Escapes text for elements and attributes.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.push(letter),
        }
    }
    out
}

/// The whole page.
pub(crate) fn page(document: &Document, assets: &Assets) -> String {
    let title = escaped(&document.title);
    let ordered = ordered(&document.sections);
    let contents: String = ordered
        .iter()
        .enumerate()
        .map(|(index, section)| format!("<li><a href=\"#s{index}\">{}</a></li>\n", escaped(&section.title)))
        .collect();
    let sections: String =
        ordered.iter().enumerate().map(|(index, section)| self::section(index, section, assets)).collect();
    let figures = figures(&document.figures);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{}\
         <header>\n<h1>{title}</h1>\n{figures}<nav><ol>\n{contents}</ol></nav>\n</header>\n<main>\n{sections}</main>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        pictures(assets)
    )
}

/// What can be seen comes before what must be read: sections with plots, those with images, then the others.
fn ordered(sections: &[Section]) -> Vec<&Section> {
    let mut ordered: Vec<&Section> = sections.iter().collect();
    ordered.sort_by_key(|section| section.blocks.iter().map(rank).min());
    ordered
}

/// The place of a block in a section, and of its section in the page.
fn rank(block: &Block) -> u8 {
    match block {
        Block::Plot(_) => 0,
        Block::Strip(_) | Block::Pair(_) => 1,
        Block::Text(_) | Block::Findings(_) | Block::Table(_) => 2,
    }
}

/// The blocks of a section in the same order. A text stays with the block that follows it.
fn ordered_blocks(blocks: &[Block]) -> Vec<&Block> {
    let mut parts: Vec<&[Block]> = blocks.split_inclusive(|block| !matches!(block, Block::Text(_))).collect();
    parts.sort_by_key(|part| part.last().map(rank));
    parts.into_iter().flatten().collect()
}

/// The figures with which the page begins.
fn figures(figures: &[Figure]) -> String {
    if figures.is_empty() {
        return String::new();
    }
    let items: String = figures
        .iter()
        .map(|Figure { value, label }| format!("<div><dd>{}</dd><dt>{}</dt></div>\n", escaped(value), escaped(label)))
        .collect();
    format!("<dl class=\"figures\">\n{items}</dl>\n")
}

/// All images, to be referenced.
fn pictures(assets: &Assets) -> String {
    let images = assets.pictures().fold(String::new(), |mut out, (file, [width, height], png)| {
        let data = STANDARD.encode(png);
        let _ = writeln!(
            out,
            "<image id=\"{}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{data}\"/>",
            anchor(file)
        );
        out
    });
    format!("<svg class=\"store\" width=\"0\" height=\"0\" aria-hidden=\"true\"><defs>\n{images}</defs></svg>\n")
}

/// The id by which an image is referenced.
fn anchor(file: &str) -> String {
    file.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '-' }).collect()
}

fn section(index: usize, section: &Section, assets: &Assets) -> String {
    let blocks: String = ordered_blocks(&section.blocks).into_iter().map(|block| self::block(block, assets)).collect();
    format!("<section id=\"s{index}\">\n<h2>{}</h2>\n{blocks}</section>\n", escaped(&section.title))
}

fn block(block: &Block, assets: &Assets) -> String {
    match block {
        Block::Text(text) => format!("<p>{}</p>\n", escaped(text)),
        Block::Findings(findings) => findings_list(findings),
        Block::Table(table) => self::table(table),
        Block::Plot(plot) => self::plot(plot, assets),
        Block::Strip(shots) => {
            format!("<div class=\"strip\">\n{}</div>\n", shots.iter().map(|shot| figure(shot, "")).collect::<String>())
        }
        Block::Pair(pair) => self::pair(pair),
    }
}

fn findings_list(findings: &[Finding]) -> String {
    let items: String = findings
        .iter()
        .map(|Finding { verdict, text }| {
            let word = verdict.word();
            format!("<li class=\"{word}\"><b>{word}</b><span>{}</span></li>\n", escaped(text))
        })
        .collect();
    format!("<ul class=\"findings\">\n{items}</ul>\n")
}

fn table(table: &Table) -> String {
    let grouped = table.columns.iter().any(|column| !column.group.is_empty());
    let groups: String = table.groups().iter().map(|(group, span)| heading(group, *span)).collect();
    let groups = if grouped { format!("<tr class=\"groups\">{groups}</tr>\n") } else { String::new() };
    let titles: String = table
        .columns
        .iter()
        .map(|column| format!("<th scope=\"col\"{}>{}</th>", class(column), escaped(&column.title)))
        .collect();
    let above = std::iter::once(None).chain(table.rows.iter().map(Some));
    let rows: String = table.rows.iter().zip(above).map(|(row, above)| line(row, above, &table.columns)).collect();
    let caption = if table.caption.is_empty() { "All rows.".to_owned() } else { escaped(&table.caption) };
    let scroll = format!(
        "<div class=\"scroll\" tabindex=\"0\">\n<table>\n<thead>\n{groups}<tr>{titles}</tr>\n</thead>\n\
         <tbody>\n{rows}</tbody>\n</table>\n</div>\n"
    );
    let kind = if table.name == summary::TABLE { "table facts" } else { "table" };
    let open = if table.folded { "" } else { " open=\"\"" };
    format!("<details class=\"{kind}\"{open}>\n<summary>{caption}</summary>\n{scroll}</details>\n")
}

/// A row. Leading cells that repeat the cells above are dimmed, to make groups visible.
fn line(row: &[Cell], above: Option<&Vec<Cell>>, columns: &[Column]) -> String {
    let repeated = above.map_or(0, |above| row.iter().zip(above).take_while(|(cell, above)| cell == above).count());
    let cells = row.iter().zip(columns).enumerate();
    let cells: String = cells.map(|(place, (cell, column))| self::cell(cell, column, place < repeated)).collect();
    format!("<tr>{cells}</tr>\n")
}

fn heading(group: &str, span: usize) -> String {
    if group.is_empty() {
        return format!("<td colspan=\"{span}\"></td>");
    }
    format!("<th scope=\"colgroup\" colspan=\"{span}\">{}</th>", escaped(group))
}

fn class(column: &Column) -> &'static str {
    if column.number { " class=\"number\"" } else { "" }
}

fn cell(cell: &Cell, column: &Column, repeated: bool) -> String {
    let text = escaped(&cell.text);
    let value = cell.value.map_or_else(String::new, |value| format!(" data-value=\"{value}\""));
    match cell.bar {
        Some(share) => {
            let width = 100.0 * share.clamp(0.0, 1.0);
            format!("<td class=\"number bar\"{value}><i style=\"width:{width:.1}%\"></i><span>{text}</span></td>")
        }
        None => match (column.number, repeated) {
            (true, true) => format!("<td class=\"number repeated\"{value}>{text}</td>"),
            (false, true) => format!("<td class=\"repeated\"{value}>{text}</td>"),
            (_, false) => format!("<td{}{value}>{text}</td>", class(column)),
        },
    }
}

fn plot(plot: &Plot, assets: &Assets) -> String {
    let svg = assets.plot(&plot.name).unwrap_or_default();
    format!(
        "<figure class=\"plot\">\n<div class=\"scroll\" tabindex=\"0\">\n{svg}\n</div>\n<figcaption>{}</figcaption>\n</figure>\n",
        escaped(&plot.caption)
    )
}

fn figure(shot: &Shot, class: &str) -> String {
    let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
    let title = escaped(&shot.title);
    format!("<figure{class}>\n{}\n<figcaption>{title}</figcaption>\n</figure>\n", picture(shot))
}

fn picture(shot: &Shot) -> String {
    let [width, height] = shot.size;
    format!(
        "<svg class=\"picture\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\"><use href=\"#{}\"/></svg>",
        escaped(&shot.title),
        anchor(&shot.file)
    )
}

fn pair(pair: &Pair) -> String {
    let caption = format!(
        "{} compared with {}: mean FLIP {}, RMSE {}",
        pair.picture.title,
        pair.reference.title,
        numbers::small(pair.mean_flip),
        numbers::small(pair.rmse)
    );
    format!(
        "<figure class=\"pair\">\n<div class=\"panes\">\n{}{}{}</div>\n<figcaption>{}</figcaption>\n</figure>\n",
        figure(&pair.picture, "test"),
        figure(&pair.reference, "reference"),
        figure(&pair.difference, "difference"),
        escaped(&caption)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_repeated_at_the_left_steps_back() {
        let mut table = Table::new("t", "", ["a", "b", "c"].map(|name| Column::words(name, name)).to_vec());
        table.rows = [["x", "y", "z"], ["x", "w", "z"]].map(|row| row.map(Cell::from).to_vec()).to_vec();
        let html = super::table(&table);
        assert!(html.contains("<tr><td>x</td><td>y</td><td>z</td></tr>"), "{html}");
        assert!(html.contains("<tr><td class=\"repeated\">x</td><td>w</td><td>z</td></tr>"), "{html}");
    }
}
