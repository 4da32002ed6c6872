//! How values of each type are read from text and shown as it, and what the fields of a request hold of them.

use std::path::PathBuf;

use lightmesh_image::{BitDepth, ExrCompression, ExrParts, ExrSamples, Format, Transfer, View};
use lightmesh_render::{
    Acceleration, AmbientSource, Crop, Device, Filter, Glass, Lookup, Mode, Quality, ShortTests, Step,
};
use lightmesh_scene::{Falloff, Instancing, SceneFormat, Weight};

use crate::table::{Choice, Kind, Minus, Shape, Value};
use crate::value::{
    Background, ByteSize, CameraView, Color, Dims, EnvironmentSpec, Exposure, FrameRate, Frames, LightSpec, Positive,
    Size, SkySpec, Smooth, SunSpec, Switch, UpChoice,
};

/// A type of values: read from text, and shown as it is read.
pub(crate) trait Item: Sized {
    const SHAPE: Shape = Shape::Text;
    const MINUS: Minus = Minus::Never;
    /// What separates numbers of a list when it is text.
    const SEPARATOR: &'static str = ",";

    fn read(text: &str) -> Result<Self, String>;
    fn show(&self) -> String;

    fn choices() -> Vec<Choice> {
        Vec::new()
    }
}

/// What a field holds: an item, perhaps one, some, or whether it is on.
pub(crate) trait Slot {
    const KIND: Kind = Kind::Value;
    const SHAPE: Shape;
    const MINUS: Minus = Minus::Never;

    fn set(&mut self, value: &Value) -> Result<(), String>;
    /// `None` if nothing is given.
    fn get(&self) -> Option<Value>;

    fn choices() -> Vec<Choice> {
        Vec::new()
    }
}

impl<T: Item> Slot for T {
    const SHAPE: Shape = T::SHAPE;
    const MINUS: Minus = T::MINUS;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        *self = T::read(&value.text(T::SEPARATOR))?;
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        Some(Value::Text(self.show()))
    }

    fn choices() -> Vec<Choice> {
        T::choices()
    }
}

impl<T: Item> Slot for Option<T> {
    const SHAPE: Shape = T::SHAPE;
    const MINUS: Minus = T::MINUS;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        *self = Some(T::read(&value.text(T::SEPARATOR))?);
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        self.as_ref().map(|item| Value::Text(item.show()))
    }

    fn choices() -> Vec<Choice> {
        T::choices()
    }
}

impl<T: Item> Slot for Vec<T> {
    const KIND: Kind = Kind::List;
    const SHAPE: Shape = Shape::Texts;
    const MINUS: Minus = T::MINUS;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        let one = std::slice::from_ref(value);
        let items = if let Value::List(items) = value { items } else { one };
        *self = items.iter().map(|item| T::read(&item.text(T::SEPARATOR))).collect::<Result<_, _>>()?;
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        let items = || self.iter().map(|item| Value::Text(item.show())).collect();
        (!self.is_empty()).then(|| Value::List(items()))
    }
}

impl Slot for bool {
    const KIND: Kind = Kind::Switch;
    const SHAPE: Shape = Shape::Switch;

    fn set(&mut self, value: &Value) -> Result<(), String> {
        match value {
            Value::Switch(is_on) => *self = *is_on,
            _ => return Err("it is a switch: give true or false".to_owned()),
        }
        Ok(())
    }

    fn get(&self) -> Option<Value> {
        self.then_some(Value::Switch(true))
    }
}

/// Types that are read from text and shown as it.
macro_rules! items {
    ($($type:ty: $shape:expr, $minus:ident $(, $separator:literal)?;)*) => {
        $(impl Item for $type {
            const SHAPE: Shape = $shape;
            const MINUS: Minus = Minus::$minus;
            $(const SEPARATOR: &'static str = $separator;)?

            fn read(text: &str) -> Result<$type, String> {
                text.parse().map_err(|error| format!("{error}"))
            }

            fn show(&self) -> String {
                self.to_string()
            }
        })*
    };
}

/// Types that are a list of words.
macro_rules! words {
    ($($type:ty),* $(,)?) => {
        $(impl Item for $type {
            fn read(text: &str) -> Result<$type, String> {
                text.parse().map_err(|error| format!("{error}"))
            }

            fn show(&self) -> String {
                self.name().to_owned()
            }

            fn choices() -> Vec<Choice> {
                <$type>::ALL.iter().map(|choice| Choice { name: choice.name(), help: choice.help() }).collect()
            }
        })*
    };
}

items! {
    u32: Shape::Whole, Number;
    u64: Shape::Whole, Number;
    String: Shape::Text, Never;
    Step: Shape::Number(&["auto"]), Number;
    Positive: Shape::Number(&[]), Number;
    Exposure: Shape::Number(&["auto"]), Number;
    Smooth: Shape::Number(&["off"]), Number;
    FrameRate: Shape::Number(&[]), Never;
    Frames: Shape::Text, Text;
    Size: Shape::Wholes(2), Never, "x";
    Dims: Shape::Wholes(3), Never, "x";
    Crop: Shape::Wholes(4), Text;
    Background: Shape::Color, Text;
    Color: Shape::Color, Text;
    LightSpec: Shape::Text, Text;
    CameraView: Shape::Text, Text;
    SkySpec: Shape::Text, Text;
    SunSpec: Shape::Text, Text;
    EnvironmentSpec: Shape::Path, Never;
    ByteSize: Shape::Whole, Never;
    Device: Shape::Text, Never;
}

words! {
    Mode, Lookup, Quality, Filter, Glass, ShortTests, AmbientSource, Weight, Falloff, Instancing, SceneFormat, Acceleration, Transfer, View,
    ExrSamples, ExrCompression, ExrParts, Switch, UpChoice,
}

impl Item for PathBuf {
    const SHAPE: Shape = Shape::Path;

    fn read(text: &str) -> Result<Self, String> {
        Ok(text.into())
    }

    fn show(&self) -> String {
        self.to_string_lossy().into_owned()
    }
}

impl Item for Format {
    fn read(text: &str) -> Result<Format, String> {
        text.parse().map_err(|error| format!("{error}"))
    }

    fn show(&self) -> String {
        self.name().to_owned()
    }

    fn choices() -> Vec<Choice> {
        let built = Format::ALL.iter().filter(|format| format.is_built());
        built.map(|format| Choice { name: format.name(), help: format.help() }).collect()
    }
}

impl Item for BitDepth {
    const SHAPE: Shape = Shape::Whole;

    fn read(text: &str) -> Result<BitDepth, String> {
        match text {
            "8" => Ok(BitDepth::Eight),
            "16" => Ok(BitDepth::Sixteen),
            _ => Err("choose 8 or 16".to_owned()),
        }
    }

    fn show(&self) -> String {
        self.bits().to_string()
    }

    fn choices() -> Vec<Choice> {
        vec![
            Choice { name: "8", help: "256 codes, as screens show" },
            Choice { name: "16", help: "65536 codes, for further grading" },
        ]
    }
}
