//! Scenes of other programs: how one gets them in a format that can be read.

/// Formats that many programs write, and Blender reads.
const READ_BY_BLENDER: &[&str] = &["fbx", "dae", "usd", "usda", "usdc", "usdz", "abc", "x3d", "wrl", "3ds"];
/// Formats of one program, which is named, and the formats that it exports.
const OWN: &[(&str, &str, &str)] = &[
    ("blend", "Blender", "glb (File, Export, glTF 2.0)"),
    ("max", "3ds Max", "glb or obj"),
    ("skp", "SketchUp", "glb or obj"),
    ("ifc", "the program that it comes from, or in Blender with Bonsai", "glb or obj"),
    ("rvt", "Revit", "obj"),
    ("3dm", "Rhino", "glb or obj"),
    ("c4d", "Cinema 4D", "glb or obj"),
    ("ma", "Maya", "obj"),
    ("mb", "Maya", "obj"),
    ("lwo", "LightWave", "obj"),
];

/// What to do with a file of this extension, with a semicolon at the end; empty if that is not known.
pub(super) fn remedy(extension: &str) -> String {
    if READ_BY_BLENDER.contains(&extension) {
        return "export it as glb, in the program that it comes from or in Blender, which imports it; ".to_owned();
    }
    let own = OWN.iter().find(|(own, ..)| *own == extension);
    own.map_or_else(String::new, |(_, program, formats)| format!("export it as {formats} in {program}; "))
}
