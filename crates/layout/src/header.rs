//! The C++ header.

use std::fmt::Write;

use crate::{Record, constants, geometry, mesh, scene, stages};

/// How the two compilers of kernels say `offsetof`: NVRTC has no `<stddef.h>`, and no builtin of that name.
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
    for (name, value) in constants::ALL {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "#define {name} {value}u");
    }
    text.push_str(PLACE_OF);
    geometry::print(&mut text);
    scene::print(&mut text);
    mesh::print(&mut text);
    stages::print(&mut text);
    text
}

pub(crate) fn print_record<T: Record>(text: &mut String) {
    let name = T::NAME;
    let mut print = |line: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{line}");
    };
    print(format!("\nstruct alignas({}) {name} {{", align_of::<T>()));
    let fields = T::fields();
    for field in &fields {
        print(format!("    {};", field.declaration));
    }
    print("};".to_owned());
    print(format!("static_assert(sizeof({name}) == {}, \"size of {name}\");", size_of::<T>()));
    for field in &fields {
        print(format!(
            "static_assert(PLACE_OF({name}, {0}) == {1}, \"place of {name}::{0}\");",
            field.name, field.offset
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bvh;

    #[test]
    fn fields_are_declared_as_in_rust() {
        let mut text = String::new();
        print_record::<Bvh>(&mut text);
        assert!(text.contains("    const BvhNode *nodes;\n"), "{text}");
        assert!(text.contains("static_assert(PLACE_OF(Bvh, triangles) == 8,"), "{text}");
        let mut text = String::new();
        print_record::<crate::geometry::Triangle>(&mut text);
        assert!(text.contains("    float corners[3][4];\n"), "{text}");
    }
}
