"""What a scene asks for and a render does not do: warnings name it. What needs no warning looks as in Cycles."""

from collections.abc import Iterator

import bpy
import numpy as np
import pytest
from lightmesh_addon.notes import Notes
from support import agreement, box, cycles, light, lightmesh, link, matt, overlap, stage, world


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """The warnings so far."""
    texts, add = [], Notes.add
    monkeypatch.setattr(Notes, "add", lambda self, text: (texts.append(text), add(self, text))[1])
    yield texts


def lit() -> bpy.types.Object:
    """The stage under a sun, which is returned."""
    stage()
    return light("SUN", 3.0, angle=0.02)


def part(*names: str) -> bpy.types.LayerCollection:
    """These objects in a collection of their own, in the view layer."""
    made = bpy.data.collections.new("Part")
    scene = bpy.context.scene
    scene.collection.children.link(made)
    for name in names:
        made.objects.link(bpy.data.objects[name])
        scene.collection.objects.unlink(bpy.data.objects[name])
    return bpy.context.view_layer.layer_collection.children["Part"]


def linked(name: str) -> bpy.types.Collection:
    made = bpy.data.collections.new("Linked")
    made.objects.link(bpy.data.objects[name])
    return made


def test_nothing_to_warn_of(said: list[str]) -> None:
    lit()
    lightmesh()
    assert said == []


def _receivers() -> None:
    sun = lit()
    sun.light_linking.receiver_collection = linked("Box")


def _blockers() -> None:
    sun = lit()
    sun.light_linking.blocker_collection = linked("Floor")


def _object_receivers() -> None:
    lit()
    bpy.data.objects["Ball"].light_linking.receiver_collection = linked("Box")


def _indirect_only() -> None:
    lit()
    part("Box").indirect_only = True


def _world_of_some_rays() -> None:
    lit()
    bpy.context.scene.world.cycles_visibility.diffuse = False


def _mixed_holdout() -> None:
    lit()
    material = matt("Veil")
    tree = material.node_tree
    mix, hole = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeHoldout")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(output.inputs["Surface"].links[0].from_socket, mix.inputs[1])
    tree.links.new(hole.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    bpy.data.objects["Box"].data.materials[0] = material


DIFFERENCES = {
    "light_linking": (_receivers, "Light “Sun” lights only what its light linking (“Linked”)"),
    "shadow_linking": (_blockers, "Light “Sun” is hidden only by what its shadow linking (“Linked”)"),
    "light_linking_of_objects": (_object_receivers, "Object “Ball” lights only what its light linking (“Linked”)"),
    "indirect_only": (_indirect_only, "Object “Box” is only seen indirectly"),
    "world_of_some_rays": (_world_of_some_rays, "World “World” is hidden from some rays (diffuse)"),
    "mixed_holdout": (_mixed_holdout, "Material “Veil”: the node “Holdout” is a part of a mixture"),
}


@pytest.mark.parametrize("name", DIFFERENCES)
def test_is_named(name: str, said: list[str]) -> None:
    change, text = DIFFERENCES[name]
    change()
    lightmesh()
    assert sum(text in other for other in said) == 1, said


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
@pytest.mark.parametrize("clip", [(8.2, 1000.0), (0.1, 8.2), (7.4, 9.0)], ids=["start", "end", "both"])
def test_clip_planes(kind: str, clip: tuple[float, float], said: list[str]) -> None:
    """Cameras see what is between the planes where they begin and end to see, which are perpendicular to their axis; depths are from the camera,
    and what is cut away casts its shadows."""
    lit()
    data = bpy.context.scene.camera.data
    data.type, data.ortho_scale, (data.clip_start, data.clip_end) = kind, 8.0, clip
    bpy.context.scene.render.film_transparent = bpy.context.view_layer.use_pass_z = True
    ours, theirs = lightmesh(), cycles(samples=16)
    agreement(f"clip_{kind.lower()}_{clip[0]:g}_{clip[1]:g}", ours, theirs).check(difference=0.06)
    assert 0.01 < ours.alpha.mean() < 0.99 and overlap(ours.alpha > 0.5, theirs.alpha > 0.5) > 0.97
    depths = [of.pass_("Depth", "Z")[..., 0] for of in (ours, theirs)]
    both = (depths[0] < 1e6) & (depths[1] < 1e6)
    assert clip[0] - 0.01 <= depths[0][both].min() and depths[0][both].max() <= clip[1] + 0.01
    assert np.median(np.abs(depths[0] - depths[1])[both]) < 0.1
    assert said == []


def test_portal() -> None:
    """Portals give no light."""
    lit()
    light("AREA", 500.0, (0.0, 0.0, 3.0)).data.cycles.is_portal = True
    agreement("portal", lightmesh(), cycles()).check()


def _object_holdout() -> None:
    bpy.data.objects["Box"].is_holdout = True


def _collection_holdout() -> None:
    part("Box").holdout = True


def _material_holdout() -> None:
    made = bpy.data.materials.new("Hole")
    made.use_nodes = True
    tree = made.node_tree
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(tree.nodes.new("ShaderNodeHoldout").outputs[0], output.inputs["Surface"])
    bpy.data.objects["Box"].data.materials[0] = made


def _instance_holdout() -> None:
    """One of two instances of the same collection."""
    parts = bpy.data.collections.new("Parts")
    bpy.context.scene.collection.objects.unlink(bpy.data.objects["Box"])
    parts.objects.link(bpy.data.objects["Box"])
    for name, x in (("First", -0.6), ("Second", 1.4)):
        instance = link(None, name, (x, 0.4, 0.0))
        instance.instance_type, instance.instance_collection = "COLLECTION", parts
    bpy.data.objects["First"].is_holdout = True


HOLDOUTS = {"object": _object_holdout, "collection": _collection_holdout, "material": _material_holdout, "instance": _instance_holdout}


@pytest.mark.parametrize("film", ["opaque", "transparent"])
@pytest.mark.parametrize("name", HOLDOUTS)
def test_holdout(name: str, film: str, said: list[str]) -> None:
    """Holes have no alpha and no light; the shadows of what is held out stay."""
    lit()
    HOLDOUTS[name]()
    bpy.context.scene.render.film_transparent = film == "transparent"
    ours, theirs = lightmesh(), cycles(samples=32)
    assert 0.01 < (theirs.alpha < 0.5).mean() < 0.6
    assert overlap(ours.alpha < 0.5, theirs.alpha < 0.5) > 0.97
    assert np.abs(ours.alpha - theirs.alpha).mean() < 0.01
    assert ours.rgb[ours.alpha == 0.0].max() == 0.0
    agreement(f"holdout_{name}_{film}", ours, theirs).check()
    assert said == []


def test_holdout_that_reflects(said: list[str]) -> None:
    lit()
    world((0.5, 0.5, 0.5))
    _object_holdout()
    lightmesh()
    assert sum("Object “Box” is a holdout" in text for text in said) == 1, said


@pytest.mark.parametrize("film", ["opaque", "transparent"])
def test_world_that_the_camera_does_not_see(film: str) -> None:
    """It lights all the same."""
    stage()
    bpy.data.objects["Floor"].scale = (0.4, 0.4, 1.0)
    world((0.4, 0.6, 0.9)).cycles_visibility.camera = False
    bpy.context.scene.render.film_transparent = film == "transparent"
    ours, theirs = lightmesh(), cycles(bounces=4)
    assert ours.rgb[0, 0].max() == theirs.rgb[0, 0].max() == 0.0
    assert np.abs(ours.alpha - theirs.alpha).mean() < 0.01
    agreement(f"unseen_world_{film}", ours, theirs).check()
