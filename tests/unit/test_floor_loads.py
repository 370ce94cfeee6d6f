"""Loads of floor panels on beams: by area, with nothing lost, against closed forms."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from frames import Frame, ModelError
from frames.assembly.assemble import assemble
from frames.model.floors import nearest_edges, one_way, turning
from frames.model.load_combinations import applied_loads
from frames.model.sanity_checks import sanity_warnings
from tests.refusals import refused
from tests.scenes import SECTION as BEAM

Q = 5e3  # N/m2
PANELS = {
    "rectangle": [(0, 0), (8, 0), (8, 5), (0, 5)],
    "turned square": [(0, -3), (3, 0), (0, 3), (-3, 0)],
    "triangle": [(0, 0), (7, 1), (2, 5)],
    "trapezoid": [(0, 0), (9, 0), (6, 4), (1, 4)],
    "five corners": [(0, 0), (4, -1), (7, 2), (5, 6), (1, 4)],
    "a corner on an edge": [(0, 0), (3, 0), (8, 0), (8, 5), (0, 5)],
}


def floor(corners, offsets=None, split=False):
    """Return a floor of beams around a panel, held at its corners; `split`: in two pieces each."""
    frame = Frame("floor")
    names = [f"c{k}" for k in range(len(corners))]
    for name, (x, y) in zip(names, corners, strict=True):
        frame.add_node(name, x, y, 3.0)
        frame.add_spring(f"s{name}", *held(frame, name), (1e6,) * 6)
    for k, name in enumerate(names):
        after = names[(k + 1) % len(names)]
        if split:
            ends = [np.array(frame.nodes[each].position) for each in (name, after)]
            middle = 0.3 * ends[0] + 0.7 * ends[1]
            frame.add_node(f"m{k}", *middle)
            frame.add_member(f"b{k}", f"m{k}", name, BEAM)  # against the way around
            frame.add_member(f"b{k}+", f"m{k}", after, BEAM)
        else:
            frame.add_member(f"b{k}", name, after, BEAM, offsets=(offsets or {}).get(k))
    frame.add_mass(names[0], 1.0)
    return frame, names


def held(frame, name):
    node = frame.nodes[name]
    frame.add_node(f"g{name}", node.x, node.y, 0.0)
    frame.fix(f"g{name}", "all")
    return f"g{name}", name


def area_and_centre(corners):
    x, y = np.array(corners, dtype=float).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    area = 0.5 * cross.sum()
    return abs(area), *(
        ((values + np.roll(values, -1)) * cross).sum() / (6.0 * area) for values in (x, y)
    )


def total(frame):
    """Return the force and the moments about x and y of all nodal loads, weights left out."""
    load = assemble(frame).node_load.reshape(-1, 6)
    places = np.array([node.position for node in frame.nodes.values()])
    load[:, 2] += frame.gravity * np.array([frame.masses.get(n, [0.0])[0] for n in frame.nodes])
    moment = (load[:, 3:] + np.cross(places, load[:, :3])).sum(axis=0)
    return load[:, 2].sum(), moment[0], moment[1]


@pytest.mark.parametrize("span", [None, "x", "y", (1.0, 0.7)])
@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize("panel", PANELS)
def test_nothing_is_lost(panel, split, span):
    corners = PANELS[panel]
    frame, names = floor(corners, split=split)
    frame.add_floor_load("slab", names, Q, span=span)
    area, x, y = area_and_centre(corners)
    force, about_x, about_y = total(frame)
    assert_allclose(force, -Q * area, rtol=1e-12)
    scale = Q * area * 5.0
    assert_allclose([about_x + Q * area * y, about_y - Q * area * x], 0.0, atol=1e-12 * scale)
    backwards, names = floor(corners, split=split)
    backwards.add_floor_load("slab", names[::-1], Q, span=span)
    assert_allclose(total(backwards), (force, about_x, about_y), atol=1e-12 * scale)


def test_a_rectangle_has_triangles_and_trapezoids():
    """5 q L^2 / 96 at clamped ends, and q L^2 / 12 (1 - 2 (a/L)^2 + (a/L)^3); tables of beams."""
    frame, names = floor(PANELS["rectangle"])
    frame.add_floor_load("slab", names, Q)
    moments = np.abs(assemble(frame).members.fixed_end[:, 4])
    long, short = 8.0, 5.0
    a, peak = 0.5 * short / long, Q * 0.5 * short
    wide = peak * long**2 / 12.0 * (1.0 - 2.0 * a**2 + a**3)
    assert_allclose(moments, [wide, 5.0 * peak * short**2 / 96.0] * 2, rtol=1e-12)


def test_a_triangle_has_its_peaks_over_the_centre_of_its_inner_circle():
    corners = np.array(PANELS["triangle"], dtype=float)
    frame, names = floor(PANELS["triangle"])
    frame.add_floor_load("slab", names, Q)
    sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
    radius = 2.0 * area_and_centre(corners)[0] / sides.sum()
    for k, side in enumerate(sides):
        parts = [load for name, load, _ in applied_loads(frame).spans if name == f"b{k}"]
        assert max(-min(p.start[2], p.end[2]) for p in parts) == pytest.approx(Q * radius)
        down = sum(0.5 * (p.start[2] + p.end[2]) * (p.b - p.a) for p in parts)
        assert down == pytest.approx(-0.5 * Q * radius * side)


@pytest.mark.parametrize("panel", ["trapezoid", "five corners"])
def test_every_point_goes_to_the_nearest_edge(panel):
    """What each beam gets, against a million points of the panel."""
    corners = np.array(PANELS[panel], dtype=float)
    frame, names = floor(PANELS[panel])
    frame.add_floor_load("slab", names, Q)
    edges = np.roll(corners, -1, axis=0) - corners
    inward = np.stack([-edges[:, 1], edges[:, 0]], axis=1) / np.linalg.norm(edges, axis=1)[:, None]
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = (high - low) / 1000.0
    grid = [low[k] + size[k] * (np.arange(1000) + 0.5) for k in range(2)]
    points = np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1).reshape(-1, 2)
    away = np.stack([(points - c) @ n for c, n in zip(corners, inward, strict=True)])
    nearest = away.argmin(axis=0)[(away > 0.0).all(axis=0)]
    expected = Q * size.prod() * np.bincount(nearest, minlength=len(corners))
    forces = assemble(frame).members.fixed_end
    assert_allclose(forces[:, 2] + forces[:, 8], expected, rtol=3e-3)


def test_one_way_between_two_beams():
    frame, names = floor(PANELS["rectangle"])
    frame.add_floor_load("slab", names, Q, span="y")
    forces = assemble(frame).members.fixed_end
    half = 0.5 * Q * 5.0
    assert_allclose(forces[[0, 2], 2], [0.5 * half * 8.0] * 2, rtol=1e-12)
    assert_allclose(np.abs(forces[[0, 2], 4]), [half * 64.0 / 12.0] * 2, rtol=1e-12)
    assert not forces[[1, 3]].any()
    frame.remove("member", "b1")  # carries nothing
    assert_allclose(assemble(frame).members.fixed_end[0], forces[0])


def test_the_load_on_end_zones_goes_to_the_nodes():
    zones = {0: {"i": (0.4, 0, 0), "j": (-0.3, 0, -0.2)}, 1: {"i": (0, 0.5, 0)}}
    frame, names = floor(PANELS["rectangle"], offsets=zones)
    plain, _ = floor(PANELS["rectangle"])
    for each in (frame, plain):
        each.add_floor_load("slab", names, Q)
    assert_allclose(total(frame), total(plain), rtol=1e-12)
    assert {node for node, _, _ in applied_loads(frame).nodes} == {"c0", "c1"}


def test_loads_that_are_kept_from_before_follow_a_change_of_the_floor():
    frame, names = floor(PANELS["rectangle"])
    frame.add_floor_load("slab", names, Q)
    once = applied_loads(frame).spans
    frame.add_floor_load("more", names, Q)
    assert applied_loads(frame).spans == [*once, *once]


def test_the_mass_of_a_floor_is_at_the_ends_of_its_beams_and_weighs_once():
    corners = PANELS["trapezoid"]
    frame, names = floor(corners, split=True)
    frame.add_floor_load("slab", names, Q, mass=0.6)
    system = assemble(frame)
    area, x, y = area_and_centre(corners)
    mass = system.node_mass[:, 0].copy()
    mass[system.node_names.index("c0")] -= 1.0
    assert mass.sum() == pytest.approx(0.6 * Q * area / frame.gravity)
    assert_allclose(mass @ system.coordinates[:, :2] / mass.sum(), [x, y], rtol=1e-12)
    assert_allclose(system.node_mass[:, 0], system.node_mass[:, 2])
    assert system.node_load[2::6].sum() == pytest.approx(-Q * area - frame.gravity)
    copy = frame.copy()
    copy.remove("floor load", "slab")
    assert not copy.floor_loads
    assert frame.floor_loads["slab"].q == Q
    assert assemble(copy).node_mass.sum() == 3.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"nodes": ["c0", "c1"]}, "name at least 3"),
        ({"nodes": ["c0", "c2", "c1", "c3"]}, "must form a convex outline"),
        ({"nodes": ["c0", "c1", "inside", "c2"]}, "must form a convex outline"),
        ({"nodes": ["c0", "c1", "gc2", "c3"]}, "not horizontal"),
        ({"nodes": ["c0", "c1", "c2"]}, 'from "c2" to "c0" no member goes on'),
        ({"q": -2e3}, "must be positive"),
        ({"q": float("nan")}, "must be positive"),
        ({"span": "z"}, 'span = "z"'),
        ({"span": (0.0, 0.0)}, "no direction"),
        ({"mass": -0.5}, "at least 0"),
        ({"case": ""}, "empty"),
        ({"name": "there"}, "exists already"),
    ],
)
def test_panels_that_cannot_be(change, words):
    frame, names = floor([(0, 0), (4, 0), (4, 4), (0, 4)])
    frame.add_node("inside", 1.0, 1.5, 3.0)
    frame.add_floor_load("there", names, Q)
    with pytest.raises((ModelError, TypeError), match=words):
        frame.add_floor_load(**({"name": "new", "nodes": names, "q": Q} | change))
    assert list(frame.floor_loads) == ["there"]


def test_two_beams_along_one_edge_and_beams_that_have_gone():
    frame, names = floor([(0, 0), (4, 0), (4, 4), (0, 4)])
    frame.add_floor_load("slab", names, Q)
    frame.add_member("twin", "c0", "c1", BEAM)
    refused(ModelError, r'several members go on \("b0", "twin"\)', assemble, frame)
    frame.remove("member", "twin")
    frame.remove("member", "b2")
    refused(ModelError, r'"slab".*from "c2" to "c3" no member goes on', assemble, frame)


def test_a_load_in_kilonewtons_is_a_doubt():
    frame, names = floor([(0, 0), (4, 0), (4, 4), (0, 4)])
    frame.add_floor_load("slab", names, 5.0)
    (doubt,) = [d for d in sanity_warnings(frame) if "slab" in d]
    assert "5 kN/m2 are 5000 N/m2" in doubt


def test_depths_do_not_depend_on_where_the_panel_lies():
    corners = np.array(PANELS["five corners"], dtype=float)
    turn = math.radians(37.0)
    matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    for ours, theirs in zip(
        nearest_edges(corners), nearest_edges(corners @ matrix.T + 100.0), strict=True
    ):
        assert_allclose(ours, theirs, atol=1e-10)


def random_outline(rng):
    """Return a convex outline of three to eight corners, some of them on an edge."""
    while True:
        angles = np.sort(rng.uniform(0.0, 2.0 * math.pi, rng.integers(3, 9)))
        gaps = np.diff([*angles, angles[0] + 2.0 * math.pi])
        if gaps.min() > 1e-2 and gaps.max() < math.pi - 1e-2:
            break
    corners = np.stack([np.cos(angles), np.sin(angles)], axis=1) * rng.uniform(0.5, 20.0, 2)
    if rng.uniform() < 0.3:
        middle = corners[0] + rng.uniform(0.2, 0.8) * (corners[1] - corners[0])
        corners = np.insert(corners, 1, middle, axis=0)
    return corners


@pytest.mark.parametrize("seed", range(40))
def test_random_outlines_lose_nothing(seed):
    """Sum and first moments of the pieces on all edges are those of the area."""
    rng = np.random.default_rng(seed)
    corners = random_outline(rng)
    assert turning(corners, "it") == 1.0
    assert turning(corners[::-1], "it") == -1.0
    area, x, y = area_and_centre(corners)
    along = corners[1] - corners[0]
    spans = [along / np.linalg.norm(along), np.array([0.6, 0.8])]
    for edges in (nearest_edges(corners), *(one_way(corners, span) for span in spans)):
        force, moments = 0.0, np.zeros(2)
        for start, end, pieces in zip(corners, np.roll(corners, -1, axis=0), edges, strict=True):
            way = (end - start) / np.linalg.norm(end - start)
            for s0, h0, s1, h1 in pieces:
                assert min(h0, h1) > -1e-9
                part = 0.5 * (h0 + h1) * (s1 - s0)
                lever = (s1 - s0) / 6.0 * (s0 * (2.0 * h0 + h1) + s1 * (h0 + 2.0 * h1))
                force, moments = force + part, moments + part * start + lever * way
        assert force == pytest.approx(area, rel=1e-9)
        assert_allclose(moments / area, [x, y], atol=1e-9 * np.ptp(corners))
