//! The acceleration structures: one table for the kernels' names and for the field of the scene that a kernel traverses.

use std::fmt::Write;

use crate::scene::Scene;

/// Defines the structures and their names. The first token is `$` itself, for the macro within.
macro_rules! structures {
    ($dollar:tt $($(#[$doc:meta])* $structure:ident = $field:ident;)*) => {
        /// An acceleration structure.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Structure {
            $($(#[$doc])* $structure,)*
        }

        /// The name of each in kernels, which is that of its field in [`Scene`].
        const FIELDS: &[&str] = &[$({
            // There must be such a field.
            let _ = std::mem::offset_of!(Scene, $field);
            stringify!($field)
        }),*];

        /// The names of a kernel that exists once per [`Structure`], in their order: `KERNEL_PER_STRUCTURE` generates them.
        #[macro_export]
        macro_rules! names_per_structure {
            ($dollar name:literal) => {
                [$(concat!($dollar name, "_", stringify!($field))),*]
            };
        }
    };
}

structures! { $
    /// A wide BVH.
    Bvh = bvh;
    /// A regular grid.
    Grid = grid;
    /// A test of every triangle, always: the reference of tests, whose kernels exist in the emulator alone.
    BruteForce = brute_force;
    /// A wide BVH over instances: in modules with INSTANCES alone.
    InstancedBvh = instanced;
}

/// Prints the macro that expands to something for each structure.
pub(crate) fn print(text: &mut String) {
    let each: Vec<String> = FIELDS.iter().map(|field| format!("DO({field}, __VA_ARGS__)")).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "\n// DO(structure, …) for each acceleration structure, by the name of its field in `Scene`.\n#define PER_STRUCTURE(DO, ...) {}",
        each.join(" ")
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_the_order_of_the_structures() {
        let names = names_per_structure!("walk");
        assert_eq!(names[Structure::Grid as usize], "walk_grid");
        assert_eq!(names[Structure::BruteForce as usize], "walk_brute_force");
    }

    #[test]
    fn the_header_has_them_in_one_line() {
        let mut text = String::new();
        print(&mut text);
        let all = "DO(bvh, __VA_ARGS__) DO(grid, __VA_ARGS__) DO(brute_force, __VA_ARGS__) DO(instanced, __VA_ARGS__)";
        assert!(text.ends_with(&format!("#define PER_STRUCTURE(DO, ...) {all}\n")), "{text}");
    }
}
