"""A public model of OpenSees on bearings in both programs; skipped where it is not installed."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from validation.measurements import opensees_public_models as public

pytestmark = pytest.mark.skipif(bool(public.missing()), reason=public.missing())


def test_a_public_model_moves_alike_in_both_programs():
    one = public.compare(replace(public.MODELS[1], steps=(0.005,)), duration=2.0)
    assert_allclose(one.fixed, one.standing.periods, rtol=1e-9)
    assert_allclose(one.sticking[1], one.sticking[0], rtol=5e-3)  # "sticking" is a closed form
    there, here = one.there[0], one.here[0]
    assert_allclose(here.axial, there.axial, rtol=1e-6)
    assert float(np.abs(there.moves).max()) > 0.03
    base, top = here.against(there)
    assert base < 0.005
    assert top < 0.02
    assert one.ledger < 1e-3
