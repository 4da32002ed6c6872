//! `lightmesh farm`: a film as a job for farms, in the form of Open Job Description.
//!
//! 1. The film is planned as `lightmesh render` would, and its scene is read: what cannot be rendered is refused here, not on the farm.
//! 2. What farms map or people change becomes a parameter of the job: the scene, other files that are read, folders that are written to, frames, size
//!    and quality. All other flags are arguments of the task.
//! 3. Names of files begin in the folder of the template, since the specification allows no others as defaults. What lies elsewhere has none, and is
//!    given when the job is submitted.
//! 4. A task keeps frames that are finished, by the manifest in their folder.

pub(crate) mod error;
mod template;

use std::ffi::OsStr;
use std::fs;
use std::path::{Component, Path, PathBuf, absolute};

use lightmesh::Device;
use lightmesh::request::files::is_standard;
use lightmesh::request::film::Container;
use lightmesh::request::table::Kind;
use lightmesh::request::value::{Frames, numbered};
use lightmesh::request::{FIELDS, Field, Name, Order, Plan, Request, RequestError, Words, field};
use lightmesh_files::directory;

use self::error::FarmError;
use self::template::{
    Action, Amount, Attribute, Cancelation, ChunkForm, ChunkParameter, Environment, EnvironmentActions,
    HostRequirements, Parameter, ParameterSpace, Scalar, Script, Step, TaskActions, Template,
};
use crate::args::{Chunks, FarmArgs};
use crate::failure::Failure;
use crate::output::{self, Outputs};
use crate::progress::Watcher;

/// Settings that become parameters of the job, or that the job decides.
const APART: [Name; 4] = ["frames", "size", "quality", "environment"];
/// What the program is called in the template.
const PROGRAM: &str = "{{Param.Program}}";
/// The socket of the server of a session.
const SOCKET: &str = "{{Session.WorkingDirectory}}/lightmesh.sock";
/// Where the server of a session says what it does.
const LOG: &str = "{{Session.WorkingDirectory}}/lightmesh-server.log";
/// How long a session may have no task before its server ends: one that is killed leaves it behind.
const IDLE: &str = "1h";
/// Seconds in which a task that is cancelled ends by itself.
const NOTICE: u32 = 30;
/// Seconds that a server may take to begin or to end.
const PATIENCE: u32 = 120;
/// Characters of a scene's name in that of the job.
const NAME: usize = 80;
const MIB: u64 = 1 << 20;

pub(super) fn run(args: &FarmArgs) -> Result<(), Failure> {
    let form = Form::of(&args.output)?;
    let order = args.order();
    check(&order)?;
    let outputs = Outputs::new([("-o", Some(&*args.output))])?;
    let watcher = Watcher::plain(args.quiet);
    let frames = frames_of(&order, &outputs, &watcher)?;
    let job = Job::new(args, &order)?;
    let text = form.text(&job.template(&frames));
    match is_standard(&args.output) {
        true => output::print(&text)?,
        false => output::publish(vec![output::ready(&args.output, text.as_bytes())?])?,
    }
    watcher.summary(&job.summary(&frames));
    Ok(())
}

/// The kind of a job's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Yaml,
    Json,
}

impl Form {
    fn of(path: &Path) -> Result<Form, FarmError> {
        let extension = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
        match extension.as_deref() {
            _ if is_standard(path) => Ok(Form::Yaml),
            Some("yaml" | "yml") => Ok(Form::Yaml),
            Some("json") => Ok(Form::Json),
            _ => Err(FarmError::Extension(path.to_owned())),
        }
    }

    fn text(self, template: &Template) -> String {
        match self {
            Form::Json => output::json(template),
            Form::Yaml => {
                // Many readers follow YAML 1.1, in which dates, clocks and numbers with leading zeros are not text unless they are quoted.
                let options = serde_saphyr::ser_options! { quote_all: true };
                let text = serde_saphyr::to_string_with_options(template, options);
                text.expect("all keys are strings and serialization does no I/O")
            }
        }
    }
}

