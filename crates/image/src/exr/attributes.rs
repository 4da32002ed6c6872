//! What a file says about its image, in OpenEXR's standard attributes.

use ::exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use ::exr::meta::header::Header;
use ::exr::prelude::Vec2;

use crate::options::Description;

/// Rec. 709 primaries and D65 (ITU-R BT.709-6, table 1).
const REC709: Chromaticities =
    Chromaticities { red: Vec2(0.64, 0.33), green: Vec2(0.3, 0.6), blue: Vec2(0.15, 0.06), white: Vec2(0.3127, 0.329) };

/// The header with a description and further texts by name.
pub(super) fn described(mut header: Header, description: &Description, texts: &[(String, String)]) -> Header {
    header.shared_attributes.chromaticities = Some(REC709);
    let own = &mut header.own_attributes;
    own.software_name = description.software.as_deref().map(text);
    own.comments = description.settings.as_deref().map(text);
    own.world_to_camera = description.world_to_camera;
    own.world_to_normalized_device = description.world_to_ndc;
    if let Some(scene) = &description.scene {
        own.other.insert(Text::from("lightmesh:scene"), AttributeValue::Text(text(scene)));
    }
    for (name, value) in texts {
        own.other.insert(text(name), AttributeValue::Text(text(value)));
    }
    header
}

/// The text as OpenEXR stores it: UTF-8.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
