"""A disc on an elastic bed: closed forms against integrals, friction with spin, derivatives."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from lir_element.kernels.contact.disc import disc_load, disc_load_slope, rub, rubbing, segment
from lir_element.kernels.contact.disc_pair import torsion_radius
from lir_element.kernels.slip import friction_map, kept_share
from lir_element.layout import SCRATCH, TOUCH

RADIUS = 0.08


def scratch() -> Any:
    return np.zeros(1, dtype=SCRATCH)[0]


def bed(p: float, g: tuple[float, float], a: float = RADIUS) -> np.ndarray:
    """Return load and place of a disc with their derivatives, (3, 4); zero where it is open."""
    w = scratch()
    table = np.zeros((3, 4))
    table[:, 0] = disc_load(p, g[0], g[1], a)
    if table[0, 0] > 0.0:
        disc_load_slope(w, p, g[0], g[1], a)
        table[:, 1:] = w.bed
    return table


def size_of(z: np.ndarray) -> float:
    """Return the norm of a hysteretic variable."""
    return math.sqrt(rubbing(z[0], z[1], z[2])[0])


def rubbed(
    law: int,
    exponent: float,
    old: np.ndarray,
    d: np.ndarray,
    u_y: float,
    kept: tuple[float, float] = (1.0, 0.0),
    before: np.ndarray | None = None,
    share: float = 0.0,
) -> tuple[np.ndarray, np.ndarray, float, Any]:
    """Return friction with its derivatives (3, 5), the new z, the sliding past the old, scratch."""
    w, z, table = scratch(), np.zeros(3), np.zeros((3, 5))
    last = np.zeros(2) if before is None else before
    *friction, slid, size = rub(
        w, law, exponent, old, size_of(old), *d, u_y, *kept, last, share, z, True
    )
    table[:, 0], table[:, 1:] = friction, w.rub
    assert_allclose(size, size_of(z), rtol=1e-14)
    without = np.zeros(3)  # without derivatives: the same
    again = rub(w, law, exponent, old, size_of(old), *d, u_y, *kept, last, share, without, False)
    assert again == (*friction, slid, size)
    assert (without == z).all()
    return table, z, slid, w


@pytest.mark.parametrize("u", [-0.99, -0.5, 0.0, 0.3, 0.999])
def test_segment_is_the_integral_over_the_disc(u: float) -> None:
    """Load and moment of ``max(u + x, 0)``, over the area."""

    def mean(weight: Any) -> float:
        def part(x: float) -> float:
            return weight(x) * 2.0 * math.sqrt(max(1.0 - x * x, 0.0)) / math.pi

        return quad(part, -u, 1.0, epsabs=1e-13)[0]

    found = segment(u)
    expected = (
        mean(lambda x: u + x),
        mean(lambda x: (u + x) * x),
        mean(lambda x: 1.0),
        mean(lambda x: x),
    )
    assert_allclose(found, expected, rtol=1e-7, atol=1e-12)


def test_full_contact_up_to_the_kern_and_an_edge_beyond() -> None:
    """The load's place is ``a^2 g / (4 p)`` up to a / 4, and goes on to the edge without a jump."""
    p, a = 1e-4, RADIUS
    for share in (0.2, 0.999999):
        found = bed(p, (share * p / a, 0.0))
        assert_allclose(found[0, 0], p, rtol=1e-15)
        assert_allclose(found[1, 0], 0.25 * a * share, rtol=1e-12)
    beyond = bed(p, (1.000001 * p / a, 0.0))
    assert_allclose(beyond[1, 0], 0.25 * a, rtol=1e-5)
    tipping = bed(-0.99 * p, (p / a, 0.0))
    assert 0.97 * a < tipping[1, 0] < a
    assert bed(-1.01 * p, (p / a, 0.0))[0, 0] == 0.0


