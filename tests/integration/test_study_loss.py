"""The parts on loss and on uncertain properties by hand; devices of all parts of one plan."""

import warnings

import numpy as np
import pytest

from frames.design import Spectrum
from frames.risk import HazardCurve
from frames.risk.campaign.comparison import collapse_limit, dish_diameter
from frames.risk.campaign.file import campaign_file, comparison_in, loss_in, models_in
from frames.risk.campaign.loss import annual_losses
from lir_element import DesignWarning
from lir_element.units import STANDARD_GRAVITY
from validation.study.runner import HERE, files_of
from validation.study.uncertainty import changes

# Hazard, consequences, annual loss


L_AQUILA = (  # a_g [m/s2], F_0 [-] and T*_C [s] of the nine return periods of NTC 2008
    (0.78911, 2.3995, 0.27228),
    (1.0405, 2.3321, 0.28125),
    (1.2258, 2.318, 0.28932),
    (1.4242, 2.3043, 0.29671),
    (1.6403, 2.3015, 0.30931),
    (1.9075, 2.3152, 0.31802),
    (2.6099, 2.364, 0.34696),
    (3.3433, 2.4001, 0.36415),
    (4.5255, 2.4576, 0.38472),
)
CALIFORNIA = (  # return period [years], Sa(2.99 s) [g]
    (43.0, 144.0, 289.0, 475.0, 949.0, 1485.0, 2475.0, 3899.0, 7462.0, 10000.0),
    (0.04, 0.10, 0.17, 0.24, 0.35, 0.42, 0.50, 0.57, 0.69, 0.75),
)


def italian(a_g: float, f_0: float, t_star: float) -> float:
    """Return Sa(3 s) of NTC 2018 on ground C [m/s2]."""
    share = a_g / STANDARD_GRAVITY
    soil = float(np.clip(1.70 - 0.60 * f_0 * share, 1.0, 1.5))
    t_c, t_d = 1.05 * t_star**0.67, 4.0 * share + 1.6
    return a_g * soil * f_0 * t_c / 3.0 * min(1.0, t_d / 3.0)


def test_hazards_go_through_what_is_known():
    hazards = loss_in(HERE / "loss.toml").hazard
    considered = comparison_in(HERE / "loss.toml").considered
    design = float(Spectrum.nch2745("II", 2).acceleration(3.0))
    expected = {
        "Santiago": [(475, design), (1950, design * 0.72 / 0.55)],
        "Los Angeles": np.transpose(CALIFORNIA) * [1.0, STANDARD_GRAVITY * 1.054 / 3.0 / 0.50],
        "L'Aquila": [
            (years, italian(*row))
            for years, row in zip(
                (30, 50, 72, 101, 140, 201, 475, 975, 2475), L_AQUILA, strict=True
            )
        ],
    }
    assert {name.split(", ")[0] for name in hazards} == {*expected}
    for site, points in expected.items():
        years, im = np.array(points).T
        own, moved = (hazards[f"{site}, {kind}"] for kind in ("as it is", "moved"))
        np.testing.assert_allclose(own.rates(np.clip(im, *own.ends)), 1.0 / years, rtol=1e-3)
        np.testing.assert_allclose(moved.im / own.im, moved.im[0] / own.im[0], rtol=1e-4)
        assert own.rate[0] == moved.rate[0] == pytest.approx(1.0 / 30.0)
        assert moved.rates(considered) == pytest.approx(1.0 / 2475.0, rel=1e-3)
        slopes = np.diff(np.log(own.rate)) / np.diff(np.log(own.im))
        assert slopes[-1] == pytest.approx(slopes[-2], rel=1e-3)
        assert years[0] == 30 or slopes[0] == pytest.approx(slopes[1], rel=1e-3)


def test_components_are_those_of_the_file():
    given = loss_in(HERE / "loss.toml")
    by_name = {each.name: each for each in given.components}
    contents, walls = by_name["E.20.22.023"], by_name["C.10.11.001a"]
    assert float(contents.cost(0.4 * STANDARD_GRAVITY)) == pytest.approx(1000.0)
    # 4.65 units in the building: 2677.5 USD less (3.65 / 9) of the difference to 1428 USD
    area, storeys = 144.0, 3
    total = storeys * 0.1 * area / 0.3048**2 / 100.0
    first = 2677.5 + (total - 1.0) / 9.0 * (1428.0 - 2677.5)
    assert walls.costs[0] == pytest.approx(first, rel=1e-5)
    assert walls.quantity[0] * storeys == pytest.approx(total, rel=1e-4)
    assert given.replacement == pytest.approx(2690.97 * area * storeys, rel=1e-6)
    assert given.collapse == collapse_limit(None, 9.0)


def test_annual_loss_under_a_power_law():
    # loss = im / 4 up to 4, under rate = 1e-3 im**-2 from 0.5 to 50:
    # 1/4 * integral of im * 2e-3 im**-3 = 5e-4 (1/0.5 - 1/4), and 1 * rate(4)
    hazard = HazardCurve.power(1e-3, 2.0, 0.5, 50.0)
    found = annual_losses(np.array([0.25, 1.0]), np.array([1.0, 4.0]), hazard)
    assert float(found) == pytest.approx(5e-4 * (2.0 - 0.25) + 1e-3 / 16.0, rel=1e-4)


def test_a_plane_tells_properties_apart():
    """The second property goes with the first, and changes nothing; a run is unknown."""
    rng = np.random.default_rng(2)
    ranks = rng.random((80, 2))
    ranks[:, 1] = 0.5 * (ranks[:, 0] + ranks[:, 1])
    over = np.concatenate([0.4 * ranks[:, 0], 0.8 * ranks[:, 0] + 0.1])
    over[3] = np.nan
    found = changes(over, np.tile(ranks, (2, 1)), np.repeat(["a", "b"], 80))
    assert found[0] == pytest.approx([0.3, 0.2, 0.4])
    assert found[1] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("part", ["records", "after", "motions", "loss", "uncertainty"])
def test_parts_are_campaigns_of_devices_of_one_plan(part):
    for path in files_of(part).values():
        with warnings.catch_warnings(action="ignore", category=DesignWarning):  # soft rims
            frames = models_in(campaign_file(path))
        dishes = {
            max(dish_diameter(link.bearing) for link in each.bearings.values())
            for each in frames.values()
        }
        assert max(dishes) == pytest.approx(0.689)
        assert min(dishes) == pytest.approx(0.689)
