//! Reports: results as Markdown and as a single HTML page.
//!
//! 1. Result files are read and checked ([`Report::open`]); several are shown side by side, with rows matched by id.
//! 2. They are turned into a document: what was run, what follows from it, and a section for each experiment (`layouts`).
//!    Statements about where the method wins and loses are computed from the rows (`findings`, `rivals`). Experiments without a
//!    layout are shown as a table of all keys and values.
//! 3. The document is rendered by `markdown` and `html`, and written with its plots and images ([`Report::write`]).

mod assets;
mod document;
mod error;
mod findings;
mod headline;
mod html;
mod layouts;
mod likeness;
mod markdown;
mod numbers;
mod pictures;
mod plot;
mod rivals;
mod runs;
mod scale;
mod select;
mod settings;
mod side_by_side;
mod spread;
mod summary;
mod write;

#[cfg(test)]
pub(crate) mod tests;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use assets::Assets;
pub(crate) use assets::{free_name, slug};
use document::{Block, Document, Section, Table};
pub use error::{PictureError, ReportError};
use lightmesh_files::{Portion, read_inside};
use pictures::Gallery;
use runs::{Run, Runs};
pub use select::{Selection, TableError};

use crate::Results;

/// A report ready to be written.
#[derive(Clone, Debug)]
pub struct Report {
    document: Document,
    assets: Assets,
    inputs: Vec<PathBuf>,
}

impl Report {
    /// Creates a report from result files. Runs are named after their files.
    ///
    /// # Errors
    /// [`ReportError`], which names the file.
    pub fn open(paths: &[PathBuf]) -> Result<Report, ReportError> {
        let results: Result<Vec<_>, ReportError> = paths.iter().map(|path| Ok((path.clone(), opened(path)?))).collect();
        Report::new(results?)
    }

    /// Creates a report from results, each with its path.
    ///
    /// # Errors
    /// [`ReportError`] if ids are not unique or an image cannot be shown.
    pub fn new(results: Vec<(PathBuf, Results)>) -> Result<Report, ReportError> {
        for (path, results) in &results {
            check_ids(path, "rows", results.rows.iter().map(|row| &row.id))?;
            check_ids(path, "images", results.pictures.iter().map(|picture| &picture.id))?;
        }
        let inputs = results.iter().flat_map(|(path, results)| inputs(path, results)).collect();
        let paths: Vec<PathBuf> = results.iter().map(|(path, _)| path.clone()).collect();
        let faulty = |(run, id, reason): pictures::Fault| ReportError::Picture { path: paths[run].clone(), id, reason };
        let runs = named(results);
        let mut assets = Assets::default();
        let gallery = Gallery::new(&runs.0, &mut assets).map_err(faulty)?;
        let mut document = document(&runs, &gallery, &mut assets).map_err(faulty)?;
        assets.draw_plots(&mut document);
        Ok(Report { document, assets, inputs })
    }

    /// The files of results, and those of images that they refer to.
    pub fn inputs(&self) -> &[PathBuf] {
        &self.inputs
    }

    /// The report as Markdown; plots and images are files in `plots` and `pictures`.
    pub fn markdown(&self) -> String {
        markdown::text(&self.document)
    }

    /// The report as a self-contained page.
    pub fn html(&self) -> String {
        html::page(&self.document, &self.assets)
    }

    /// The tables by name.
    pub(crate) fn tables(&self) -> impl Iterator<Item = &Table> {
        self.document.sections.iter().flat_map(|section| &section.blocks).filter_map(|block| match block {
            Block::Table(table) => Some(table),
            _ => None,
        })
    }
}

/// The file of results, and those of images that it refers to.
fn inputs(path: &Path, results: &Results) -> Vec<PathBuf> {
    let pictures = results.pictures.iter().filter(|picture| !picture.file.is_empty());
    std::iter::once(path.to_owned()).chain(pictures.map(|picture| path.with_file_name(&picture.file))).collect()
}

/// Results with their images.
fn opened(path: &Path) -> Result<Results, ReportError> {
    let mut results = Results::load(path)?;
    for picture in &mut results.pictures {
        let file = path.with_file_name(&picture.file);
        let folder = path.parent().unwrap_or(Path::new(""));
        picture.png = read_inside(folder, &file, Portion::ALL).map_err(|reason| ReportError::Picture {
            path: path.to_owned(),
            id: picture.id.clone(),
            reason: PictureError::Read { path: file, reason },
        })?;
    }
    Ok(results)
}

/// The whole report. Experiments appear in the order in which suites name them.
fn document(runs: &Runs, gallery: &Gallery, assets: &mut Assets) -> Result<Document, pictures::Fault> {
    let mut sections = vec![summary::section(runs)];
    sections.extend(findings::section(runs));
    sections.extend(side_by_side::section(runs, gallery, assets)?);
    for experiment in runs.experiments() {
        let (title, mut blocks) = layouts::of(experiment, runs);
        blocks.extend(gallery.blocks(&runs.0, experiment, assets)?);
        sections.push(Section::new(title, blocks));
    }
    sections.extend(summary::notes(runs));
    let suites = runs::distinct(runs.0.iter().map(|run| run.results.suite.as_str()));
    Ok(Document { title: format!("Lightmesh: {}", suites.join(", ")), figures: headline::figures(runs), sections })
}

/// Runs with distinct names: those of their files, numbered if they are the same.
fn named(results: Vec<(PathBuf, Results)>) -> Runs {
    let mut runs: Vec<Run> = Vec::with_capacity(results.len());
    for (path, results) in results {
        let stem = path.file_stem().map_or_else(|| "results".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let mut names = std::iter::once(stem.clone()).chain((2..).map(|number| format!("{stem} {number}")));
        let label = names.find(|name| runs.iter().all(|run| run.label != *name)).unwrap_or(stem);
        runs.push(Run { label, results });
    }
    Runs(runs)
}

fn check_ids<'a>(path: &Path, what: &'static str, ids: impl Iterator<Item = &'a String>) -> Result<(), ReportError> {
    let mut seen = BTreeSet::new();
    for id in ids {
        if !seen.insert(id) {
            return Err(ReportError::Twice { path: path.to_owned(), what, id: id.clone() });
        }
    }
    Ok(())
}
