"""The evaluated scene as a `lightmesh.Scene`: meshes, their places, lights and surroundings. Everything is in Blender's world coordinates."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import bpy
import lightmesh
import numpy as np
from mathutils import Matrix

from . import differences, geometry, lights, world
from .materials import Materials
from .textures import Textures
from .visibility import RenderVisibility

if TYPE_CHECKING:
    from ..notes import Notes
    from .materials import Made

#: Objects that have faces.
SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
#: Objects that would be seen, but have no counterpart.
UNSEEN = {"CURVES": "hair curves", "POINTCLOUD": "a point cloud", "VOLUME": "a volume", "GREASEPENCIL": "Grease Pencil", "GPENCIL": "Grease Pencil"}


@dataclass
class Exported:
    """What a scene is made of, and what a render of it needs to know."""

    #: Makes the objects; called once they are needed.
    objects: Callable[[], list[lightmesh.Geometry]]
    lights: list[lightmesh.Light]
    surroundings: world.World
    name: str
    #: Names of the lights, in their order, each once.
    light_names: list[str]
    #: Lower and upper corner of all objects, world coordinates; `None` without any.
    bounds: tuple[np.ndarray, np.ndarray] | None
    #: Digest of objects and materials: equal ones show the same.
    digest: bytes
    #: Settings of the render that come from what shines.
    settings: dict = field(default_factory=dict)
    #: Pass indices of objects and materials by name.
    object_indices: dict[str, int] = field(default_factory=dict)
    material_indices: dict[str, int] = field(default_factory=dict)
    #: Names of objects and of materials that cut holes into the image.
    holdouts: set[str] = field(default_factory=set)
    holdout_materials: set[str] = field(default_factory=set)

    #: Names, places and arrays of what there is.
    meshes: Callable[[], list[tuple[str, list[np.ndarray], geometry.Arrays]]] = list

    @property
    def has_holdouts(self) -> bool:
        return bool(self.holdouts or self.holdout_materials)

    def scene(self, camera: lightmesh.Camera, before: "Exported | None" = None, prepared: lightmesh.PreparedScene | None = None) -> lightmesh.Scene:
        """The scene. If `before`, which was `prepared`, has the same objects, it is that with other lights and another camera: what was
        computed for the objects, and with the same world for the light that they gather, holds on."""
        surroundings = self.surroundings
        # Surfaces gather what the world gives; a number would stand in for it.
        ambient = None if surroundings.lights else 0.0
        if before is None or prepared is None or before.digest != self.digest:
            return lightmesh.Scene(
                self.objects(),
                self.lights,
                camera,
                environment=surroundings.environment,
                ambient=ambient,
                background=surroundings.background,
                name=self.name,
            )
        scene = prepared.scene
        # A sun that was found in a panorama is behind the lights that were given.
        found = scene.lights[len(before.lights) :]
        scene.lights, scene.camera, scene.ambient, scene.background = [*self.lights, *found], camera, ambient, surroundings.background
        if before.surroundings.digest != surroundings.digest:
            scene.environment = surroundings.environment
        return scene


class MeshStore:
    """Arrays of meshes, kept while a viewport shows a scene. Without one, an export reads everything anew."""

    def __init__(self) -> None:
        self.arrays = {}
        self.textures = None

    def forget(self, updates: Iterable[bpy.types.DepsgraphUpdate]) -> None:
        """Drops what the updates of a dependency graph change."""
        changed = {update.id.original.name_full for update in updates if update.is_updated_geometry}
        changed |= {update.id.original.name_full for update in updates if update.id.id_type in ("MATERIAL", "NODETREE")}
        self.arrays = {key: kept for key, kept in self.arrays.items() if not changed & kept[1]}
        images = {update.id.original.name_full for update in updates if update.id.id_type == "IMAGE"}
        if self.textures and images:
            fresh = Textures(self.textures.notes)
            fresh.keep_from(self.textures, images)
            self.textures = fresh


class _Group:
    """Places of one object's data, by the name of the object that shows it."""

    def __init__(self, arrays: geometry.Arrays, materials: list[Made]) -> None:
        self.arrays, self.materials, self.places = arrays, materials, {}

    def all_places(self) -> list[np.ndarray]:
        return [place for places in self.places.values() for place in places]


