# SPDX-License-Identifier: MIT
"""Allan deviations of arrays, datasets and files, and what is refused."""

import numpy as np
import pytest

import beamgyro as bg
from program import PROGRAM, SCENARIOS, ended, said


@pytest.fixture(scope="module", name="rest")
def make_rest():
    """Two minutes at rest, ten samples a second."""
    return bg.run(SCENARIOS / "warm_up.toml", set={"duration_s": 120})


SAMPLES = np.random.default_rng(1).normal(size=4096)


@pytest.mark.parametrize("samples, words", [
    (SAMPLES.reshape(2, 2048), r"data: .*\(2, 2048\).*one dimension"),
    (SAMPLES.reshape(4096, 1), r"data: .*\(4096, 1\)"),
    (np.float64(3.0), "data: .*one dimension"),
    (SAMPLES + 1j, "data: .*complex"),
    (SAMPLES > 0, "data: .*true and false"),
    (SAMPLES.astype(str), "data: .*texts"),
    (SAMPLES.astype(object), "data: .*object"),
    (np.ma.masked_greater(SAMPLES, 2), "data: .*masked"),
    (SAMPLES.astype("timedelta64[s]"), "data: .*timedelta64"),
    ([2 ** 60 + 1, 1, 2, 3], "data: sample 0 .*1152921504606846977"),
])
def test_what_is_no_series_of_numbers_is_refused(samples, words):
    with pytest.raises(ValueError, match=words):
        bg.allan(samples, rate_Hz=10)


@pytest.mark.parametrize("same", [
    lambda one: one.tolist(),
    lambda one: one.astype(">f8"),
    lambda one: np.repeat(one, 2)[::2],
    lambda one: one[::-1][::-1],
    lambda one: np.ma.array(one),
])
def test_the_layout_of_an_array_makes_no_difference(same):
    expected = bg.allan(SAMPLES, rate_Hz=10)
    assert bg.allan(same(SAMPLES), rate_Hz=10) == expected


@pytest.mark.parametrize("options, words", [
    ({"rate_Hz": 10}, "rate_Hz 10.0: .*dataset"),
    ({"unit": "deg/h"}, "unit 'deg/h': .*dataset"),
    ({"kinds": []}, "kinds: is empty"),
    ({"column": "absent"}, "absent"),
    ({"column": ""}, "no variable ''"),
])
def test_what_a_dataset_states_itself_is_refused(rest, options, words):
    with pytest.raises(ValueError, match=words):
        bg.allan(rest, **options)


@pytest.mark.parametrize("options, words", [
    ({"rate_Hz": 10, "column": "rate"}, "column 'rate': .*array"),
    ({"rate_Hz": 0}, "rate_Hz 0: .*above 0"),
    ({"rate_Hz": float("nan")}, "rate_Hz nan"),
    ({"rate_Hz": 5e-324}, "5e-324 samples a second"),
    ({"rate_Hz": True}, "rate_Hz True"),
])
def test_what_an_array_cannot_have_is_refused(options, words):
    with pytest.raises(ValueError, match=words):
        bg.allan(SAMPLES, **options)


def test_an_array_of_xarray_states_its_times_and_its_unit(rest):
    expected = bg.allan(rest.rate.values, rate_Hz=10)
    assert bg.allan(rest.rate, rate_Hz=10) == expected
    assert bg.allan(rest.rate, rate_Hz=10, unit="deg/s") == expected
    with pytest.raises(ValueError, match="rate_Hz 1: .* 0.1 to 0.1 s"):
        bg.allan(rest.rate, rate_Hz=1)
    series = rest.rate.to_series()
    assert bg.allan(series, rate_Hz=10) == expected
    with pytest.raises(ValueError, match="rate_Hz 1: .* 0.1 to 0.1 s"):
        bg.allan(series, rate_Hz=1)
    with pytest.raises(ValueError, match="rate_Hz 10: .* from -119.9 to 0.1 s"):
        bg.allan(rest.rate.roll(time=3, roll_coords=True), rate_Hz=10)
    with pytest.raises(ValueError, match="unit 'deg/h': .* 'deg/s'"):
        bg.allan(rest.rate, rate_Hz=10, unit="deg/h")
    warm = bg.allan(rest.temperature, rate_Hz=10)
    assert warm.data["series"]["unit"] == "degC"


def test_the_coefficients_are_those_of_the_table():
    # White noise of 1 deg/s in samples at 10 Hz: N = 1 / sqrt(10).
    result = bg.allan(SAMPLES, rate_Hz=10)
    walk = result.coefficients["N"]["per_second"]
    low, high = walk["interval"]
    assert low < 10 ** -0.5 < high
    assert walk["unit"] == "deg/sqrt(s)"
    shown = f"{result.coefficients['N']['per_hour']['value']:.4g}"
    assert f"angle random walk N {shown:>14} deg/sqrt(h)" in str(result)
    assert set(result.coefficients) <= set("QNBKR")
    assert bg.allan([1.0, 2.0, 3.0], rate_Hz=10).coefficients == {}


@pytest.mark.parametrize("kind", ["mdev", "warnings", "noise", "", None])
def test_a_curve_that_was_not_computed_is_refused(kind):
    with pytest.raises(ValueError, match=f"kind {kind!r}: was not computed"):
        bg.allan(SAMPLES, rate_Hz=10).to_dataset(kind)


def test_times_that_are_not_even_are_refused_as_by_the_command(
        rest, tmp_path):
    random = np.random.default_rng(2)
    scattered = rest.assign_coords(
        time=("time", np.sort(random.uniform(0, 120, rest.sizes["time"])),
              rest.time.attrs))
    with pytest.raises(ValueError, match="time: .*even"):
        bg.allan(scattered)
    scattered.beamgyro.save(tmp_path / "scattered.h5")
    answer = ended(PROGRAM, "allan", tmp_path / "scattered.h5", allowed=(2,))
    assert "even" in answer.stderr


def test_times_that_jump_back_are_refused(rest):
    times = rest.time.values.copy()
    times[600:] -= 30
    with pytest.raises(ValueError, match="time: sample 600 is 30 s"):
        bg.allan(rest.assign_coords(time=times))


def test_gaps_and_jitter_are_those_of_the_command(rest, tmp_path):
    random = np.random.default_rng(3)
    times = rest.time.values + random.uniform(0, 0.02, rest.sizes["time"])
    kept = rest.assign_coords(time=("time", times, rest.time.attrs)).isel(
        time=np.r_[0:300, 340:1200])
    kept.beamgyro.save(tmp_path / "gap.h5")
    assert str(bg.allan(kept)) == said(PROGRAM, "allan", tmp_path / "gap.h5")