@pytest.mark.parametrize("tilt", [0.0, 0.4, 2.0, 30.0, -3.0])
def test_derivatives_of_the_bed(tilt: float) -> None:
    """Of load and place by penetration and slope; a negative tilt stands for p below zero."""
    p = 1e-4 * (-0.4 if tilt < 0.0 else 1.0)
    g = abs(tilt) * 1e-4 / RADIUS * np.array([math.cos(0.7), math.sin(0.7)])
    table = bed(p, tuple(g))
    at = np.array([p, *g])
    for k, h in enumerate((1e-9, 1e-7, 1e-7)):
        move = np.eye(3)[k] * h
        up, down = at + move, at - move
        slope = (bed(up[0], tuple(up[1:]))[:, 0] - bed(down[0], tuple(down[1:]))[:, 0]) / (2 * h)
        assert_allclose(table[:, 1 + k], slope, rtol=2e-6, atol=1e-9)


def test_load_and_moment_have_a_potential() -> None:
    """The moment by p is the load by g: an elastic bed gives back what it took."""
    for p, tilt in ((1e-4, 0.5), (1e-4, 2.0), (-2e-5, 3.0)):
        t = bed(p, (tilt * 1e-4 / RADIUS, 2e-4))
        by_p = t[0, 1] * t[1:, 0] + t[0, 0] * t[1:, 1]  # of V e
        assert_allclose(by_p, t[0, 2:], rtol=1e-10, atol=1e-12 * abs(t[0, 1]))


def mean_speed(v: float, w: float) -> float:
    """Return the mean over a unit disc of the speed of sliding v with spin w, by quadrature."""
    r, weight = np.polynomial.legendre.leggauss(60)
    r, weight = 0.5 * (r + 1.0), 0.5 * weight
    angle = (np.arange(240) + 0.5) * 2.0 * math.pi / 240
    x, y = r[:, None] * np.cos(angle), r[:, None] * np.sin(angle)
    return float((np.hypot(v - w * y, w * x).mean(axis=1) * 2.0 * r * weight).sum())


@pytest.mark.parametrize("w", [0.05, 0.3, 0.8, 1.0, 1.25, 2.0, 8.0])
def test_norm_is_the_mean_speed_of_the_disc(w: float) -> None:
    """Within 0.4 %, force and torque within 3 %, exact in the limits of slow and of fast spin."""
    square, by_v, by_t, *_ = rubbing(1.0, 0.0, w)
    size, h = math.sqrt(square), 1e-4
    assert_allclose(size, mean_speed(1.0, w), rtol=0.004)
    force = (mean_speed(1.0 + h, w) - mean_speed(1.0 - h, w)) / (2.0 * h)
    torque = (mean_speed(1.0, w + h) - mean_speed(1.0, w - h)) / (2.0 * h)
    assert_allclose((by_v / size, by_t * w / size), (force, torque), rtol=0.03)
    slow, fast = 1e-3, 1e3
    assert_allclose(math.sqrt(rubbing(1.0, 0.0, slow)[0]) - 1.0, slow**2 / 8.0, rtol=1e-5)
    more = math.sqrt(rubbing(1.0, 0.0, fast)[0]) - 2.0 / 3.0 * fast
    assert_allclose(more, 0.5 / fast, rtol=1e-4)


def test_norm_is_convex() -> None:
    """Its square has a positive definite second derivative: one friction for every sliding."""
    for angle in np.linspace(0.0, math.pi / 2.0, 91):
        d = 1e-4 * np.array([math.cos(angle), 0.0, math.sin(angle)])
        *_, w = rubbed(0, 2.0, np.zeros(3), d, 1.0)
        assert np.linalg.eigvalsh(np.array(w.rub_h)).min() > 0.2


LAWS = [(0, 2.0), (1, 2.0), (1, 3.5)]


