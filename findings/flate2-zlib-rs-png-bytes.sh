#!/usr/bin/env bash
# A feature that one crate enables on flate2 changes the PNG files that another crate writes through png
#
# Expected: png has a feature `zlib-rs` of its own, off by default. As long as a program leaves it off, the same program writes the same PNG
# file from the same pixels and settings.
#
# Happens: png compresses through flate2, and cargo compiles flate2 once for the whole build. If any crate of the build, even one that the
# encoder never calls, enables `zlib-rs` on flate2, png compresses through zlib-rs, too, with its own `zlib-rs` still off. The default
# compression (Balanced) and High then write other bytes, in either direction: on the image below the default file shrinks with the filter
# Adaptive and grows with NoFilter. High also loses its order: with zlib-rs and Adaptive it writes a larger file than Balanced. Fast writes the same
# bytes, as it compresses through fdeflate. All files decode to the same pixels.
#
# Versions: png 0.18.1, flate2 1.1.10, miniz_oxide 0.9.1, zlib-rs 0.6.8.
#
# Why it matters: checksums of reference pictures and caches by content break when a dependency elsewhere in the tree changes, and also between
# `cargo test -p ONE` and `cargo test --workspace`, whose sets of features differ. Compare decoded pixels, or write files by Fast.
#
# Output seen:
#   backend       png features   compression filter    bytes
#   miniz_oxide   -              Fast        Adaptive 101102
#   miniz_oxide   -              Balanced    Adaptive  99964
#   miniz_oxide   -              Balanced    NoFilter 141849
#   miniz_oxide   -              High        Adaptive  99964
#   zlib-rs       -              Fast        Adaptive 101102
#   zlib-rs       -              Balanced    Adaptive  98194
#   zlib-rs       -              Balanced    NoFilter 151564
#   zlib-rs       -              High        Adaptive 100114
#   Fast Adaptive: same bytes
#   Balanced Adaptive: other bytes
#   Balanced NoFilter: other bytes
#   High Adaptive: other bytes
set -euo pipefail

dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
export CARGO_TARGET_DIR=$dir/target

fail() {
    echo "changed: $*" >&2
    exit 1
}

# The program that writes PNG files; it names png only. The other crate is in its build, and is never called.
project() { # NAME, features of flate2, extra dependency of the other crate
    mkdir -p "$dir/$1/src" "$dir/$1/other/src"
    cat >"$dir/$1/Cargo.toml" <<EOF
[package]
name = "encode"
version = "0.0.0"
edition = "2021"
[dependencies]
png = "=0.18.1"
other = { path = "other" }
[workspace]
EOF
    cat >"$dir/$1/other/Cargo.toml" <<EOF
[package]
name = "other"
version = "0.0.0"
edition = "2021"
[dependencies]
flate2 = { version = "=1.1.10", features = [$2] }
$3
EOF
    echo '//! Has nothing to do with pictures.' >"$dir/$1/other/src/lib.rs"
    cat >"$dir/$1/src/main.rs" <<'EOF'
//! Writes one picture by several settings, reads each file back, and prints `COMPRESSION FILTER BYTES`.
use png::{BitDepth, ColorType, Compression, Decoder, Encoder, Filter};

fn main() {
    let folder = std::env::args().nth(1).expect("folder");
    let (width, height) = (256u32, 256u32);
    // A ramp of 128 grey levels with noise of 8 levels.
    let mut state = 1u32;
    let pixels: Vec<u8> = (0..width * height * 3)
        .map(|i| {
            state = state.wrapping_mul(1664525).wrapping_add(1013904223);
            ((i / 3 % 256) / 2 + (state >> 24) % 8) as u8
        })
        .collect();
    for (compression, filter) in [
        (Compression::Fast, Filter::Adaptive),
        (Compression::Balanced, Filter::Adaptive),
        (Compression::Balanced, Filter::NoFilter),
        (Compression::High, Filter::Adaptive),
    ] {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, width, height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(compression);
        encoder.set_filter(filter);
        encoder.write_header().expect("header").write_image_data(&pixels).expect("pixels");
        let mut reader = Decoder::new(std::io::Cursor::new(&file)).read_info().expect("header");
        let mut decoded = vec![0; reader.output_buffer_size().expect("size")];
        reader.next_frame(&mut decoded).expect("pixels");
        assert_eq!(decoded, pixels, "the file must decode to the pixels that went in");
        std::fs::write(format!("{folder}/{compression:?}-{filter:?}.png"), &file).expect("written");
        println!("{compression:?} {filter:?} {}", file.len());
    }
}
EOF
}

project miniz_oxide '' 'miniz_oxide = { version = "=0.9.1", default-features = false }'
project zlib-rs '"zlib-rs"' 'zlib-rs = { version = "=0.6.8", default-features = false }'

echo "backend       png features   compression filter    bytes"
for backend in miniz_oxide zlib-rs; do
    mkdir "$dir/$backend/files"
    (cd "$dir/$backend" && cargo run --quiet -- files) >"$dir/$backend/sizes"
    features=$(cd "$dir/$backend" && cargo tree --quiet --prefix none --format '{p} {f}' | sed -n 's/^png v0\.18\.1 \?//p' | head -n 1)
    [ -z "$features" ] || fail "png has the features $features"
    while read -r compression filter bytes; do
        printf '%-13s %-14s %-11s %-8s %6d\n' "$backend" "${features:--}" "$compression" "$filter" "$bytes"
    done <"$dir/$backend/sizes"
done

for case in Fast-Adaptive Balanced-Adaptive Balanced-NoFilter High-Adaptive; do
    if cmp -s "$dir/miniz_oxide/files/$case.png" "$dir/zlib-rs/files/$case.png"; then
        same=same
    else
        same=other
    fi
    echo "${case/-/ }: $same bytes"
    case $case-$same in
    Fast-*-same | Balanced-*-other | High-*-other) ;;
    *) fail "$case has the $same bytes by both backends" ;;
    esac
done

size() { stat -c %s "$dir/$1/files/$2.png"; }
[ "$(size zlib-rs Balanced-Adaptive)" -lt "$(size miniz_oxide Balanced-Adaptive)" ] || fail "Balanced, Adaptive: no smaller file by zlib-rs"
[ "$(size zlib-rs Balanced-NoFilter)" -gt "$(size miniz_oxide Balanced-NoFilter)" ] || fail "Balanced, NoFilter: no larger file by zlib-rs"
[ "$(size zlib-rs High-Adaptive)" -gt "$(size zlib-rs Balanced-Adaptive)" ] || fail "zlib-rs, Adaptive: High is no larger than Balanced"
