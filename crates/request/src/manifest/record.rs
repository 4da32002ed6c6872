//! The record of a film while it is rendered.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use lightmesh_files::{directory, identity};
use lightmesh_scene::Scene;
use xxhash_rust::xxh3::Xxh3;

use super::{Chosen, FileRecord, Folder, Record, checksum_of, digest, hex, place, read, scene, settings, write};
use crate::error::{ManifestError, RequestError};
use crate::files::PictureFiles;
use crate::film::{Film, FrameRange};
use crate::host::Host;
use crate::order::Order;
use crate::told::Told;

/// Writing the manifest takes at most one part in this many of the time.
const SHARE: u32 = 20;
/// How long a run waits for others that write the manifest, and how often it looks.
const PATIENCE: Duration = Duration::from_secs(2);
/// Seals that are remembered: others may see a manifest late.
const SEALS: usize = 64;
const LOOK: Duration = Duration::from_millis(5);

/// What is recorded of a film by this run.
pub(crate) struct Manifest {
    /// The manifest; `None` if there is none for this film.
    path: Option<PathBuf>,
    film: String,
    /// The film, with the frames that this run has finished.
    record: Record,
    /// The frames that this run renders.
    own: BTreeSet<u32>,
    /// Whether frames are finished that the manifest does not name.
    is_ahead: bool,
    written: Instant,
    cost: Duration,
    /// The last seals that it was written with.
    seals: VecDeque<String>,
}

impl Manifest {
    /// Begins a film or goes on with it: what is finished is taken out of `work`, and the manifest is written.
    ///
    /// # Errors
    /// [`ManifestError`] if the scene is not that of the film, or the manifest cannot be written; [`RequestError`] in general.
    pub(crate) fn begin(
        order: &Order,
        film: &Film,
        scene: &Scene,
        work: &mut FrameRange,
        host: &dyn Host,
    ) -> Result<Manifest, RequestError> {
        let (path, name) = place(order);
        let mut manifest = Manifest {
            path: (!order.is_from_stdin() && !film.is_movie()).then_some(path),
            film: name,
            record: Record::new(order),
            own: BTreeSet::new(),
            is_ahead: false,
            written: Instant::now(),
            cost: Duration::ZERO,
            seals: VecDeque::new(),
        };
        let Some(path) = manifest.path.clone() else { return Ok(manifest) };
        manifest.record.scene = scene::checksum(order, scene)?;
        if let Some(earlier) = &film.record {
            if earlier.scene != manifest.record.scene {
                return Err(ManifestError::Scene { path, film: manifest.film, scene: order.scene.clone() }.into());
            }
            manifest.record.chosen = earlier.chosen;
            let mut left = Vec::new();
            for &number in &work.numbers {
                if !is_finished(earlier, number, &film.files(order, number)?) {
                    left.push(number);
                }
            }
            work.skipped += work.numbers.len() - left.len();
            work.numbers = left;
        }
        manifest.own.extend(&work.numbers);
        match manifest.save() {
            // What is there belongs to somebody else.
            Err(error @ (ManifestError::Foreign { .. } | ManifestError::Damaged { .. })) if !order.request.resume => {
                host.warning(&format!("this film cannot be resumed: {}", error.told(host.words())));
                manifest.path = None;
            }
            saved => saved?,
        }
        Ok(manifest)
    }

    /// What an earlier run chose.
    pub(crate) fn chosen(&self) -> Option<Chosen> {
        self.record.chosen
    }

    /// What this run has chosen.
    pub(crate) fn choose(&mut self, chosen: Chosen) {
        self.record.chosen = Some(chosen);
    }

    /// Whether the film can be resumed.
    pub(crate) fn is_kept(&self) -> bool {
        self.path.is_some()
    }

    /// A frame is finished, and all of its files are there.
    ///
    /// # Errors
    /// [`ManifestError`] if they cannot be read, or the manifest cannot be written.
    pub(crate) fn finished(&mut self, number: u32, files: &PictureFiles) -> Result<(), ManifestError> {
        let Some(manifest) = &self.path else { return Ok(()) };
        let records = records_of(files, directory(manifest))?;
        self.record_finished(number, records)
    }

    /// The same of files that another process has looked at.
    ///
    /// # Errors
    /// [`ManifestError`] if the manifest cannot be written.
    pub(crate) fn record_finished(&mut self, number: u32, records: Vec<FileRecord>) -> Result<(), ManifestError> {
        self.record.frames.insert(number, records);
        self.is_ahead = true;
        if self.record.frames.len() == 1 || self.written.elapsed() >= SHARE * self.cost { self.save() } else { Ok(()) }
    }

