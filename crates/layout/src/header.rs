//! The C++ header.

use std::fmt::Write;

use crate::literal::Constant;
use crate::record::Outline;
use crate::{codes, constants, counters, geometry, irradiance_cache, mesh, scene, stages, structure};

/// How the two compilers of kernels express `offsetof`: NVRTC has no `<stddef.h>`, and no builtin of that name.
const PLACE_OF: &str = "
#if defined(__CUDACC_RTC__)
#define PLACE_OF(record, field) __INTADDR__(&(((record *)0)->field))
#else
#define PLACE_OF(record, field) __builtin_offsetof(record, field)
#endif
";

/// All constants and records as C++, with assertions about the records' layout.
pub fn header() -> String {
    let mut text = String::from(
        "// Made from crates/layout by `cargo xtask kernels`; do not edit.\n//\n// What host and device share: constants and records.\n#pragma once\n\n",
    );
    for constant in constants::all() {
        print_docs(&mut text, "", constant.docs);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "#define {} {}", constant.name, constant.literal);
    }
    text.push_str(PLACE_OF);
    print_records(&mut text, &[counters::outlines(), geometry::outlines(), scene::outlines()]);
    structure::print(&mut text);
    print_records(&mut text, &[mesh::outlines(), irradiance_cache::outlines(), stages::outlines()]);
    text
}

/// Prints the records of some modules.
fn print_records(text: &mut String, modules: &[Vec<Outline>]) {
    for record in modules.iter().flatten() {
        print_record(text, record);
    }
}

fn print_record(text: &mut String, record: &Outline) {
    let Outline { name, size, alignment, fields } = record;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "\nstruct alignas({alignment}) {name} {{");
    print_codes(text, &codes::of_record(name));
    let mut print = |line: String| {
        let _ = writeln!(text, "{line}");
    };
    for field in fields {
        print(format!("    {};", field.declaration));
    }
    print("};".to_owned());
    print(format!("static_assert(sizeof({name}) == {size}, \"size of {name}\");"));
    for field in fields {
        print(format!(
            "static_assert(PLACE_OF({name}, {0}) == {1}, \"place of {name}::{0}\");",
            field.name, field.offset
        ));
    }
}

/// The constants of a record. An enumeration: for a variable the compiler would allocate memory in every module.
fn print_codes(text: &mut String, codes: &[Constant]) {
    if codes.is_empty() {
        return;
    }
    text.push_str("    enum : unsigned {\n");
    for code in codes {
        print_docs(text, "        ", code.docs);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "        {} = {},", code.name, code.literal);
    }
    text.push_str("    };\n");
}

fn print_docs(text: &mut String, indent: &str, docs: &[&str]) {
    for line in docs {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{indent}//{line}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Bvh, Hit, Triangle};

    #[test]
    fn fields_are_declared_as_in_rust() {
        let mut text = String::new();
        print_record(&mut text, &Outline::of::<Bvh>());
        assert!(text.contains("    const BvhNode *nodes;\n"), "{text}");
        assert!(text.contains("static_assert(PLACE_OF(Bvh, triangles) == 8,"), "{text}");
        let mut text = String::new();
        print_record(&mut text, &Outline::of::<Triangle>());
        assert!(text.contains("    float corners[3][4];\n"), "{text}");
    }

    #[test]
    fn constants_come_with_what_they_mean() {
        assert!(header().contains(
            "// Threads of a warp, and the maximum number of surface points of a bundle.\n#define WARP 32u\n"
        ));
        let mut text = String::new();
        print_record(&mut text, &Outline::of::<Hit>());
        assert!(text.contains("no triangle\".\n        NONE = 0xffffffffu,\n    };\n    float t;\n"), "{text}");
    }
}