/// Checks that tasks on several machines can render the film.
fn check(order: &Order) -> Result<(), FarmError> {
    let picture = order.files.output.as_deref().unwrap_or(Path::new(""));
    if Container::from_path(picture).is_some() {
        return Err(FarmError::Movie(picture.to_owned()));
    }
    if !is_standard(picture) && numbered(picture, 1).is_none() {
        return Err(FarmError::NoNumber(picture.to_owned()));
    }
    if is_standard(&order.scene) {
        return Err(FarmError::StandardInput);
    }
    let files =
        [("--frames-to", &order.files.output), ("--layers", &order.files.layers), ("--stats", &order.files.stats)];
    let is_standard = |path: &Option<PathBuf>| path.as_deref().is_some_and(is_standard);
    match files.into_iter().find(|(_, path)| is_standard(path)) {
        Some((flag, _)) => Err(FarmError::Standard { flag }),
        None => Ok(()),
    }
}

/// The frames of the film, which is planned as if none was there.
fn frames_of(order: &Order, job: &Outputs, watcher: &Watcher) -> Result<Frames, Failure> {
    let mut order = order.clone();
    (order.request.resume, order.request.skip_existing, order.request.overwrite) = (false, false, true);
    if order.request.sun.is_none() && order.request.turntable.is_none() {
        // Tasks name their frames, which makes a film of a scene that moves.
        order.request.fps.get_or_insert_default();
    }
    let plan = Plan::new(order)?;
    let scene = plan.open(watcher)?;
    job.keep_scene(&scene)?;
    let range = plan.range(&scene)?.ok_or(RequestError::NoFilm)?;
    Ok(range.frames().ok_or(RequestError::NoFilm)?)
}

/// What is known of a job.
struct Job<'a> {
    args: &'a FarmArgs,
    request: Request,
    /// Files and folders that farms map.
    paths: Vec<Parameter>,
    /// Of these, those that are given when the job is submitted.
    missing: Vec<(&'static str, PathBuf)>,
    /// The scene, as tasks name it.
    scene: String,
    /// The other flags of tasks.
    flags: Vec<String>,
}

