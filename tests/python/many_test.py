# SPDX-License-Identifier: MIT
"""Many variants of a run in one dataset."""

import numpy as np
import pytest

import beamgyro as bg

from program import SCENARIOS

WARM_UP = SCENARIOS / "warm_up.toml"
SHORT = {"duration_s": 2}
LENGTHS = [0.0399, 0.04, 0.0401]


@pytest.mark.parametrize("jobs", [1, 4])
def test_each_variant_is_its_run(jobs):
    shares = []
    found = bg.run_many(WARM_UP, {
        "beam.length_m": LENGTHS, "ambient.constant_degC": [10.0, 30.0]},
        seeds=[4, 9], set=SHORT, jobs=jobs, progress=shares.append)
    assert found.rate.dims == ("beam.length_m", "ambient.constant_degC",
                               "seed", "time")
    assert shares[0] == 0 and shares[-1] == 1
    for length in LENGTHS:
        for seed in (4, 9):
            own = bg.run(WARM_UP, seed=seed, set={
                **SHORT, "beam.length_m": length,
                "ambient.constant_degC": 30.0})
            place = found.sel({"beam.length_m": length, "seed": seed,
                               "ambient.constant_degC": 30.0})
            for name in own.data_vars:
                np.testing.assert_array_equal(place[name], own[name])
                np.testing.assert_equal(place[name].attrs, own[name].attrs)
            np.testing.assert_array_equal(place.time, own.time)


@pytest.mark.parametrize("jobs", [1, 2])
def test_keys_of_scenario_and_device_may_come_in_any_order(jobs):
    keys = {"noise.enabled": [True, False],
            "noise.angle_random_walk_deg_per_sqrt_s": [0.01, 0.5],
            "ambient": [{"constant_degC": 5.0}, {"constant_degC": 45.0}]}
    for order in (keys, dict(reversed(keys.items()))):
        found = bg.run_many(WARM_UP, order, seeds=[1, 2], set=SHORT, jobs=jobs)
        for places in np.ndindex(2, 2, 2, 2):
            values = {name: values[place] for (name, values), place in zip(
                order.items(), places)}
            own = bg.run(WARM_UP, seed=places[-1] + 1,
                         set={**SHORT, **values})
            np.testing.assert_array_equal(found.rate.values[places], own.rate)


def test_runs_with_other_variables_are_refused():
    still_and_shaken = [{}, {"x": {"constant_g": 0.1}}]
    with pytest.raises(ValueError, match="has other variables"):
        bg.run_many(WARM_UP, {"acceleration": still_and_shaken}, set=SHORT)


def test_variables_can_be_chosen_and_seeds_are_enough():
    found = bg.run_many(WARM_UP, seeds=range(3), variables=["rate"], set=SHORT)
    assert list(found.data_vars) == ["rate"]
    assert found.rate.dims == ("seed", "time")
    assert len(np.unique(found.rate.values[:, -1])) == 3
    alone = bg.run_many(WARM_UP, set=SHORT)
    assert alone.rate.dims == ("time",)


@pytest.mark.parametrize("keys, options, words", [
    ({"beam.length": [1]}, {}, "beam.length = 1: .*beam.length_m"),
    ({"beam.length_m": [0.04, -1]}, {}, "beam.length_m = -1: "),
    ({"beam.length_m": 0.04}, {}, "keys: beam.length_m"),
    ({"beam.length_m": []}, {}, "beam.length_m: is empty"),
    ({"duration_s": [2, 3]}, {}, "duration_s = 3: has other times"),
    ([1], {}, "keys"),
    ({}, {"variables": ["heat"]}, "variables: 'heat'"),
    ({}, {"seeds": [-1]}, "seed"),
])
def test_what_is_wrong_is_named_with_its_variant(keys, options, words):
    with pytest.raises(ValueError, match=words):
        bg.run_many(WARM_UP, keys, **{"set": SHORT, **options})


def test_warnings_count_the_runs_that_they_are_of():
    with pytest.warns(bg.BeamgyroWarning, match=r"\(in 2 of 2 runs\)"):
        bg.run_many(WARM_UP, seeds=[1, 2], set={
            **SHORT, "drive.voltage_limit_V": 0.01, "fidelity": "envelope"})
