//! Saving results: rows and notes in a JSON file, images in a folder next to it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use lightmesh_files::{Ready, publish};

use crate::output::make_folder;
use crate::report::{free_name, slug};
use crate::{OutputError, Picture, Results, json};

impl Results {
    /// The folder of images saved with results in `path`: `thesis-pictures` next to `thesis.json`.
    pub fn pictures_folder(path: &Path) -> PathBuf {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        path.with_file_name(format!("{stem}-pictures"))
    }

    /// Writes rows and notes, without images.
    ///
    /// # Errors
    /// [`OutputError`], which names the file.
    pub fn save(&self, path: &Path) -> Result<(), OutputError> {
        Ok(publish(self.ready(path, false)?)?)
    }

    /// Writes rows and notes, and images to the [folder](Results::pictures_folder) next to them, which is created if missing.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn save_with_pictures(&self, path: &Path) -> Result<(), OutputError> {
        Ok(publish(self.ready(path, true)?)?)
    }

    /// The files that [`Results::save`] or [`Results::save_with_pictures`] writes, which appear only when they are published.
    ///
    /// # Errors
    /// [`OutputError`], which names the file or folder.
    pub fn ready(&self, path: &Path, pictures: bool) -> Result<Vec<Ready>, OutputError> {
        let mut files = Vec::new();
        let pictures = if pictures { self.ready_pictures(path, &mut files)? } else { Vec::new() };
        let results = Results { pictures, ..self.clone() }.with_rounded_values();
        files.push(Ready::with(path, &json::lines(&results))?);
        Ok(files)
    }

    /// Adds the images to `files`; returns them with the names of their files.
    fn ready_pictures(&self, path: &Path, files: &mut Vec<Ready>) -> Result<Vec<Picture>, OutputError> {
        let folder = Results::pictures_folder(path);
        make_folder(&folder)?;
        let beside = folder.file_name().unwrap_or_default().to_string_lossy();
        let (mut taken, mut pictures) = (BTreeSet::new(), self.pictures.clone());
        for picture in &mut pictures {
            let name = free_name(&slug(&picture.id), ".png", |name| taken.contains(name));
            files.push(Ready::with(folder.join(&name), &picture.png)?);
            picture.file = format!("{beside}/{name}");
            taken.insert(name);
        }
        Ok(pictures)
    }
}

#[cfg(test)]
mod tests {
    use lightmesh::image::Frame;

    use super::*;
    use crate::Row;
    use crate::report::Report;

    /// A row, and two images whose files would have the same name.
    fn results() -> Results {
        let grey = Frame::new(8, 8, vec![[0.5; 3]; 64]).unwrap();
        let mut results = crate::report::tests::results("any", |rows| {
            rows.push(Row::new("timings", [("scene", "room".into())]));
            rows[0].seconds.entry("render".to_owned()).or_default().push(0.25);
        });
        results.pictures = ["R = 1", "R: 1"].map(|title| Picture::new("p", title, &grey).unwrap()).into();
        results
    }

    #[test]
    fn rows_are_kept_without_pictures_unless_they_are_wanted() {
        let folder = tempfile::tempdir().unwrap();
        let (path, results) = (folder.path().join("a.json"), results());
        results.save(&path).unwrap();
        let bare = Results { pictures: Vec::new(), ..results.clone() };
        assert_eq!(Results::load(&path).unwrap(), bare);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);

        results.save_with_pictures(&path).unwrap();
        let files: Vec<String> =
            Results::load(&path).unwrap().pictures.into_iter().map(|picture| picture.file).collect();
        assert_eq!(files, ["a-pictures/p-r-1.png", "a-pictures/p-r-1-2.png"]);
        assert_eq!(std::fs::read(folder.path().join(&files[1])).unwrap(), results.pictures[1].png);
    }

    #[test]
    fn what_is_read_back_is_what_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let [first, second] = ["a.json", "b.json"].map(|name| folder.path().join(name));
        let values = [147.14578143982843, 1.5214273212081701e-9, 0.1 + 0.2, 2977583.0, 9199.649061238813];
        let mut results = results();
        results.rows[0].values = (0..).zip(values).map(|(index, value)| (format!("value {index}"), value)).collect();
        results.save(&first).unwrap();
        let read = Results::load(&first).unwrap();
        for (value, read) in values.iter().zip(read.rows[0].values.values()) {
            assert!((read / value - 1.0).abs() < 1e-11, "{value} became {read}");
        }
        read.save(&second).unwrap();
        assert_eq!(std::fs::read(&first).unwrap(), std::fs::read(&second).unwrap());
    }

    #[test]
    fn a_report_shows_pictures_that_were_kept_and_says_which_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.json");
        results().save_with_pictures(&path).unwrap();
        let report = Report::open(std::slice::from_ref(&path)).unwrap();
        assert_eq!(report.markdown().matches("<img").count(), 2);
        std::fs::remove_file(folder.path().join("a-pictures/p-r-1-2.png")).unwrap();
        let refused = Report::open(&[path]).unwrap_err().to_string();
        assert!(refused.contains("`p: R: 1`") && refused.contains("p-r-1-2.png"), "{refused}");
    }
}