    /// Writes what is not yet written.
    ///
    /// # Errors
    /// As [`Manifest::finished`].
    pub(crate) fn close(&mut self) -> Result<(), ManifestError> {
        if self.is_ahead { self.save() } else { Ok(()) }
    }

    /// Whether it was lately written with this seal.
    pub(crate) fn has_written(&self, seal: &str) -> bool {
        self.seals.iter().any(|known| known == seal)
    }

    fn save(&mut self) -> Result<(), ManifestError> {
        let Some(path) = &self.path else { return Ok(()) };
        let begin = Instant::now();
        let _turn = wait_for_turn(directory(path));
        let mut folder = read(path)?.unwrap_or_else(Folder::default);
        let mut record = self.record.clone();
        if let Some(earlier) = folder.films.remove(&self.film).filter(|earlier| earlier.is_of_same(&record)) {
            let others = earlier.frames.into_iter().filter(|(number, _)| !self.own.contains(number));
            let count = record.frames.len();
            record.frames.extend(others);
            if record.frames.len() > count {
                // Frames of other runs keep what they are made with.
                record.chosen = record.chosen.or(earlier.chosen);
            }
        }
        folder.films.insert(self.film.clone(), record);
        let seal = write(path, folder)?;
        self.seals.truncate(SEALS - 1);
        self.seals.push_front(seal);
        (self.is_ahead, self.written, self.cost) = (false, Instant::now(), begin.elapsed());
        Ok(())
    }
}

impl Record {
    fn new(order: &Order) -> Record {
        Record {
            program: env!("CARGO_PKG_VERSION").to_owned(),
            scene: String::new(),
            settings: settings::of(&order.request),
            chosen: None,
            frames: BTreeMap::new(),
        }
    }
}

impl FileRecord {
    fn of(path: &Path, folder: &Path) -> Result<FileRecord, ManifestError> {
        let (bytes, xxh3) = checksum_of(path)?;
        Ok(FileRecord { file: name_in(folder, path), bytes, xxh3 })
    }

    /// Whether these are the bytes of the file.
    pub(crate) fn is_of(&self, bytes: &[u8]) -> bool {
        let mut hash = Xxh3::new();
        hash.update(bytes);
        bytes.len() as u64 == self.bytes && hex(&hash) == self.xxh3
    }

    /// Whether the file at `path` is as recorded.
    fn is_at(&self, path: &Path) -> bool {
        let mut hash = Xxh3::new();
        fs::metadata(path).is_ok_and(|status| status.len() == self.bytes)
            && digest(path, &mut hash).is_ok()
            && hex(&hash) == self.xxh3
    }
}

/// What is recorded of the files of a frame in a film in `folder`.
pub(crate) fn records_of(files: &PictureFiles, folder: &Path) -> Result<Vec<FileRecord>, ManifestError> {
    regular(files).map(|path| FileRecord::of(path, folder)).collect()
}

/// Whether all files of a frame are there as recorded.
fn is_finished(record: &Record, number: u32, files: &PictureFiles) -> bool {
    let folder = files.picture_file().map_or(Path::new("."), directory);
    let is_recorded = |recorded: &[FileRecord], path: &Path| {
        let name = name_in(folder, path);
        recorded.iter().any(|file| file.file == name && file.is_at(path))
    };
    record.frames.get(&number).is_some_and(|recorded| regular(files).all(|path| is_recorded(recorded, path)))
}

/// The files of a frame; what is sent to a pipe or a device is gone.
fn regular(files: &PictureFiles) -> impl Iterator<Item = &Path> {
    files.paths().filter(|path| fs::metadata(path).is_ok_and(|status| status.is_file()) || !path.exists())
}

/// A file by its name in the folder, else by its path.
fn name_in(folder: &Path, path: &Path) -> String {
    let is_inside = identity(directory(path)) == identity(folder);
    let name = path.file_name().filter(|_| is_inside).unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Locks a folder against other runs, if its file system can, until the result is dropped. The manifest itself is replaced each time.
fn wait_for_turn(folder: &Path) -> Option<File> {
    let (folder, begin) = (File::open(folder).ok()?, Instant::now());
    while begin.elapsed() < PATIENCE {
        match folder.try_lock() {
            Ok(()) => return Some(folder),
            Err(fs::TryLockError::WouldBlock) => thread::sleep(LOOK),
            Err(fs::TryLockError::Error(_)) => return None,
        }
    }
    // At worst, the other run's last frames are rendered again when the film is resumed.
    None
}
