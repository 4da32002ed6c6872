//! From bytes to a checked document and its buffers.

use std::path::Path;

use base64::{
    Engine, alphabet,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use gltf::{
    Document, Glb,
    buffer::Source,
    json::{Image, Root, mesh::Semantic, validation::Checked::Valid},
};
use percent_encoding::percent_decode_str;

use super::exact::Exact;
use crate::{LoadError, error::Place, open::read_bytes};

/// Extensions that a file may require.
const KNOWN_EXTENSIONS: [&str; 3] = ["KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_mesh_quantization"];

/// A file taken apart.
pub(super) struct Container {
    pub(super) document: Document,
    pub(super) exact: Exact,
    /// In the document's order, each as long as it says.
    pub(super) buffers: Vec<Vec<u8>>,
    /// What was mended.
    pub(super) warnings: Vec<String>,
}

impl Container {
    pub(super) fn open(path: &Path) -> Result<Container, LoadError> {
        let bytes = read_bytes(path)?;
        if !bytes.starts_with(b"glTF") {
            return Container::from_parts(path, &bytes, None);
        }
        // The crate subtracts the header from the stated length unseen.
        let stated =
            bytes.get(8..12).map_or(0, |length| u32::from_le_bytes([length[0], length[1], length[2], length[3]]));
        if stated < 20 {
            return Err(malformed(path, format!("the binary container states a length of {stated} bytes")));
        }
        let glb = Glb::from_slice(&bytes)
            .map_err(|error| malformed(path, format!("the binary container is damaged ({error})")))?;
        Container::from_parts(path, &glb.json, glb.bin.as_deref())
    }

    fn from_parts(path: &Path, json: &[u8], bin: Option<&[u8]>) -> Result<Container, LoadError> {
        let mut root: Root = serde_json::from_slice(json).map_err(|error| syntax(path, &error))?;
        let exact: Exact = serde_json::from_slice(json).map_err(|error| syntax(path, &error))?;
        if let Some(extension) = root.extensions_required.iter().find(|name| !KNOWN_EXTENSIONS.contains(&name.as_str()))
        {
            return Err(LoadError::UnsupportedExtension {
                path: path.to_owned(),
                extension: extension.clone(),
                known: KNOWN_EXTENSIONS.map(str::to_owned).to_vec(),
            });
        }
        check_positions(path, &root)?;
        // The crate knows fewer extensions than we read, and would refuse the rest.
        root.extensions_required.clear();
        let warnings = supply_missing_images(path, &mut root);
        let document = Document::from_json(root)
            .map_err(|error| malformed(path, format!("the file breaks the rules of glTF ({error})")))?;
        let buffers = document.buffers().map(|buffer| read_buffer(path, &buffer, bin)).collect::<Result<_, _>>()?;
        Ok(Container { document, exact, buffers, warnings })
    }
}

/// The crate's validation takes it for granted that these accessors exist.
fn check_positions(path: &Path, root: &Root) -> Result<(), LoadError> {
    let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut positions = primitives.filter_map(|primitive| primitive.attributes.get(&Valid(Semantic::Positions)));
    match positions.find(|accessor| accessor.value() >= root.accessors.len()) {
        Some(accessor) => Err(malformed(
            path,
            format!("a primitive has its positions in accessor {}, which is not there", accessor.value()),
        )),
        None => Ok(()),
    }
}

/// A texture without its image must not keep the shape from being read: it gets an empty one, and a warning.
fn supply_missing_images(path: &Path, root: &mut Root) -> Vec<String> {
    let there = root.images.len();
    let wanted = root.textures.iter().map(|texture| texture.source.value().saturating_add(1)).max().unwrap_or(0);
    let missing = root.textures.iter().filter(|texture| texture.source.value() >= there).count();
    if missing == 0 {
        return Vec::new();
    }
    let empty = || Image {
        buffer_view: None,
        mime_type: None,
        name: None,
        uri: Some(String::new()),
        extensions: None,
        extras: Default::default(),
    };
    if wanted <= there + root.textures.len() {
        root.images.resize_with(wanted, empty);
    }
    vec![format!("{}: {missing} textures have no image", path.display())]
}

/// The bytes of one buffer: the binary chunk, a data URI or a file beside.
fn read_buffer(path: &Path, buffer: &gltf::Buffer, bin: Option<&[u8]>) -> Result<Vec<u8>, LoadError> {
    let mut bytes = match buffer.source() {
        Source::Bin => bin.ok_or_else(|| malformed(path, "the binary chunk is missing".to_owned()))?.to_vec(),
        Source::Uri(uri) => match uri.strip_prefix("data:") {
            Some(data) => decode_data(data).ok_or_else(|| {
                malformed(path, format!("the data URI of buffer {} cannot be decoded", buffer.index()))
            })?,
            None => read_file(path, uri)?,
        },
    };
    if bytes.len() < buffer.length() {
        let (index, there, wanted) = (buffer.index(), bytes.len(), buffer.length());
        return Err(malformed(path, format!("buffer {index} holds {there} bytes of {wanted}")));
    }
    bytes.truncate(buffer.length());
    Ok(bytes)
}

fn read_file(path: &Path, uri: &str) -> Result<Vec<u8>, LoadError> {
    if uri.contains("://") {
        return Err(LoadError::Malformed {
            place: Place::file(path).into(),
            problem: format!("the buffer {uri} is not a file"),
            remedy: "download it and name it by its path".to_owned(),
        });
    }
    let name = percent_decode_str(uri).decode_utf8_lossy();
    read_bytes(&path.parent().unwrap_or(Path::new("")).join(&*name))
}

/// The data of `mediatype;base64,DATA` or `mediatype,DATA`.
fn decode_data(data: &str) -> Option<Vec<u8>> {
    let (header, data) = data.split_once(',')?;
    if !header.ends_with(";base64") {
        return Some(percent_decode_str(data).collect());
    }
    let config = GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    GeneralPurpose::new(&alphabet::STANDARD, config).decode(data).ok()
}

fn syntax(path: &Path, error: &serde_json::Error) -> LoadError {
    LoadError::Syntax {
        place: Place { path: path.to_owned(), line: Some((error.line(), error.column())) }.into(),
        problem: format!("the JSON cannot be read as glTF ({error})"),
        remedy: "export the file again".to_owned(),
    }
}

/// The error for a file that contradicts itself.
pub(super) fn malformed(path: &Path, problem: String) -> LoadError {
    LoadError::Malformed { place: Place::file(path).into(), problem, remedy: "export the file again".to_owned() }
}
