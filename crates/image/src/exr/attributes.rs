//! What a file says about its image, in OpenEXR's standard attributes.

use ::exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use ::exr::meta::header::Header;
use ::exr::prelude::Vec2;

use crate::options::Description;

/// Rec. 709 primaries and D65 (ITU-R BT.709-6, table 1).
const REC709: Chromaticities =
    Chromaticities { red: Vec2(0.64, 0.33), green: Vec2(0.3, 0.6), blue: Vec2(0.15, 0.06), white: Vec2(0.3127, 0.329) };

/// The header with a description. There is at most one attribute without a field of its own: the crate would write several in an order that
/// changes from run to run.
pub(super) fn described(mut header: Header, description: &Description) -> Header {
    header.shared_attributes.chromaticities = Some(REC709);
    let own = &mut header.own_attributes;
    own.layer_name = None;
    own.software_name = description.software.as_deref().map(text);
    own.comments = description.settings.as_deref().map(text);
    own.world_to_camera = description.world_to_camera;
    own.world_to_normalized_device = description.world_to_ndc;
    if let Some(scene) = &description.scene {
        own.other.insert(Text::from("lightmesh:scene"), AttributeValue::Text(text(scene)));
    }
    header
}

/// The text as OpenEXR stores it: UTF-8.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
