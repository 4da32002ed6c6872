"""A scene as all programs get it: the file of `lightmesh export` without highlights, mirrors and glass, and its triangles as arrays."""

import io
import json
import struct
from dataclasses import dataclass, field

import numpy as np

COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


@dataclass
class Facets:
    """What makes a surface rough: f0 of its layer, how it reflects at grazing incidence, and how much of a metal it is."""

    layer: np.ndarray
    grazing: float
    roughness: float
    metallic: float


@dataclass
class Material:
    """A diffuse surface, or one with facets: colours are linear, images as they are encoded, with their alpha."""

    color: np.ndarray
    emission: np.ndarray
    image: np.ndarray | None = None
    glow: np.ndarray | None = None
    """An image that `emission` is multiplied by."""
    mask: np.ndarray | None = None
    cutoff: float = 0.5
    facets: Facets | None = None


@dataclass
class Part:
    """Triangles of one material."""

    positions: np.ndarray
    triangles: np.ndarray
    material: Material
    normals: np.ndarray | None = None
    uvs: np.ndarray | None = None
    colors: np.ndarray | None = None


@dataclass
class Model:
    parts: list = field(default_factory=list)

    @property
    def bounds(self):
        lower = np.min([part.positions.min(axis=0) for part in self.parts], axis=0)
        return lower, np.max([part.positions.max(axis=0) for part in self.parts], axis=0)


def make_diffuse(source, target, keep_facets=False):
    """Writes the GLB file `source` without lights, highlights, mirrors, and triangles that let light through, to `target`. Surfaces with facets stay
    what they are if they are to be kept."""
    gltf, binary = split(source.read_bytes())
    through = set()
    for index, material in enumerate(gltf["materials"]):
        own = material["extras"]["lightmesh"]
        own["ka"] = own["kd"]
        if not keep_facets:
            own.pop("facets", None)
        if "facets" not in own:
            for key in ("ks", "ks_tinted"):
                own[key] = [0, 0, 0]
            material["pbrMetallicRoughness"]["roughnessFactor"] = 1.0
        if any(own["emission"]):
            # The others' surfaces shine to their front alone.
            material["doubleSided"] = False
        if own.get("dielectric") or material.get("alphaMode") == "BLEND" or "filter" in own.get("opacity", {}):
            through.add(index)
    for mesh in gltf["meshes"]:
        mesh["primitives"] = [one for one in mesh["primitives"] if one["material"] not in through]
    gltf["nodes"] = [node for node in gltf["nodes"] if "mesh" in node]
    gltf["scenes"][0]["nodes"] = list(range(len(gltf["nodes"])))
    gltf["scenes"][0].pop("extras", None)
    for key in ("extensions", "cameras"):
        gltf.pop(key, None)
    if "KHR_lights_punctual" in gltf.get("extensionsUsed", []):
        gltf["extensionsUsed"].remove("KHR_lights_punctual")
        if not gltf["extensionsUsed"]:
            del gltf["extensionsUsed"]
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    header = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A)
    target.write_bytes(header + text + struct.pack("<II", len(binary), 0x004E4942) + binary)


def read(path):
    """The triangles and materials of a file by `make_diffuse`."""
    gltf, binary = split(path.read_bytes())
    materials = [material(gltf, binary, entry) for entry in gltf["materials"]]
    parts = {}
    for node in gltf["nodes"]:
        move = np.array(node.get("translation", [0, 0, 0]))
        for primitive in gltf["meshes"][node["mesh"]]["primitives"]:
            arrays = {name: array(gltf, binary, index) for name, index in primitive["attributes"].items()}
            part = Part(
                (arrays["POSITION"] + move).astype(np.float32),
                array(gltf, binary, primitive["indices"]).reshape(-1, 3).astype(np.uint32),
                materials[primitive["material"]],
                arrays.get("NORMAL"),
                arrays.get("TEXCOORD_0"),
                arrays["COLOR_0"][:, :3] if "COLOR_0" in arrays else None,
            )
            parts.setdefault((primitive["material"], *sorted(arrays)), []).append(part)
    return Model([joined(same) for same in parts.values()])


def joined(parts):
    """One part instead of many with the same material and the same arrays: path tracers take long for thousands of meshes."""
    starts = np.cumsum([0, *(len(part.positions) for part in parts)])
    triangles = [part.triangles + np.uint32(start) for part, start in zip(parts, starts)]
    together = lambda arrays: None if arrays[0] is None else np.concatenate(arrays)
    return Part(
        together([part.positions for part in parts]),
        together(triangles),
        parts[0].material,
        together([part.normals for part in parts]),
        together([part.uvs for part in parts]),
        together([part.colors for part in parts]),
    )


def split(data):
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def array(gltf, binary, index):
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    width = WIDTHS[accessor["type"]]
    return np.frombuffer(binary, COMPONENTS[accessor["componentType"]], accessor["count"] * width, start).reshape(-1, width)


def material(gltf, binary, entry):
    own, pbr = entry["extras"]["lightmesh"], entry["pbrMetallicRoughness"]
    made = Material(np.array(own["kd"], np.float32), np.array(own["emission"], np.float32))
    if "facets" in own:
        shares = (float(own["facets"][name]) for name in ("grazing", "roughness", "metallic"))
        made.facets = Facets(np.array(own["ks"], np.float32), *shares)
    if "baseColorTexture" in pbr:
        made.image = image(gltf, binary, pbr["baseColorTexture"]["index"])
    if "emissiveTexture" in entry:
        made.glow = image(gltf, binary, entry["emissiveTexture"]["index"])
    if entry.get("alphaMode") == "MASK":
        made.mask, made.cutoff = opacities(made.image, "alpha"), entry["alphaCutoff"]
    elif "cutoff" in own.get("opacity", {}):
        own = own["opacity"]
        made.mask, made.cutoff = opacities(image(gltf, binary, own["texture"]), own["channel"]), own["cutoff"]
    return made


def image(gltf, binary, index):
    """RGBA, row 0 at the top."""
    from PIL import Image

    view = gltf["bufferViews"][gltf["images"][gltf["textures"][index]["source"]]["bufferView"]]
    start = view.get("byteOffset", 0)
    return np.array(Image.open(io.BytesIO(binary[start : start + view["byteLength"]])).convert("RGBA"))


def opacities(texels, channel):
    """Opacities from 0 to 1."""
    if channel == "alpha":
        return texels[..., 3].astype(np.float32) / 255
    return texels[..., :3].astype(np.float32) @ np.array([0.2126, 0.7152, 0.0722], np.float32) / 255