class Exporter:
    """Reads one dependency graph. `view` is the 3D view whose objects count, if it is a viewport's; without one, those that renders show. `sky`
    stands for the world, as settings of a render say it."""

    def __init__(
        self,
        depsgraph: bpy.types.Depsgraph,
        notes: Notes,
        store: MeshStore | None = None,
        view: bpy.types.SpaceView3D | None = None,
        sky: str = "",
    ) -> None:
        self.depsgraph, self.notes, self.view, self.sky = depsgraph, notes, view, sky
        # Operators have no dependency graph of a render: that of the viewport stands for it.
        self.visibility = RenderVisibility(depsgraph, notes) if view is None and depsgraph.mode == "VIEWPORT" else None
        self.store = store or MeshStore()
        textures = Textures(notes)
        if self.store.textures:
            textures.keep_from(self.store.textures, ())
        self.store.textures = textures
        self.materials = Materials(notes, textures)
        self.groups, self.lights, self.light_names, self.used = {}, [], [], set()
        self.object_indices, self.material_indices = {}, {}
        self.holdouts = set()

    def run(self, stop: Callable[[], None] = lambda: None) -> Exported:
        """What there is in the scene. `stop` is called for each object, and may raise."""
        for instance in self.depsgraph.object_instances:
            stop()
            self._instance(instance)
        surroundings = world.of_sky(self.sky) if self.sky else world.read(self._world(), self.materials.textures, self.notes)
        self.store.arrays = {key: kept for key, kept in self.store.arrays.items() if key in self.used}
        self._warn_of_holdouts(surroundings)
        return Exported(
            self._geometry,
            self.lights,
            surroundings,
            self.depsgraph.scene.name,
            self.light_names,
            self._bounds(),
            self._digest(),
            self._settings(surroundings),
            self.object_indices,
            self.material_indices,
            self.holdouts,
            self.materials.holdouts,
            lambda: [(name, places, group.arrays) for group in self._shown() for name, places in group.places.items()],
        )

    def _settings(self, surroundings: world.World) -> dict[str, Any]:
        settings = dict(surroundings.settings)
        if self.materials.emit and self.depsgraph.scene.lightmesh.ambient_light == "AUTO":
            # The light of surfaces is found by what gathers it.
            settings["ambient_light"] = "mesh"
        return settings

    def _warn_of_holdouts(self, surroundings: world.World) -> None:
        """Holdouts are black, so that pixels which they share with others have the light of the others."""
        wish = self.depsgraph.scene.lightmesh.ambient_light
        if wish == "GATHERED" or (wish == "AUTO" and (surroundings.lights or self.materials.emit)):
            for name in sorted(self.holdouts):
                self.notes.add(f"Object “{name}” is a holdout: what is around it gets no light from it here, as if it were black")

    def _shown(self) -> list[_Group]:
        return [group for group in self.groups.values() if group is not None]

    def _bounds(self) -> tuple[np.ndarray, np.ndarray] | None:
        corners = [
            place[:3, :3] @ corner + place[:3, 3] for group in self._shown() for corner in group.arrays.corners() for place in group.all_places()
        ]
        return (np.min(corners, axis=0), np.max(corners, axis=0)) if corners else None

    def _digest(self) -> bytes:
        digest = hashlib.blake2b(digest_size=16)
        for group in self._shown():
            group.arrays.digest_into(digest)
            digest.update(repr([made.digest for made in group.materials]).encode())
            for name, places in group.places.items():
                digest.update(name.encode())
                digest.update(np.ascontiguousarray(places))
        return digest.digest()

    def _world(self) -> bpy.types.World | None:
        shown = self.depsgraph.scene.world
        return shown.evaluated_get(self.depsgraph) if shown else None

    def _instance(self, instance: bpy.types.DepsgraphObjectInstance) -> None:
        obj = instance.object
        if not instance.show_self or (self.view and not self._in_view(instance)):
            return
        if self.visibility and not self.visibility.shows(instance):
            return
        if obj.type == "LIGHT":
            self._light(obj, instance.matrix_world)
        elif obj.type in SURFACES:
            self._surface(obj, instance)
        elif obj.type in UNSEEN:
            self.notes.add(f"Object “{obj.name}” is {UNSEEN[obj.type]}, which is left out")

    def _in_view(self, instance: bpy.types.DepsgraphObjectInstance) -> bool:
        obj = instance.parent if instance.is_instance and instance.parent else instance.object
        return obj.original.visible_in_viewport_get(self.view)

    def _light(self, obj: bpy.types.Object, matrix: Matrix) -> None:
        made = lights.light(obj, matrix, self.notes)
        if made is None:
            return
        name, names = obj.name, self.light_names
        number = 1
        while name in names:
            name, number = f"{obj.name}.{number:03}", number + 1
        self.lights.append(made if name == obj.name else made.replaced(name=name))
        names.append(name)

    def _surface(self, obj: bpy.types.Object, instance: bpy.types.DepsgraphObjectInstance) -> None:
        if not obj.visible_camera or not obj.visible_shadow or not obj.visible_diffuse:
            self.notes.add(f"Object “{obj.name}” is hidden from some rays, but not here")
        differences.of_linking(obj, f"Object “{obj.name}”", self.notes)
        # Flags of collections are those of the object that shows an instance.
        shown_by = instance.parent if instance.is_instance and instance.parent else obj
        holdout = shown_by.original.holdout_get(view_layer=self.depsgraph.view_layer)
        if not holdout and shown_by.original.indirect_only_get(view_layer=self.depsgraph.view_layer):
            self.notes.add(f"Object “{shown_by.name}” is only seen indirectly in the scene (a collection of it is Indirect Only), but by the camera, too, here")
        group = self._group(obj, holdout)
        if group:
            name = obj.name
            if holdout:
                # Instances of an object may be held out in one place and seen in another.
                name = name if shown_by is obj else f"{name} of {shown_by.name}"
                self.holdouts.add(name)
            group.places.setdefault(name, []).append(np.array(instance.matrix_world, order="C"))
            self.object_indices[name] = obj.pass_index

    def _group(self, obj: bpy.types.Object, holdout: bool) -> _Group | None:
        """What the object shows, read once for all objects that show the same data with the same materials."""
        data = obj.data
        slots = tuple(slot.material.name_full if slot.material else None for slot in obj.material_slots if slot.link == "OBJECT")
        key = (data.as_pointer() if data else obj.as_pointer(), obj.type, data.name if data else "", slots, obj.is_shadow_catcher, holdout)
        if key not in self.groups:
            self.groups[key] = self._read(obj, key, holdout)
        self.used.add(key)
        return self.groups[key]

    def _read(self, obj: bpy.types.Object, key: tuple, holdout: bool) -> _Group | None:
        mesh = obj.to_mesh()
        if mesh is None:
            return None
        try:
            used = self._materials_of(obj, mesh)
            made = [self._material(material, obj.is_shadow_catcher, holdout) for material in used]
            kept = self.store.arrays.get(key)
            arrays = kept[0] if kept else geometry.read(mesh, made, self.notes)
        finally:
            obj.to_mesh_clear()
        names = {obj.original.name_full, *(material.name_full for material in used if material)}
        if obj.data:
            names.add(obj.data.original.name_full if obj.data.original else obj.data.name_full)
        self.store.arrays[key] = (arrays, names)
        return _Group(arrays, made) if arrays else None

    def _materials_of(self, obj: bpy.types.Object, mesh: bpy.types.Mesh) -> list[bpy.types.Material | None]:
        """Materials by slot: those of the data, but for slots whose material is the object's."""
        used = list(mesh.materials)
        for index, slot in enumerate(obj.material_slots):
            if index >= len(used):
                used.append(slot.material)
            elif slot.link == "OBJECT":
                used[index] = slot.material
        return used or [None]

    def _material(self, material: bpy.types.Material | None, catcher: bool, holdout: bool) -> Made:
        if material is not None:
            material = material.evaluated_get(self.depsgraph)
            self.material_indices[material.name] = material.pass_index
        return self.materials.of(material, catcher and not holdout, holdout)

    def _geometry(self) -> list[lightmesh.Geometry]:
        """Each kind of geometry once, in all of its places. Objects keep their names."""
        found = []
        for group in self._shown():
            arrays, shared = group.arrays, None
            for name, places in group.places.items():
                places = np.stack(places)
                if shared is not None:
                    found.append(shared.placed(places, name=name))
                    continue
                shared = lightmesh.Geometry.from_arrays(
                    arrays.vertices,
                    arrays.triangles,
                    normals=arrays.normals,
                    uvs=arrays.uvs,
                    colors=arrays.colors,
                    materials=[made.material for made in group.materials],
                    material_indices=arrays.material_indices,
                    transforms=places,
                    name=name,
                )
                found.append(shared)
        return found
