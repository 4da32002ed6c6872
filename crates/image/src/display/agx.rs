//! The view *agx*: AgX with its base look, as in Blender 4.
//!
//! After the scripts with which Eary Chow generates Blender's table, `AgXBasesRGB.py` and `AgXBaseRec2020.py` of
//! <https://github.com/EaryChow/AgX_LUT_Gen>, following Troy Sobotka's AgX with Jed Smith's sigmoid:
//!
//! 1. From Rec. 709 to Rec. 2020, and *inset*: primaries move towards white, so that bright colours can lose saturation.
//! 2. Each channel's logarithm, from 10 stops below middle grey to 6.5 above, through a sigmoid with slope 2.4 at middle grey and power 1.5
//!    on both sides; then to the power of 2.4.
//! 3. The hue becomes a mixture: 60 % of that before step 2, 40 % of that after.
//! 4. *Outset* returns part of the saturation; then from Rec. 2020 to Rec. 709.
//! 5. Negative channels are lifted to 0 and the colour is darkened to its former luminance.
//!
//! Middle grey, 0.18, is shown as it is, and 16.3 is white. Blender interpolates in a table of 57³ colours; this is the function itself,
//! with the curve of step 2 in a finer table of one dimension.

use std::sync::LazyLock;

use super::curve::Curve;

type Matrix = [[f32; 3]; 3];

const TO_REC2020: Matrix = [
    [0.627_401_92, 0.329_291_97, 0.043_306_104],
    [0.069_095_49, 0.919_544_3, 0.011_360_229],
    [0.016_393_71, 0.088_028_16, 0.895_578_13],
];
const FROM_REC2020: Matrix = [
    [1.660_496_2, -0.587_656_44, -0.072_839_775],
    [-0.124_547_096, 1.132_895_1, -0.008_348_014],
    [-0.018_153_68, -0.100_597_37, 1.118_751],
];
/// Rec. 2020 primaries turned by 2.14°, −1.23° and −3.05°, and 33 %, 28 % and 12 % closer to white.
const INSET: Matrix = [
    [0.856_627_16, 0.095_121_24, 0.048_251_6],
    [0.137_318_97, 0.761_242, 0.101_439_04],
    [0.111_898_21, 0.076_799_415, 0.811_302_38],
];
/// Inverse of primaries 32 %, 28 % and 4 % closer to white.
const OUTSET: Matrix = [
    [1.127_100_6, -0.110_606_64, -0.016_493_931],
    [-0.141_329_75, 1.157_823_7, -0.016_493_931],
    [-0.141_329_75, -0.110_606_64, 1.251_936_4],
];
/// Luminance of Rec. 2020 primaries, from the CIE 2015 observer.
const LUMINANCE: [f32; 3] = [0.258_923_54, 0.610_498_53, 0.130_577_93];

const MIDDLE_GREY: f64 = 0.18;
/// Stops below and above middle grey that are shown.
const STOPS: [f64; 2] = [10.0, 6.5];
const SLOPE: f64 = 2.4;
const POWER: f64 = 1.5;
const GAMMA: f64 = 2.4;
/// Share of the hue after the curve.
const MIX: f32 = 0.4;

/// Step 2, from below the darkest that is shown, 2⁻¹⁰ · 0.18, to above the brightest.
static TONE: LazyLock<Curve> = LazyLock::new(|| Curve::new(1.0 / 8192.0, 32.0, tone));

/// What a linear colour is shown as; its channels are not negative.
pub fn agx(color: [f32; 3]) -> [f32; 3] {
    let inset = product(&INSET, product(&TO_REC2020, color)).map(|channel| channel.max(0.0));
    let toned = inset.map(|channel| TONE.at(channel));
    let formed = product(&OUTSET, with_hue(toned, mixed(hue(inset), hue(toned))));
    lifted(product(&FROM_REC2020, formed)).map(|channel| channel.clamp(0.0, 1.0))
}

fn tone(linear: f64) -> f64 {
    let place = ((linear / MIDDLE_GREY).log2() + STOPS[0]) / (STOPS[0] + STOPS[1]);
    // The sigmoid of 0 is 0 only up to rounding.
    if place <= 0.0 { 0.0 } else { sigmoid(place.min(1.0)).powf(GAMMA) }
}

/// A sigmoid through (0, 0), middle grey with the given slope, and (1, 1).
fn sigmoid(x: f64) -> f64 {
    let (grey_x, grey_y) = (STOPS[0] / (STOPS[0] + STOPS[1]), MIDDLE_GREY.powf(1.0 / GAMMA));
    let side = if x < grey_x { -1.0 } else { 1.0 };
    // Width and height from middle grey to the end of this side.
    let (width, height) = if x < grey_x { (grey_x, grey_y) } else { (1.0 - grey_x, 1.0 - grey_y) };
    let scale = ((SLOPE * width).powf(-POWER) * ((SLOPE * width / height).powf(POWER) - 1.0)).powf(-1.0 / POWER);
    let term = SLOPE * (x - grey_x).abs() / scale;
    side * scale * term / (1.0 + term.powf(POWER)).powf(1.0 / POWER) + grey_y
}

fn product(matrix: &Matrix, [r, g, b]: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * r + row[1] * g + row[2] * b)
}

/// The hue of the HSV model, in [0, 1); of a grey 0.
pub fn hue([r, g, b]: [f32; 3]) -> f32 {
    let most = r.max(g).max(b);
    let range = most - r.min(g).min(b);
    if range <= 0.0 {
        return 0.0;
    }
    let sixths = if most == r {
        (g - b) / range
    } else if most == g {
        2.0 + (b - r) / range
    } else {
        4.0 + (r - g) / range
    };
    (sixths / 6.0).rem_euclid(1.0)
}

/// From the hue `before` towards `after`, the shorter way around.
pub fn mixed(before: f32, after: f32) -> f32 {
    let way = after - before;
    let way = if way > 0.5 {
        way - 1.0
    } else if way < -0.5 {
        way + 1.0
    } else {
        way
    };
    (before + MIX * way).rem_euclid(1.0)
}

/// The colour with another hue; saturation and value of the HSV model remain.
pub fn with_hue([r, g, b]: [f32; 3], hue: f32) -> [f32; 3] {
    let most = r.max(g).max(b);
    let range = most - r.min(g).min(b);
    let share = |offset: f32| {
        let sixths = (offset + 6.0 * hue) % 6.0;
        most - range * sixths.min(4.0 - sixths).clamp(0.0, 1.0)
    };
    [share(5.0), share(3.0), share(1.0)]
}

/// Step 5.
fn lifted(color: [f32; 3]) -> [f32; 3] {
    let least = color[0].min(color[1]).min(color[2]);
    if least >= 0.0 {
        return color;
    }
    let raised = color.map(|channel| channel - least);
    let (luminance, brighter) = (perceived(color), perceived(raised));
    if brighter > luminance { raised.map(|channel| channel * (luminance / brighter).max(0.0)) } else { raised }
}

/// Luminance that counts how far a colour is from its opposite, the more the brighter it is.
fn perceived(color: [f32; 3]) -> f32 {
    let luminance = |color| {
        let [r, g, b] = product(&TO_REC2020, color);
        LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b
    };
    let most = color[0].max(color[1]).max(color[2]);
    let opposite = color.map(|channel| most - channel);
    let own = luminance(color).max(0.0);
    let compensated = opposite[0].max(opposite[1]).max(opposite[2]) - luminance(opposite) + own;
    (1.0 - own) * own.powf(0.08).min(1.0) + own * compensated
}
