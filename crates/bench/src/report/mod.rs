//! Reports: results as Markdown and as a single HTML page.
//!
//! 1. Result files are read and checked ([`Report::open`]); several are shown side by side, with rows matched by id.
//! 2. They are turned into a document: figures of the default method first, a section for each experiment, the machine and
//!    notes. Every experiment has a table of its keys, times and values, by `layout`; the thesis' timings and figure 11 have
//!    tables of their own.
//! 3. The document is rendered by `markdown` and `html`, and written with its plots and images ([`Report::write`]).

mod curves;
mod document;
mod error;
mod escape;
mod experiments;
mod headline;
mod html;
mod keys;
mod layout;
mod markdown;
mod numbers;
mod pictures;
mod plot;
mod runs;
mod select;
mod side_by_side;
mod summary;
mod thesis;

#[cfg(test)]
pub(crate) mod tests;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use document::{Block, Document, Section, Table};
pub(crate) use document::{free_name, slug};
pub use error::{PictureError, ReportError};
use lightmesh_files::{Portion, Ready, publish, read_inside};
use pictures::{Fault, Gallery};
use runs::{Run, Runs, distinct};
pub use select::{Selection, TableError};

use crate::output::make_folder;
use crate::{OutputError, Results};

/// As Markdown and as HTML.
const PAGES: [&str; 2] = ["report.md", "report.html"];

/// A report ready to be written.
#[derive(Clone, Debug)]
pub struct Report {
    document: Document,
    inputs: Vec<PathBuf>,
}

impl Report {
    /// Folders of plots and images in the folder of a report.
    pub const FOLDERS: [&str; 2] = ["plots", "pictures"];

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
        let faulty = |(run, id, reason): Fault| ReportError::Picture { path: paths[run].clone(), id, reason };
        let document = document(&named(results)).map_err(faulty)?;
        Ok(Report { document, inputs })
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
        html::page(&self.document)
    }

    /// The pages of a report in `folder`.
    pub fn pages(folder: &Path) -> [PathBuf; 2] {
        PAGES.map(|name| folder.join(name))
    }

    /// Writes `report.md` with its plots and images, and `report.html`, to `folder`, which is created if missing. All files
    /// appear together, pages after the files they refer to.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        Ok(publish(self.ready(folder)?)?)
    }

    /// The files that [`Report::write`] writes to `folder`.
    pub fn files(&self, folder: &Path) -> Vec<PathBuf> {
        let images = self.document.images().map(|image| image.file.as_str());
        images.chain(PAGES).map(|name| folder.join(name)).collect()
    }

    /// The files that [`Report::write`] writes, which appear only when they are published.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn ready(&self, folder: &Path) -> Result<Vec<Ready>, OutputError> {
        make_folder(folder)?;
        for part in Report::FOLDERS {
            if self.document.images().any(|image| image.file.starts_with(part)) {
                make_folder(&folder.join(part))?;
            }
        }
        let mut files = Vec::new();
        for image in self.document.images() {
            files.push(Ready::with(folder.join(&image.file), &image.bytes)?);
        }
        for (path, page) in Report::pages(folder).into_iter().zip([self.markdown(), self.html()]) {
            files.push(Ready::with(path, page.as_bytes())?);
        }
        Ok(files)
    }

    /// The tables by name.
    fn tables(&self) -> impl Iterator<Item = &Table> {
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

/// The whole report.
fn document(runs: &Runs) -> Result<Document, Fault> {
    let gallery = Gallery::new(runs)?;
    let mut sections = Vec::from_iter(side_by_side::section(runs, &gallery)?);
    for experiment in runs.experiments() {
        let mut blocks = layout::blocks(experiment, runs);
        // Images stand above the tables about them.
        let tables = blocks.iter().position(|block| matches!(block, Block::Table(_))).unwrap_or(blocks.len());
        blocks.splice(tables..tables, gallery.blocks(experiment)?);
        sections.push(Section { title: experiments::title(experiment), blocks });
    }
    sections.push(summary::section(runs));
    sections.extend(summary::notes(runs));
    let suites = distinct(runs.0.iter().map(|run| run.results.suite.as_str()));
    let mut document =
        Document { title: format!("Lightmesh: {}", suites.join(", ")), figures: headline::figures(runs), sections };
    document.name_files();
    Ok(document)
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
