"""Figures of the hazard: what their lines hold."""

import numpy as np
import pytest
from matplotlib.axes import Axes

from frames import GroundMotion, MotionError
from frames.design import MotionSet, Spectrum, pair_spectrum
from frames.design.plots import design_spectra, motion_spectra
from lir_element.units import STANDARD_GRAVITY as G
from tests.refusals import refused

TARGET = Spectrum.asce7(1.0, 0.6)


def pulse(period: float) -> GroundMotion:
    time = np.arange(0.0, period, 0.01)
    wave = 3.0 * np.sin(2.0 * np.pi * time / period)
    return GroundMotion(x=wave, y=0.5 * wave[::-1], dt=0.01, name=f"{period:g} s")


PULSES = MotionSet([pulse(period) for period in (1.0, 1.5, 2.0)])


def drawn(panel: Axes) -> list[tuple[np.ndarray, np.ndarray]]:
    return [(np.array(line.get_xdata()), np.array(line.get_ydata())) for line in panel.lines]


def test_design_spectra_for_several_dampings() -> None:
    left, right = design_spectra(TARGET, (0.05, 0.20), longest=3.0).axes
    for (periods, levels), damping in zip(drawn(left), (0.05, 0.20), strict=True):
        np.testing.assert_allclose(levels * G, TARGET.acceleration(periods, damping))
        assert 0.6 in periods  # the corner
    periods, shifts = drawn(right)[1]
    np.testing.assert_allclose(shifts, TARGET.displacement(periods, 0.20))


def test_several_spectra_in_one_figure() -> None:
    site = Spectrum.given([0.2, 2.0], [5.0, 1.0], name="site")
    figure = design_spectra([TARGET, site], (0.05,))
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == [TARGET.name, "site", "5 %"]
    assert drawn(figure.axes[0])[1][0].min() == 0.2
    assert drawn(figure.axes[0])[1][0].max() == 2.0


def test_motions_their_mean_and_the_target() -> None:
    scaled = PULSES.scaled_to(
        TARGET, rule="ASCE 7-16", periods=(1.0, 2.0), limits=(0.01, 100.0), least=3
    )
    figure = motion_spectra(scaled, longest=4.0)
    accelerations, displacements, ratios = figure.axes
    *each, mean, target = drawn(accelerations)
    for (periods, levels), motion in zip(each, scaled.values(), strict=True):
        np.testing.assert_allclose(levels * G, pair_spectrum(motion, periods, measure="SRSS"))
    np.testing.assert_allclose(mean[1], np.mean([levels for _, levels in each], axis=0))
    np.testing.assert_allclose(target[1] * G, TARGET.acceleration(target[0]))
    shift = drawn(displacements)[-1]
    np.testing.assert_allclose(shift[1], TARGET.displacement(shift[0]))
    ratio = drawn(ratios)[0]
    np.testing.assert_allclose(ratio[1], mean[1] / target[1])
    inside = (ratio[0] >= 1.0) & (ratio[0] <= 2.0)
    assert ratio[1][inside].min() == pytest.approx(1.0, abs=0.02)
    assert "scaled by ASCE 7-16: SRSS" in figure.legends[0].get_title().get_text()


def test_a_set_that_is_not_scaled() -> None:
    assert len(motion_spectra(PULSES).axes) == 2
    site = Spectrum.given([0.2, 2.0], [5.0, 1.0], name="site")
    ratio = drawn(motion_spectra(PULSES, site).axes[2])[0]
    assert np.isnan(ratio[1][ratio[0] > 2.0]).all()
    assert np.isfinite(ratio[1][(ratio[0] > 0.2) & (ratio[0] < 2.0)]).all()


def test_what_makes_no_sense_is_refused() -> None:
    refused(MotionError, "0 spectra", design_spectra, [])
    refused(MotionError, "dampings", design_spectra, TARGET, ())
    refused(MotionError, "measure", motion_spectra, PULSES, measure="PGA")
    refused(TypeError, "a MotionSet", motion_spectra, TARGET)  # type: ignore[arg-type]
    refused(TypeError, "a Spectrum", design_spectra, [PULSES])  # type: ignore[list-item]