impl<'a> Job<'a> {
    fn new(args: &'a FarmArgs, order: &Order) -> Result<Job<'a>, Failure> {
        let request = order.request.clone();
        let mut job = Job {
            args,
            request: request.clone(),
            paths: Vec::new(),
            missing: Vec::new(),
            scene: text(&order.scene)?,
            flags: Vec::new(),
        };
        if !job.scene.starts_with("builtin:") {
            job.scene = job.input("Scene", "The file of the scene.", &order.scene)?;
        }
        if let Some(environment) = &request.environment {
            let file = job.input("Environment", "The panorama that surrounds the scene.", &environment.file)?;
            let whole = environment.to_string();
            let options = &whole[text(&environment.file)?.len()..];
            job.flag("environment", Some(format!("{file}{options}")));
        }
        for field in FIELDS.iter().filter(|field| !APART.contains(&field.name)) {
            job.setting(field)?;
        }
        let outputs = [
            ("output", &order.files.output, "OutputFolder", "The folder of the frames."),
            ("layers", &order.files.layers, "LayersFolder", "The folder of the layers."),
            ("stats", &order.files.stats, "StatsFolder", "The folder of the statistics."),
        ];
        for (name, path, parameter, description) in outputs {
            if let Some(path) = path {
                let folder = job.path(parameter, description, directory(path), ["DIRECTORY", "OUT"])?;
                let file = literal(&text(Path::new(path.file_name().unwrap_or_default()))?)?;
                job.flag(name, Some(format!("{folder}/{file}")));
            }
        }
        Ok(job)
    }

    /// A setting that is given becomes a flag.
    fn setting(&mut self, field: &'static Field) -> Result<(), Failure> {
        if !field.is_given(&self.request) {
            return Ok(());
        }
        let texts = field.texts(&self.request);
        match (field.name, field.kind) {
            ("grid_file", _) => {
                let path = self.request.grid_file.clone().unwrap_or_default();
                let file = self.input("GridFile", "The saved grid of the scene.", &path)?;
                self.flag(field.name, Some(file));
            }
            (_, Kind::Switch) => self.flag(field.name, None),
            _ => {
                for text in texts {
                    self.flag(field.name, Some(literal(&text)?));
                }
            }
        }
        Ok(())
    }

    fn flag(&mut self, name: Name, value: Option<String>) {
        let flag = Words::Flags.of(name);
        match value {
            // It could be taken for a flag.
            Some(value) if value.starts_with('-') => self.flags.push(format!("{flag}={value}")),
            value => self.flags.extend([flag].into_iter().chain(value)),
        }
    }

    /// A file that is read, as a parameter; returns what stands for it.
    fn input(&mut self, name: &'static str, description: &'static str, path: &Path) -> Result<String, Failure> {
        self.path(name, description, path, ["FILE", "IN"])
    }

    fn path(
        &mut self,
        name: &'static str,
        description: &'static str,
        path: &Path,
        [object_type, data_flow]: [&'static str; 2],
    ) -> Result<String, Failure> {
        let default = match within(path, folder_of(&self.args.output)) {
            Some(inside) => Some(Scalar::Text(text(&inside)?)),
            None => {
                self.missing.push((name, absolute(path).unwrap_or_else(|_| path.to_owned())));
                None
            }
        };
        self.paths.push(Parameter {
            name,
            kind: "PATH",
            description,
            object_type: Some(object_type),
            data_flow: Some(data_flow),
            default,
            ..Parameter::default()
        });
        Ok(format!("{{{{Param.{name}}}}}"))
    }

    /// The whole job.
    fn template(&self, frames: &Frames) -> Template {
        // In the order in which people look for them: files first.
        let mut parameters = self.paths.clone();
        parameters.extend([
            of_text("Frames", "The frames, as in 1-100, 1-100:2 or 7,9.", openjd(frames)),
            of_text("Size", "Width and height of the image, as in 1920x1080.", self.value("size")),
            Parameter {
                allowed_values: choices("quality"),
                ..of_text("Quality", "How many samples an image has.", self.value("quality"))
            },
            Parameter {
                name: "FramesPerTask",
                kind: "INT",
                description: "How many frames a task renders.",
                min_value: Some(1),
                default: Some(Scalar::Whole(self.args.frames_per_task)),
                ..Parameter::default()
            },
            of_text("Program", "The program on the farm's machines.", self.args.program.clone()),
        ]);
        Template {
            specification_version: "jobtemplate-2023-09",
            extensions: vec!["TASK_CHUNKING"],
            name: name_of(&self.args.scene.scene),
            parameter_definitions: parameters,
            steps: vec![Step {
                name: "Render",
                step_environments: if self.args.no_server { Vec::new() } else { vec![server()] },
                host_requirements: self.requirements(),
                parameter_space: ParameterSpace {
                    task_parameter_definitions: vec![ChunkParameter {
                        name: "Frames",
                        kind: "CHUNK[INT]",
                        range: "{{Param.Frames}}".to_owned(),
                        chunks: ChunkForm {
                            default_task_count: "{{Param.FramesPerTask}}".to_owned(),
                            range_constraint: match self.args.chunks {
                                Chunks::Contiguous => "CONTIGUOUS",
                                Chunks::Noncontiguous => "NONCONTIGUOUS",
                            },
                        },
                    }],
                },
                script: Script { actions: TaskActions { on_run: self.task() } },
            }],
        }
    }

    /// What a task does.
    fn task(&self) -> Action {
        let mut args = vec!["render".to_owned(), self.scene.clone()];
        args.push("--frames={{Task.Param.Frames}}".to_owned());
        args.extend(["--size", "{{Param.Size}}", "--quality", "{{Param.Quality}}"].map(str::to_owned));
        args.extend(self.flags.iter().cloned());
        let request = &self.request;
        if !(request.resume || request.skip_existing || request.overwrite) {
            // A task that is repeated keeps what it has finished.
            args.push(Words::Flags.of("resume"));
        }
        args.extend(["--progress", "openjd"].map(str::to_owned));
        if !self.args.no_server {
            args.extend(["--server", SOCKET].map(str::to_owned));
        }
        let mode = "NOTIFY_THEN_TERMINATE";
        let cancelation = Some(Cancelation { mode, notify_period_in_seconds: NOTICE });
        Action { command: PROGRAM.to_owned(), args, timeout: None, cancelation }
    }

    /// What machines need, as far as flags say it.
    fn requirements(&self) -> Option<HostRequirements> {
        let request = &self.request;
        let gpus = match request.device {
            Device::Cuda(_) => Some(1),
            Device::Several(list) => Some(list.numbers().count().max(1) as u64),
            _ => None,
        };
        let amounts = [
            ("amount.worker.gpu", gpus),
            ("amount.worker.vcpu", request.threads.filter(|&threads| threads > 0).map(u64::from)),
            ("amount.worker.memory", request.memory_limit.map(|limit| limit.0.div_ceil(MIB))),
        ];
        let amounts = amounts.into_iter().filter_map(|(name, min)| Some(Amount { name, min: min? })).collect();
        let unix = Attribute { name: "attr.worker.os.family", any_of: vec!["linux", "macos"] };
        let attributes = if self.args.no_server { Vec::new() } else { vec![unix] };
        let requirements = HostRequirements { amounts, attributes };
        (requirements != HostRequirements::default()).then_some(requirements)
    }

    /// The value of a setting, as it is typed.
    fn value(&self, name: Name) -> String {
        field(name).map(|field| field.texts(&self.request).concat()).unwrap_or_default()
    }

    /// What was done, and how to go on.
    fn summary(&self, frames: &Frames) -> String {
        let (job, count) = (self.args.output.display(), frames.numbers().count());
        let mut text = format!("{job}: {count} frames, {} in a task", self.args.frames_per_task);
        if !is_standard(&self.args.output) {
            let given = self.missing.iter().map(|(name, path)| format!(" -p {name}={}", quoted(path)));
            let given: String = given.collect();
            text += &format!("; `openjd run {}{given}` renders them here", quoted(&self.args.output));
        }
        if !self.missing.is_empty() {
            text += "; what is not in the job's folder is given when it is submitted";
        }
        text
    }
}

/// The server that the tasks of a session share.
fn server() -> Environment {
    let action = |flags: &[&str]| Action {
        command: PROGRAM.to_owned(),
        args: ["serve", "--socket", SOCKET].iter().chain(flags).map(|&text| text.to_owned()).collect(),
        timeout: Some(PATIENCE),
        cancelation: None,
    };
    let actions = EnvironmentActions {
        on_enter: action(&["--background", "--idle", IDLE, "--log", LOG]),
        on_exit: action(&["--stop"]),
    };
    Environment { name: "Server", script: Script { actions } }
}

fn of_text(name: &'static str, description: &'static str, default: String) -> Parameter {
    Parameter { name, kind: "STRING", description, default: Some(Scalar::Text(default)), ..Parameter::default() }
}

/// The words of a setting.
fn choices(name: Name) -> Vec<String> {
    let choices = field(name).map(|field| (field.choices)()).unwrap_or_default();
    choices.into_iter().map(|choice| choice.name.to_owned()).collect()
}

/// Frames as the specification writes them: `1-9:2`.
fn openjd(frames: &Frames) -> String {
    frames.to_string().replace('x', ":")
}

/// The name of a job: that of its scene.
fn name_of(scene: &Path) -> String {
    let stem = scene.file_stem().unwrap_or(scene.as_os_str()).to_string_lossy();
    let plain = stem.chars().filter(|&character| !character.is_control() && !"{}".contains(character));
    format!("Lightmesh: {}", plain.take(NAME).collect::<String>())
}

/// The folder of a file that is written.
fn folder_of(output: &Path) -> &Path {
    if is_standard(output) { Path::new(".") } else { directory(output) }
}

/// A path from `folder` on, if it lies in it: by the names, in which links stay what they are, or by where they lead.
fn within(path: &Path, folder: &Path) -> Option<PathBuf> {
    let named = || {
        let inside = absolute(path).ok()?.strip_prefix(absolute(folder).ok()?).ok()?.to_owned();
        inside.components().all(|part| matches!(part, Component::Normal(_))).then_some(inside)
    };
    let real = || Some(fs::canonicalize(path).ok()?.strip_prefix(fs::canonicalize(folder).ok()?).ok()?.to_owned());
    let inside = named().or_else(real)?;
    Some(if inside.as_os_str().is_empty() { PathBuf::from(".") } else { inside })
}

/// A path as shells read it.
fn quoted(path: &Path) -> String {
    let text = path.display().to_string();
    let is_plain = |character: char| character.is_ascii_alphanumeric() || "_-./:@%+=,".contains(character);
    if text.chars().all(is_plain) { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

fn text(path: &Path) -> Result<String, FarmError> {
    path.to_str().map(str::to_owned).ok_or_else(|| FarmError::NotUnicode(path.to_owned()))
}

/// Text that means itself in a template.
fn literal(text: &str) -> Result<String, FarmError> {
    if text.contains("{{") || text.contains("}}") {
        Err(FarmError::Reference(text.to_owned()))
    } else {
        Ok(text.to_owned())
    }
}
