//! The words of a face: what its users call a setting.
//!
//! Messages name settings by their [`Name`]s. Each face turns a name into its own word: `--size` on the command line, `size` in Rust and Python. So
//! whoever reads a message can use what it says.

use std::fmt::Display;

/// The name of a setting: that of its field of [`Request`](crate::Request), or of an output of [`Files`](crate::files::Files).
pub type Name = &'static str;

/// How a face names settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Words {
    /// As fields and keyword arguments: `camera_name`.
    #[default]
    Fields,
    /// As flags: `--camera-name`.
    Flags,
}

impl Words {
    /// The word for a setting. What is no name, such as "the scene" or a flag of another command, stays.
    pub fn of(self, name: Name) -> String {
        let is_name = name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'_');
        match (self, name) {
            (Words::Flags, "output") => "-o".to_owned(),
            (Words::Flags, name) if is_name => format!("--{}", name.replace('_', "-")),
            (_, name) => name.to_owned(),
        }
    }

    /// A setting with a value, as a user writes it: `--fps 24`, `fps=24`.
    pub fn with(self, name: Name, value: impl Display) -> String {
        match self {
            Words::Fields => format!("{name}={value}"),
            Words::Flags => format!("{} {value}", self.of(name)),
        }
    }

    /// A switch that is on: `--overwrite`, `overwrite=True`.
    pub fn on(self, name: Name) -> String {
        match self {
            Words::Fields => format!("{name}=True"),
            Words::Flags => self.of(name),
        }
    }

    /// A text whose names of settings stand in backquotes, in these words. What else is in backquotes stays.
    pub fn spell(self, text: &str, is_name: impl Fn(&str) -> Option<Name>) -> String {
        let mut parts = text.split('`');
        let mut spelt = parts.next().unwrap_or_default().to_owned();
        // Every other part is quoted.
        while let Some(quoted) = parts.next() {
            match is_name(quoted) {
                Some(name) => spelt.push_str(&self.of(name)),
                None => spelt.extend(["`", quoted, "`"]),
            }
            spelt.push_str(parts.next().unwrap_or_default());
        }
        spelt
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_face_has_its_words() {
        let all = |words: Words| [words.of("camera_name"), words.with("fps", 24), words.on("overwrite")];
        assert_eq!(all(Words::Flags), ["--camera-name", "--fps 24", "--overwrite"]);
        assert_eq!(all(Words::Fields), ["camera_name", "fps=24", "overwrite=True"]);
        assert_eq!(
            ["output", "the scene", "--report"].map(|name| Words::Flags.of(name)),
            ["-o", "the scene", "--report"]
        );
    }

    #[test]
    fn quoted_names_are_spelt_and_other_quotations_stay() {
        let is_name = |text: &str| ["size", "camera_name"].into_iter().find(|name| *name == text);
        let text = "`camera_name` and `####`, as `size`";
        assert_eq!(Words::Flags.spell(text, is_name), "--camera-name and `####`, as --size");
        assert_eq!(Words::Fields.spell(text, is_name), "camera_name and `####`, as size");
    }
}
