#!/usr/bin/env bash
# A logarithmic axis of plotters from 0.01 has no tick below 0.1, and an axis below 2.2e-16 has no tick at all
#
# Expected: `(0.01..1.0).log_scale()` has labels and grid lines from 0.01 up, as `(10.0..1000.0).log_scale()` has them from 10 up: both span two
# whole decades. Dividing all data by 10 billion changes the labels, not their places.
#
# Happens: (1) plotters finds the first power of ten as the logarithm of the range's start rounded up. ln(0.01) / ln(10) is
# -1.9999999999999996 in f64, thus it begins at 0.1; the start of the axis and the subdivisions of its first decade stay empty: half of the axis
# here. The same happens at 0.1, 0.001, 0.0001 and 1e-6, and not at 1e-5. (2) A tick less than `f64::EPSILON` (2.2e-16) away from the zero point
# counts as minus infinity, and is dropped without a word: the range 1e-20 to 1e-16 has no label, 1e-10 to 1e-6 has five.
#
# Versions: plotters 0.3.7, plotters-svg 0.3.7, plotters-backend 0.3.7.
#
# Why it matters: a plot of errors or times from 0.01 looks as if its axis began at 0.1, and a plot of very small quantities (probabilities of
# failure, charges) has an axis without numbers; neither is an error. A start slightly below the power of ten (0.0099) brings the first decade
# back, another unit the small quantities.
#
# Output seen:
#   10 to 1000, 20 labels: 10 20 30 40 50 60 70 80 90 100 200 300 400 500 600 700 800 900 1000
#   0.01 to 1, 20 labels: 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1
#   0.0099 to 1, 20 labels: 0.01 0.02 0.03 0.04 0.05 0.06 0.07 0.08 0.09 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1
#   first label of an axis from 1e-1: 1, 1e-2: 0.1, 1e-3: 0.01, 1e-4: 0.001, 1e-5: 0.00001, 1e-6: 0.00001
#   1e-10 to 1e-6: 5 labels
#   1e-20 to 1e-16: 0 labels
set -euo pipefail

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/src"
cat >"$dir/Cargo.toml" <<'EOF'
[package]
name = "ticks"
version = "0.0.0"
edition = "2021"
[dependencies]
plotters = { version = "=0.3.7", default-features = false, features = ["svg_backend"] }
plotters-svg = "=0.3.7"
plotters-backend = "=0.3.7"
[workspace]
EOF
cat >"$dir/src/main.rs" <<'EOF'
//! Draws logarithmic axes as SVG, and prints the texts of each from the lowest to the highest.
use plotters::prelude::*;

/// The labels of a vertical axis of 560 pixels, each once (plotters draws some twice), as numbers rounded to 9 digits.
fn labels(low: f64, high: f64, count: Option<usize>) -> Vec<f64> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (400, 580)).into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .margin(10)
            .set_label_area_size(LabelAreaPosition::Left, 60)
            .build_cartesian_2d(0.0..1.0, (low..high).log_scale())
            .expect("chart");
        let mut mesh = chart.configure_mesh();
        mesh.disable_x_mesh().x_labels(0);
        if let Some(count) = count {
            mesh.y_labels(count);
        }
        mesh.draw().expect("mesh");
        root.present().expect("file");
    }
    let mut labels: Vec<f64> = svg
        .split("<text")
        .skip(1)
        .map(|text| {
            let text = &text[text.find('>').expect("tag") + 1..text.find("</text>").expect("end")];
            let value: f64 = text.trim().parse().expect("number");
            format!("{value:.8e}").parse().expect("number")
        })
        .collect();
    labels.sort_by(f64::total_cmp);
    labels.dedup();
    labels
}

fn main() {
    for (low, high) in [(10.0, 1000.0), (0.01, 1.0), (0.0099, 1.0)] {
        let texts: Vec<String> = labels(low, high, Some(20)).iter().map(f64::to_string).collect();
        println!("{low} to {high}, 20 labels: {}", texts.join(" "));
    }
    let first: Vec<String> =
        [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6].iter().map(|low| format!("{low:e}: {}", labels(*low, 10.0, None)[0])).collect();
    println!("first label of an axis from {}", first.join(", "));
    for (low, high) in [(1e-10, 1e-6), (1e-20, 1e-16)] {
        println!("{low:e} to {high:e}: {} labels", labels(low, high, None).len());
    }
}
EOF

(cd "$dir" && CARGO_TARGET_DIR=$dir/target cargo run --quiet) | tee "$dir/seen"

# The output must be the one in the header.
sed -n '/^# Output seen:$/,/^[^#]/s/^#   //p' "$0" >"$dir/expected"
if ! diff "$dir/expected" "$dir/seen"; then
    echo "changed: the labels differ from the ones seen before (< before, > now)" >&2
    exit 1
fi
