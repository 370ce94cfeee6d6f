"""What follows a bearing's failure: the study's devices."""

import pytest

from frames.risk.campaign.comparison import dish_diameter
from validation.study.after import DEVICES, DROPS, KINDS, Kind, devices
from validation.study.device_runs import REFERENCE, plan_of


def test_devices_are_alike_but_for_what_follows():
    every = devices()
    assert set(every) == {kind.name for kind in KINDS}
    for device in DEVICES:
        alone = every[Kind(device, None).name].bearings
        largest = max(dish_diameter(link.bearing) for link in alone.values())
        assert largest == pytest.approx(plan_of(REFERENCE))
        for drop in DROPS[1:]:
            for name, link in every[Kind(device, drop).name].bearings.items():
                own = link.bearing
                assert own.backup.drop == drop
                assert alone[name].bearing.backup is None
                assert own.resolved() == alone[name].bearing.resolved()
                assert own.rim_yield_force == alone[name].bearing.rim_yield_force
