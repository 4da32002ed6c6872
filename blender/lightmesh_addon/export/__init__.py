"""From Blender's evaluated scene to what the `lightmesh` package renders. Nothing in here computes light."""
