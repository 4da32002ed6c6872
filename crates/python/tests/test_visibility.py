"""Soft visibility at points of one's own."""

import warnings

import numpy as np
import pytest
from conftest import floor

import lightmesh
from lightmesh import Geometry, Light, Scene

UP = (0.0, 1.0, 0.0)


def half_covered() -> Scene:
    """A floor under a wide light, half of which a wall hides from the floor's middle: the wall's edge is above it."""
    corners = np.array([(-3, 1, -3), (-3, 1, 3), (0, 1, 3), (0, 1, -3)], np.float32)
    roof = Geometry.from_arrays(corners, [(0, 1, 2), (0, 2, 3)])
    return Scene([floor(), roof], [Light.rectangle((0.0, 2.0, 0.0), (0.5, 0.0, 0.0), (0.0, 0.0, 0.5))])


def test_shares_of_a_light():
    points = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (-1.5, 0.0, 0.0)]
    shares = lightmesh.visibility(points, [UP] * 3, half_covered(), samples=256, device="cpu")
    assert shares.shape == (3, 1) and shares.dtype == np.float32
    np.testing.assert_allclose(shares[:, 0], (0.5, 1.0, 0.0), atol=0.03)


def test_behind_is_dark():
    shares = lightmesh.visibility([(2.0, 0.0, 0.0)], [(0.0, -1.0, 0.0)], half_covered(), device="cpu")
    assert shares[0, 0] == 0.0


def test_lights_stand_in_for_those_of_the_scene(renderer):
    lights = [Light.point((2.0, 3.0, 0.0)), Light.point((-2.0, 1.5, 0.0))]
    prepared = renderer.prepare(half_covered())
    shares = renderer.visibility(np.zeros((1, 3)) + (2.0, 0.0, 0.0), np.array([UP]), prepared, lights)
    np.testing.assert_array_equal(shares, [[1.0, 0.0]])
    assert len(prepared.scene.lights) == 1


def test_no_points_and_no_lights(renderer):
    empty = np.zeros((0, 3), np.float32)
    assert renderer.visibility(empty, empty, half_covered()).shape == (0, 1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert renderer.visibility([(0, 0, 0)], [UP], half_covered(), lights=[]).shape == (1, 0)
    with pytest.warns(lightmesh.LightmeshWarning, match="the scene has no lights"):
        assert renderer.visibility([(0, 0, 0)], [UP], Scene([floor()])).shape == (1, 0)


def test_one_normal_for_all(renderer):
    points = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (-1.5, 0.0, 0.0)]
    each, one = (renderer.visibility(points, normals, half_covered(), samples=64) for normals in ([UP] * 3, UP))
    np.testing.assert_array_equal(each, one)
    with pytest.raises(lightmesh.GeometryError, match="normals"):
        renderer.visibility(points, (0.0, 1.0), half_covered())
    with pytest.raises(lightmesh.GeometryError, match="finite"):
        renderer.visibility(points, (0.0, np.nan, 0.0), half_covered())


def test_the_sun_of_a_sky_is_a_light(renderer):
    shares = renderer.visibility([(2.0, 0.0, 0.0)], [UP], half_covered(), lights=[], sky="clear;sun=60,180")
    np.testing.assert_array_equal(shares, [[1.0]])


@pytest.mark.parametrize(
    ("points", "normals"),
    [([(0, 0, 0)], [UP, UP]), ([(0, 0, 0)], [(0, 0, 0)]), ([(0, 0)], [UP]), ([(np.nan, 0, 0)], [UP])],
    ids=["numbers", "no direction", "shape", "not finite"],
)
def test_points_that_cannot_be_used(renderer, points, normals):
    with pytest.raises(lightmesh.GeometryError):
        renderer.visibility(points, normals, half_covered())


def test_agrees_with_the_layer(renderer, scene):
    """What a frame's layer says of pixels, this says of the points that they see."""
    frame = renderer.render(scene, size=(48, 36), mode="area", samples=256, layers=True)
    seen = np.isfinite(frame.depth)
    shares = renderer.visibility(frame.position[seen], frame.normal[seen], scene, samples=256)
    assert np.abs(shares[:, 0] - frame.visibility[0][seen]).mean() < 0.02
