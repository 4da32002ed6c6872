//! Settings of a request as flags: made from the table, with its words for help, values and conflicts.

use std::marker::PhantomData;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches, value_parser};
use lightmesh::request::files::Files;
use lightmesh::request::table::{Choice, Group, Kind, Minus};
use lightmesh::request::{FIELDS, Field, Name, Request, Words, field};
use lightmesh::scene::Instancing;

/// Settings of some groups.
pub(crate) trait Groups {
    const GROUPS: &'static [Group];
}

macro_rules! groups {
    ($($(#[doc = $doc:literal])+ $name:ident: $($group:ident),+;)*) => {
        $($(#[doc = $doc])+
        #[derive(Clone, Debug)]
        pub(crate) struct $name;

        impl Groups for $name {
            const GROUPS: &'static [Group] = &[$(Group::$group),+];
        })*
    };
}

groups! {
    /// How a scene is read.
    Reading: Reading, Memory;
    /// What moves in a film.
    Motion: Motion;
    /// All others of a render.
    Others: Frames, Form, Storage, Exposure, Image, Machine;
}

/// Flags for the settings of some groups, as they are given.
#[derive(Clone, Debug)]
pub(crate) struct Flags<G> {
    given: Vec<(&'static Field, Vec<String>)>,
    groups: PhantomData<G>,
}

impl<G: Groups> Flags<G> {
    fn fields() -> impl Iterator<Item = &'static Field> {
        FIELDS.iter().filter(|field| G::GROUPS.contains(&field.group))
    }

    /// Sets what is given.
    pub(crate) fn apply(&self, request: &mut Request) {
        for (field, texts) in &self.given {
            let set = match (field.kind, texts.first()) {
                (Kind::Switch, _) => request.set(field.name, true),
                (Kind::List, _) => request.set(field.name, texts.clone()),
                (Kind::Value, text) => request.set(field.name, text.cloned().unwrap_or_default()),
            };
            set.expect("the parser has checked the value");
        }
    }

    /// A request with what is given.
    pub(crate) fn request(&self) -> Request {
        let mut request = Request::default();
        self.apply(&mut request);
        request
    }
}

impl<G: Groups> Args for Flags<G> {
    fn augment_args(command: Command) -> Command {
        command.args(Flags::<G>::fields().map(flag))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Flags::<G>::augment_args(command)
    }
}

impl<G: Groups> FromArgMatches for Flags<G> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Flags<G>, Error> {
        let texts = |field: &Field| match field.kind {
            Kind::Switch if matches.get_flag(field.name) => Some(Vec::new()),
            Kind::Switch => None,
            _ => matches.get_many::<String>(field.name).map(|texts| texts.cloned().collect()),
        };
        let given = Flags::<G>::fields().filter_map(|field| Some((field, texts(field)?))).collect();
        Ok(Flags { given, groups: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Flags::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Whether a name is that of a setting of the command line.
fn known(text: &str) -> Option<Name> {
    field(text).map(|field| field.name).or_else(|| Files::NAMES.into_iter().find(|name| *name == text))
}

/// The flag of a setting.
fn flag(field: &'static Field) -> Arg {
    let long = Words::Flags.of(field.name).trim_start_matches('-').to_owned();
    let help = Words::Flags.spell(field.doc.trim(), known);
    let mut arg = Arg::new(field.name).long(long).help(help).help_heading(field.heading);
    arg = arg.conflicts_with_all(field.conflicts);
    if let Some(needed) = field.requires {
        arg = arg.requires(needed);
    }
    if field.kind == Kind::Switch {
        return arg.action(ArgAction::SetTrue);
    }
    let placeholder =
        if field.placeholder.is_empty() { field.name.to_uppercase() } else { field.placeholder.to_owned() };
    arg = arg.value_name(placeholder);
    arg = match field.minus {
        Minus::Never => arg,
        Minus::Number => arg.allow_negative_numbers(true),
        Minus::Text => arg.allow_hyphen_values(true),
    };
    if let Some(default) = field.default() {
        arg = arg.default_value(default);
    }
    let action = if field.kind == Kind::List { ArgAction::Append } else { ArgAction::Set };
    arg.action(action).value_parser(parser(field))
}

/// Checks the texts of a setting, and lists those that can be chosen.
fn parser(field: &'static Field) -> ValueParser {
    if let Some(range) = &field.range {
        let range = i64::from(*range.start())..=i64::from(*range.end());
        return value_parser!(u32).range(range).map(|number| number.to_string()).into();
    }
    match (field.choices)() {
        choices if choices.is_empty() => ValueParser::new(|text: &str| field.check(text).map(|()| text.to_owned())),
        choices => chosen_from(choices).into(),
    }
}

/// Takes one of some words.
fn chosen_from(choices: Vec<Choice>) -> PossibleValuesParser {
    let help = |choice: &Choice| Words::Flags.spell(choice.help.trim_end_matches('.'), known);
    let value = |choice: Choice| match choice.help {
        "" => PossibleValue::new(choice.name),
        _ => PossibleValue::new(choice.name).help(help(&choice)),
    };
    PossibleValuesParser::new(choices.into_iter().map(value))
}

/// The words of the setting `instances`, for a command that has no request.
pub(super) fn instances() -> impl TypedValueParser<Value = Instancing> {
    let choices = field("instances").map(|field| (field.choices)());
    chosen_from(choices.unwrap_or_default()).try_map(|name| name.parse::<Instancing>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{Cli, command};

    #[test]
    fn every_setting_has_a_flag() {
        let command = command();
        let render = command.find_subcommand("render").unwrap();
        let flags: Vec<&str> = render.get_arguments().filter_map(Arg::get_long).collect();
        for field in FIELDS {
            let flag = Words::Flags.of(field.name);
            assert!(flags.contains(&flag.trim_start_matches("--")), "{flag}: {flags:?}");
        }
        for name in Files::NAMES {
            assert!(render.get_arguments().any(|flag| flag.get_id() == name), "{name}");
        }
    }

    #[test]
    fn flags_make_a_request() {
        let line = [
            "lightmesh",
            "render",
            "a.toml",
            "-o",
            "a.png",
            "--size",
            "64x48",
            "--light",
            "1,2,3",
            "--light",
            "4,5,6;2",
        ];
        let cli = Cli::from_arg_matches(&command().try_get_matches_from(line).unwrap()).unwrap();
        let crate::args::Command::Render(args) = cli.command else { panic!("not a render") };
        let request = args.order().request;
        assert_eq!((request.size.0, request.light.len()), ([64, 48], 2));
        assert_eq!(Request { light: Vec::new(), size: Default::default(), ..request }, Request::default());
    }
}
