"""The beam-column and the spring against closed forms and against an independent derivation."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
import scipy.linalg
from numpy.testing import assert_allclose
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from frames._errors import ModelError
from frames.assembly.members import (
    MemberArrays,
    fixed_end_forces,
    local_geometric_stiffness,
    local_stiffness,
    member_arrays,
    spring_stiffness,
)
from frames.model.axes import default_up, local_axes, matrix_to_global, to_global
from frames.model.sections import Section
from tests.refusals import refused

Array = npt.NDArray[np.float64]

BEAM = Section.i_shape(0.5, 0.2, 0.02, 0.012)
SLENDER = replace(BEAM, shear_area_y=math.inf, shear_area_z=math.inf)
ROUND_OFF = 1e-11  # matrix entries are sums of a few products, scaled by the largest entry


def along_x(section: Section, length: float, count: int = 1) -> MemberArrays:
    """Return equal members along global X."""
    start = np.zeros((count, 3))
    end = np.tile([length / count, 0.0, 0.0], (count, 1))
    return member_arrays([section] * count, start, end, default_up(start, end))


def random_members(seed: int, count: int = 6) -> tuple[MemberArrays, Array, Array, Array]:
    """Return members in random places with random `up` vectors."""
    rng = np.random.default_rng(seed)
    start, end, up = rng.normal(size=(3, count, 3))
    return member_arrays([BEAM] * count, start, end, up), start, end, up


@pytest.mark.parametrize("section", [BEAM, SLENDER], ids=["timoshenko", "euler-bernoulli"])
@pytest.mark.parametrize(
    ("dof", "inertia", "shear_area"),
    [(1, "inertia_z", "shear_area_y"), (2, "inertia_y", "shear_area_z")],
)
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_cantilever_bends_as_the_closed_form(section, dof, inertia, shear_area, sign):
    length, force = 3.0, sign * 1e4
    tip = local_stiffness(along_x(section, length))[0, 6:, 6:]
    load = np.zeros(6)
    load[dof] = force
    u = np.linalg.solve(tip, load)
    flexural = section.elastic_modulus * getattr(section, inertia)
    shear = section.shear_modulus * getattr(section, shear_area)
    deflection = force * length**3 / (3.0 * flexural) + force * length / shear
    slope = force * length**2 / (2.0 * flexural)
    assert_allclose(u[dof], deflection, rtol=ROUND_OFF)
    turn = u[5] if dof == 1 else -u[4]  # dv/dx = rz, dw/dx = -ry
    assert_allclose(turn, slope, rtol=ROUND_OFF)


def test_bar_stretches_and_twists_as_the_closed_form() -> None:
    length = 2.5
    tip = local_stiffness(along_x(BEAM, length))[0, 6:, 6:]
    u = np.linalg.solve(tip, [1e5, 0.0, 0.0, 1e3, 0.0, 0.0])
    stretch = 1e5 * length / (BEAM.elastic_modulus * BEAM.area)
    twist = 1e3 * length / (BEAM.shear_modulus * BEAM.torsion_constant)
    assert_allclose(u[[0, 3]], [stretch, twist], rtol=ROUND_OFF)
    assert_allclose(u[[1, 2, 4, 5]], 0.0, rtol=0.0, atol=1e-18)  # uncoupled, exact zeros


def test_propped_beam_under_uniform_load() -> None:
    # Clamped at i, propped at j, slender: prop 3/8 q L, clamp moment q L^2 / 8.
    length, q = 6.0, -20e3
    beam = along_x(SLENDER, length)
    fixed = fixed_end_forces(beam, np.array([[0.0, 0.0, q]]))[0]
    stiffness = local_stiffness(beam)[0]
    u = np.zeros(12)
    u[10] = -fixed[10] / stiffness[10, 10]
    forces = stiffness @ u + fixed
    assert_allclose(forces[8], -3.0 / 8.0 * q * length, rtol=ROUND_OFF)
    assert_allclose(forces[2], -5.0 / 8.0 * q * length, rtol=ROUND_OFF)
    # Sagging load clamps with a hogging moment: -M about local y at the left end.
    assert_allclose(forces[4], q * length**2 / 8.0, rtol=ROUND_OFF)
    assert_allclose(forces[10], 0.0, rtol=0.0, atol=1e-9 * abs(q) * length)


@pytest.mark.parametrize("direction", [(0.0, -3e3, 0.0), (0.0, 0.0, 5e3), (1e3, 2e3, -4e3)])
def test_fixed_end_forces_balance_the_load(direction: tuple[float, float, float]) -> None:
    members, start, end, _ = random_members(3)
    load = np.tile(direction, (start.shape[0], 1))
    forces = to_global(fixed_end_forces(members, load), members.axes)
    total = load * members.length[:, None]
    assert_allclose(forces[:, 0:3] + forces[:, 6:9], -total, rtol=1e-12, atol=1e-9)
    moment = forces[:, 3:6] + forces[:, 9:12] + np.cross(end - start, forces[:, 6:9])
    assert_allclose(moment, -np.cross((end - start) / 2.0, total), rtol=1e-12, atol=1e-8)


@pytest.mark.parametrize("phi", [0.0, 0.4, 3.0])
def test_plane_matrices_equal_an_energy_integral(phi: float) -> None:
    # Timoshenko beam without load: w is cubic, the rotation is w' + 6 c3 E I / (G A_s); the
    # strain and the geometric energies are integrated numerically, exact for these polynomials.
    length, flexural, axial = 1.7, 2.3e6, -4e5
    shear = 12.0 * flexural / (phi * length**2) if phi else math.inf
    section = replace(
        SLENDER,
        inertia_y=flexural / SLENDER.elastic_modulus,
        shear_area_z=shear / SLENDER.shear_modulus,
    )
    ratio = flexural / shear
    powers = np.arange(4)

    def slope(x: float) -> Array:
        return np.array([0.0, 1.0, 2.0 * x, 3.0 * x**2])

    def rotation(x: float) -> Array:
        return np.array([0.0, 1.0, 2.0 * x, 3.0 * x**2 + 6.0 * ratio])

    ends = np.array([0.0**powers, rotation(0.0), length**powers, rotation(length)])
    shapes = np.linalg.inv(ends)
    points, weights = np.polynomial.legendre.leggauss(4)
    elastic, geometric = np.zeros((4, 4)), np.zeros((4, 4))
    for point, weight in zip(points, weights, strict=True):
        x, factor = length * (point + 1.0) / 2.0, weight * length / 2.0
        curvature = np.array([0.0, 0.0, 2.0, 6.0 * x])
        strain = slope(x) - rotation(x)
        shear_energy = shear * np.outer(strain, strain) if phi else 0.0
        elastic += factor * (flexural * np.outer(curvature, curvature) + shear_energy)
        geometric += factor * axial * np.outer(slope(x), slope(x))
    places, sign = [2, 4, 8, 10], np.diag([1.0, -1.0, 1.0, -1.0])
    beam = along_x(section, length)
    for expected, matrix in (
        (elastic, local_stiffness(beam)[0]),
        (geometric, local_geometric_stiffness(beam, np.array([axial]))[0]),
    ):
        reference = sign @ shapes.T @ expected @ shapes @ sign
        scale = np.abs(reference).max()
        assert_allclose(matrix[np.ix_(places, places)], reference, rtol=0.0, atol=1e-10 * scale)


def buckling_load(section: Section, length: float, count: int) -> float:
    """Return the first buckling load of a pinned column of `count` members, bending about z."""
    members = along_x(section, length, count)
    elastic = local_stiffness(members)
    geometric = local_geometric_stiffness(members, -np.ones(count))
    size = 2 * (count + 1)
    k, kg = np.zeros((size, size)), np.zeros((size, size))
    plane = [1, 5, 7, 11]
    for n in range(count):
        at = slice(2 * n, 2 * n + 4)
        k[at, at] += elastic[n][np.ix_(plane, plane)]
        kg[at, at] += geometric[n][np.ix_(plane, plane)]
    free = [dof for dof in range(size) if dof not in {0, size - 2}]
    ratios = scipy.linalg.eigh(-kg[np.ix_(free, free)], k[np.ix_(free, free)], eigvals_only=True)
    return float(1.0 / ratios[-1])


def test_column_buckles_at_the_euler_load_with_fourth_order() -> None:
    length = 5.0
    euler = math.pi**2 * SLENDER.elastic_modulus * SLENDER.inertia_z / length**2
    for count in (4, 8, 16):
        error = buckling_load(SLENDER, length, count) / euler - 1.0
        # Cubic shape functions: relative error (pi/n)^4 / 720 from above, next term of order n^-6.
        predicted = (math.pi / count) ** 4 / 720.0
        assert_allclose(error, predicted, rtol=1.0 / count**2, atol=1e-9)


def test_column_with_shear_buckles_at_the_engesser_load() -> None:
    length = 2.0
    euler = math.pi**2 * BEAM.elastic_modulus * BEAM.inertia_z / length**2
    engesser = euler / (1.0 + euler / (BEAM.shear_modulus * BEAM.shear_area_y))
    assert engesser < 0.995 * euler
    # The shear strain is constant in a member: second order, from above. Extrapolated, the error
    # that is left is of fourth order, (pi/16)^4 / 720 = 2e-6 times a factor of order 1.
    loads = {count: buckling_load(BEAM, length, count) for count in (16, 32)}
    errors = {count: load / engesser - 1.0 for count, load in loads.items()}
    assert_allclose(errors[16] / errors[32], 4.0, rtol=0.02)
    assert_allclose((4.0 * loads[32] - loads[16]) / 3.0, engesser, rtol=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_matrices_follow_a_rotation_of_everything(seed: int) -> None:
    members, start, end, up = random_members(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    turned = member_arrays([BEAM] * len(start), start @ turn.T, end @ turn.T, up @ turn.T)
    block = scipy.linalg.block_diag(turn, turn, turn, turn)
    axial = np.linspace(-1e6, 1e6, len(start))
    pairs = (
        (local_stiffness(members), local_stiffness(turned)),
        (local_geometric_stiffness(members, axial), local_geometric_stiffness(turned, axial)),
    )
    for here, there in pairs:
        expected = block @ matrix_to_global(here, members.axes) @ block.T
        scale = np.abs(expected).max()
        result = matrix_to_global(there, turned.axes)
        assert_allclose(result, expected, rtol=0.0, atol=ROUND_OFF * scale)


def rigid_motions(start: Array, end: Array) -> Array:
    """Return the 12 x 6 small rigid motions of both ends."""
    motions = np.zeros((12, 6))
    for place, point in enumerate((start, end)):
        for axis in range(3):
            unit = np.eye(3)[axis]
            motions[6 * place + axis, axis] = 1.0
            motions[6 * place : 6 * place + 3, 3 + axis] = np.cross(unit, point)
            motions[6 * place + 3 + axis, 3 + axis] = 1.0
    return motions


def test_rigid_motions_meet_no_elastic_force() -> None:
    members, start, end, _ = random_members(7)
    stiffness = matrix_to_global(local_stiffness(members), members.axes)
    springs = spring_stiffness(end - start, np.tile([1e6, 2e6, 3e6, 1e5, 2e5, 3e5], (6, 1)))
    for n in range(6):
        motions = rigid_motions(start[n], end[n])
        for matrix in (stiffness[n], springs[n]):
            assert_allclose(matrix, matrix.T, rtol=0.0, atol=1e-12 * np.abs(matrix).max())
            forces = matrix @ motions
            assert_allclose(forces, 0.0, rtol=0.0, atol=ROUND_OFF * np.abs(matrix).max())


def test_spring_acts_at_node_j() -> None:
    matrix = spring_stiffness(np.array([[0.0, 0.0, 2.0]]), np.array([[5.0, 0, 0, 0, 0, 0]]))[0]
    forces = matrix @ np.eye(12)[6]  # node j moves by 1 along x
    assert_allclose(forces[[0, 4, 6]], [-5.0, -10.0, 5.0], rtol=1e-15)


@pytest.mark.parametrize(
    ("end", "rows"),
    [
        ((4.0, 0.0, 0.0), [(1, 0, 0), (0, 1, 0), (0, 0, 1)]),
        ((0.0, 4.0, 0.0), [(0, 1, 0), (-1, 0, 0), (0, 0, 1)]),
        ((0.0, 0.0, 4.0), [(0, 0, 1), (0, -1, 0), (1, 0, 0)]),
        ((0.0, 0.0, -4.0), [(0, 0, -1), (0, 1, 0), (1, 0, 0)]),
    ],
    ids=["along X", "along Y", "upwards", "downwards"],
)
def test_default_local_axes(end, rows):
    start, tip = np.zeros((1, 3)), np.array([end])
    axes, length = local_axes(start, tip, default_up(start, tip))
    assert_allclose(axes[0], rows, rtol=0.0, atol=1e-15)
    assert_allclose(length, 4.0, rtol=1e-15)


def test_local_axes_refuse_a_parallel_up_vector() -> None:
    start, end = np.zeros((1, 3)), np.array([[0.0, 2.0, 0.0]])
    with pytest.raises(ModelError, match=r"parallel to its axis"):
        local_axes(start, end, np.array([[0.0, -1.0, 0.0]]))
    refused(ModelError, r"length 0 m", local_axes, start, start, np.array([[0.0, 0.0, 1.0]]))


def test_bar_loses_its_torsional_stiffness_at_the_wagner_load() -> None:
    # Torsional buckling without warping: P = G J A / (I_y + I_z).
    bar = along_x(BEAM, 3.0)
    polar = BEAM.inertia_y + BEAM.inertia_z
    load = BEAM.shear_modulus * BEAM.torsion_constant * BEAM.area / polar
    elastic = local_stiffness(bar)[0, 9, 9]
    left = elastic + local_geometric_stiffness(bar, np.array([-load]))[0, 9, 9]
    assert_allclose(left, 0.0, rtol=0.0, atol=ROUND_OFF * elastic)


def test_torsion_constants_and_shear_areas_of_shapes() -> None:
    # Square tube: Bredt gives t (b - t)^3; two walls carry each shear force.
    tube = Section.box(0.3, 0.3, 0.01)
    assert_allclose(tube.torsion_constant, 0.01 * 0.29**3, rtol=1e-14)
    areas = [tube.shear_area_y, tube.shear_area_z]
    assert_allclose(areas, 2 * 0.01 * 0.29, rtol=1e-14)
    # I shape: two flanges 0.2 x 0.02, web 0.012 over 0.48 between the flange centre lines.
    thin = (2 * 0.2 * 0.02**3 + 0.48 * 0.012**3) / 3.0
    assert_allclose(BEAM.torsion_constant, thin, rtol=1e-14)
    areas = [BEAM.shear_area_y, BEAM.shear_area_z]
    assert_allclose(areas, [5 / 6 * 0.008, 0.48 * 0.012], rtol=1e-14)
    solid = Section.rectangle(0.2, 0.3)
    assert_allclose([solid.shear_area_y, solid.shear_area_z], 0.05, rtol=1e-14)


def test_box_and_i_shape_and_rectangle() -> None:
    box = Section.box(0.3, 0.4, 0.01)
    assert_allclose(box.area, 0.3 * 0.4 - 0.28 * 0.38, rtol=1e-14)
    assert_allclose(box.inertia_y, (0.3 * 0.4**3 - 0.28 * 0.38**3) / 12, rtol=1e-14)
    # IPE 300 without fillets; the table's values with fillets are 53.8 cm2, 8356 and 604 cm4.
    ipe = Section.i_shape(0.300, 0.150, 0.0107, 0.0071)
    assert_allclose([ipe.area, ipe.inertia_y, ipe.inertia_z], [53.8e-4, 8356e-8, 604e-8], rtol=0.05)
    # BEAM from its three plates: I 0.5 x 0.2 m, flanges 0.02, web 0.012.
    strong = 2 * (0.2 * 0.02**3 / 12 + 0.2 * 0.02 * 0.24**2) + 0.012 * 0.46**3 / 12
    weak = 2 * 0.02 * 0.2**3 / 12 + 0.46 * 0.012**3 / 12
    assert_allclose([BEAM.inertia_y, BEAM.inertia_z], [strong, weak], rtol=1e-13)
    # Saint-Venant constants of a square and of a 2:1 rectangle [Timoshenko & Goodier, art. 109].
    square, oblong = Section.rectangle(0.2, 0.2), Section.rectangle(0.4, 0.2)
    assert_allclose(square.torsion_constant, 0.1406 * 0.2**4, rtol=5e-4)
    assert_allclose(oblong.torsion_constant, 0.229 * 0.4 * 0.2**3, rtol=2e-3)
    assert_allclose(oblong.inertia_z, 0.2 * 0.4**3 / 12.0, rtol=1e-14)
    # Steel: G = E / 2.6.
    assert_allclose(square.shear_modulus, 200e9 / 2.6, rtol=1e-14)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"area": 0.0}, r"Section.area = 0 \[m2\] must be positive"),
        ({"inertia_y": -1e-4}, r"Section.inertia_y = -0.0001 \[m4\] must be positive"),
        (
            {"elastic_modulus": math.inf},
            r"Section.elastic_modulus = inf \[Pa\] must be positive and finite",
        ),
        ({"density": -1.0}, r"Section.density = -1 \[kg/m3\] must be at least 0 and finite"),
        ({"shear_area_z": math.nan}, r"Section.shear_area_z = nan \[m2\] must be positive"),
    ],
)
def test_section_refuses(changes: dict[str, float], words: str) -> None:
    refused(ModelError, words, replace, BEAM, **changes)


def test_shapes_refuse_impossible_dimensions() -> None:
    refused(ModelError, "walls overlap", Section.box, 0.2, 0.3, 0.1)
    refused(ModelError, "check the order", Section.i_shape, 0.2, 0.4, 0.15, 0.01)
    refused(ModelError, r"poisson_ratio = 0\.7", Section.rectangle, 0.2, 0.4, poisson_ratio=0.7)


def test_circle_and_tube() -> None:
    """Against integrals over the ring; shear of a solid circle and of a thin tube [Cowper 1966]."""
    solid, tube = Section.circle(0.6), Section.circle(0.6, 0.02)
    for section, inner in ((solid, 0.0), (tube, 0.28)):
        area = quad(lambda r: 2.0 * math.pi * r, inner, 0.3)[0]
        inertia = quad(lambda r: math.pi * r**3, inner, 0.3)[0]
        assert_allclose(section.area, area, rtol=1e-12)
        assert_allclose([section.inertia_y, section.inertia_z], inertia, rtol=1e-12)
        assert_allclose(section.torsion_constant, 2.0 * inertia, rtol=1e-12)
    nu = 0.3
    assert_allclose(solid.shear_area_y / solid.area, 6 * (1 + nu) / (7 + 6 * nu), rtol=1e-12)
    thin = Section.circle(1.0, 1e-5)
    assert_allclose(thin.shear_area_z / thin.area, 2 * (1 + nu) / (4 + 3 * nu), rtol=1e-4)
    refused(ModelError, r"thickness = 0\.3 m must be less than half", Section.circle, 0.6, 0.3)
    refused(ModelError, "diameter", Section.circle, -0.6)


def test_cracked_concrete() -> None:
    whole = Section.rectangle(0.4, 0.6, elastic_modulus=30e9, poisson_ratio=0.2, density=2500.0)
    half = whole.cracked(0.5)
    for name in ("inertia_y", "inertia_z", "torsion_constant", "shear_area_y", "shear_area_z"):
        assert getattr(half, name) == 0.5 * getattr(whole, name)
    assert (half.area, half.density) == (whole.area, whole.density)
    column = whole.cracked(0.7, torsion=0.1, shear=1.0)
    assert column.torsion_constant == 0.1 * whole.torsion_constant
    assert column.shear_area_y == whole.shear_area_y
    for wrong in (0.0, 1.2, math.nan):
        refused(ModelError, r"bending = .* must lie in \(0, 1\]", whole.cracked, wrong)