@pytest.mark.parametrize(("law", "exponent"), LAWS)
@pytest.mark.parametrize("size", [0.3, 1.0, 20.0])
def test_without_spin_it_is_the_law_of_a_point(law: int, exponent: float, size: float) -> None:
    """Friction, derivatives and sliding as `friction_map` has them."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        u_y, share = 2.5e-4, float(rng.uniform(0.0, 0.6))
        z_old = rng.uniform(-0.7, 0.7, 2)
        d = size * u_y * rng.normal(size=2)
        before = d + 0.3 * size * u_y * rng.normal(size=2)
        kept, by_push = kept_share(1.0e6, float(rng.uniform(0.7, 1.4)) * 1e6, 0.0)
        old, way = np.array([*z_old, 0.0]), np.array([*d, 0.0])
        table, z, slid, w = rubbed(law, exponent, old, way, u_y, (kept, by_push), before, share)
        plain = friction_map(
            law, exponent, *z_old, *d, u_y, kept, by_push, before[0], before[1], share
        )
        assert_allclose(z[:2], plain[:2], rtol=1e-12, atol=1e-14)
        assert_allclose(table[:2, 0], plain[:2], rtol=1e-12, atol=1e-14)
        assert_allclose(table[:2, 1:3].ravel(), plain[2:6], rtol=1e-9, atol=1e-9 / u_y)
        assert_allclose(slid, plain[6], rtol=1e-12, atol=1e-18)
        assert_allclose(w.slid_by[:2], plain[7:9], rtol=1e-12, atol=1e-14)
        assert_allclose(table[:2, 4], plain[9:11], rtol=1e-8, atol=1e-14)


@pytest.mark.parametrize(("law", "exponent"), LAWS)
@pytest.mark.parametrize("size", [0.3, 5.0])
def test_derivatives_of_friction_with_spin(law: int, exponent: float, size: float) -> None:
    """By the sliding, by the spin and by the axial force, against differences."""
    rng = np.random.default_rng(7)
    for _ in range(20):
        u_y, n = 2.5e-4, 1.2e6
        old = 0.5 * rng.uniform(-1.0, 1.0, 3)
        d = size * u_y * rng.normal(size=3)
        before = d[:2] + 0.2 * size * u_y * rng.normal(size=2)

        def friction(
            x: np.ndarray, push: float, old: Any = old, before: Any = before, u_y: float = u_y
        ) -> np.ndarray:
            kept = kept_share(1e6, push, 0.0)
            table, _, slid, w = rubbed(law, exponent, old, x, u_y, kept, before, 0.4)
            return np.concatenate([table.ravel(), [slid], np.array(w.slid_by)])

        at = friction(d, n)
        table, slid_by = at[:15].reshape(3, 5), at[16:]
        for k in range(3):
            h = np.eye(3)[k] * 1e-6 * u_y
            change = (friction(d + h, n) - friction(d - h, n)) / (2e-6 * u_y)
            slope = change[:15].reshape(3, 5)[:, 0]
            assert_allclose(table[:, 1 + k], slope, rtol=1e-6, atol=2e-6 / u_y)
            assert_allclose(slid_by[k], change[15], rtol=1e-6, atol=1e-6)
        change = (friction(d, n + 10.0) - friction(d, n - 10.0)) / 20.0
        assert_allclose(table[:, 4], change[:15].reshape(3, 5)[:, 0], rtol=1e-5, atol=1e-13)


def test_friction_with_spin_never_exceeds_the_disc() -> None:
    """On a path with spin the friction stays on its limit, and takes energy in every step."""
    rng = np.random.default_rng(11)
    z, u_y = np.zeros(3), 1e-4
    for _ in range(400):
        d = 3.0 * u_y * rng.normal(size=3)
        table, new, *_ = rubbed(0, 2.0, z, d, u_y)
        assert size_of(new) <= 1.0 + 1e-12
        force = table[:, 0]
        gain = 0.5 * u_y * (size_of(new) ** 2 - size_of(z) ** 2)
        assert force @ d >= gain - 1e-12 * u_y
        z = new


def test_eccentric_pressure_twists_less() -> None:
    """The radius that resists spin falls like the mean lever of the pressure about its centre."""
    cells = (np.arange(400) + 0.5) / 200.0 - 1.0
    x, y = np.meshgrid(cells, cells, indexing="ij")
    touch = np.zeros(1, dtype=TOUCH)[0]
    assert torsion_radius(touch, RADIUS) == RADIUS
    for closed in (20.0, 4.0, 1.0, 0.5, 0.0, -0.4, -0.8):  # from full contact to an edge
        pressure = np.maximum(closed + x, 0.0) * (x * x + y * y < 1.0)
        touch.centre[0] = RADIUS * (share := float((pressure * x).sum() / pressure.sum()))
        lever = 1.5 * RADIUS * (pressure * np.hypot(x - share, y)).sum() / pressure.sum()
        assert_allclose(torsion_radius(touch, RADIUS), lever, rtol=0.035, err_msg=f"{share:.2f}")
