# SPDX-License-Identifier: MIT
"""Datasets, arrays and numbers that NumPy would bend until they fit."""

import pathlib
import warnings

import numpy as np
import pytest

import beamgyro as bg
from program import SCENARIOS

WARM_UP = SCENARIOS / "warm_up.toml"
NOMINAL = SCENARIOS / "devices/nominal.toml"
SMALL = SCENARIOS / "campaigns/small.toml"


@pytest.fixture(scope="module", name="run")
def make_run():
    return bg.run(WARM_UP, set={"duration_s": 20})


def as_is(signals):
    return signals.rate


USES = [
    ("save", lambda run, folder: run.beamgyro.save(folder / "a.h5")),
    ("compensate", lambda run, folder: bg.compensate(as_is, run)),
    ("validate", lambda run, folder: bg.validate(as_is, run)),
    ("features", lambda run, folder: bg.features(run)),
    ("rows", lambda run, folder: bg.training_rows(run)),
    ("train", lambda run, folder: bg.train(
        SCENARIOS / "models/cubic.toml", run)),
]


def with_values(run, name, values):
    return run.assign({name: ("time", values, run[name].attrs)})


BAD = {
    "status 300": (lambda run: with_values(
        run, "status", np.full(200, 300)), "status: sample 0 is 300"),
    "status -1": (lambda run: with_values(
        run, "status", np.full(200, -1)), "status: sample 0 is -1"),
    "status 0.5": (lambda run: with_values(
        run, "status", np.r_[np.zeros(9), np.full(191, 0.5)]),
        "status: sample 9 is 0.5"),
    "status nan": (lambda run: with_values(
        run, "status", np.full(200, np.nan)), "status: sample 0 is nan"),
    "status bool": (lambda run: with_values(
        run, "status", np.zeros(200, bool)), "status: .*true and false"),
    "complex": (lambda run: with_values(run, "rate", run.rate.values * 1j),
                "rate: .*complex"),
    "complex extra": (lambda run: run.assign(own=run.rate * 1j),
                      "own: .*complex"),
    "bool": (lambda run: with_values(run, "rate", run.rate.values > 0),
             "rate: .*true and false"),
    "texts": (lambda run: with_values(
        run, "rate", run.rate.values.astype(str)), "rate: .*texts"),
    "objects": (lambda run: with_values(
        run, "rate", run.rate.values.astype(object)), "rate: .*object"),
    "dates": (lambda run: with_values(
        run, "rate", np.full(200, "2020-01-01", "datetime64[ns]")),
        "rate: .*datetime64"),
    "large integer": (lambda run: with_values(
        run, "rate", np.full(200, 2 ** 60 + 1)), "rate: sample 0"),
    "kelvin": (lambda run: run.assign(temperature=(
        run.temperature + 273.15).assign_attrs(units="K")),
        'temperature: units "K"; expected "degC"'),
    "radians": (lambda run: run.assign(
        rate=run.rate.assign_attrs(units="rad/s")),
        'rate: units "rad/s"; expected "degree/s"'),
    "truth as measured": (lambda run: run.assign(
        true_rate=run.true_rate.assign_attrs(role="measured")),
        "true_rate: role 'measured'; expected 'truth'"),
    "milliseconds": (lambda run: run.assign_coords(
        time=("time", run.time.values * 1000, {"units": "ms"})),
        "time: units 'ms'; expected 's'"),
    "time back": (lambda run: run.assign_coords(
        time=np.r_[run.time.values[:100], run.time.values[:100]]),
        "time: sample 100 is 0 s, not after 9.9 s"),
    "times equal": (lambda run: run.assign_coords(time=np.zeros(200)),
                    "time: sample 1 is 0 s"),
    "time nan": (lambda run: run.assign_coords(
        time=np.r_[np.nan, run.time.values[1:]]), "time: sample 0 is nan"),
    "dates as times": (lambda run: run.assign_coords(
        time=np.datetime64("2020-01-01", "ns")
        + (run.time.values * 1e9).astype("timedelta64[ns]")),
        r"time: .*dates .*timedelta64\(1, 's'\)"),
    "no time": (lambda run: run.assign_coords(
        time=np.r_[[np.timedelta64("NaT", "ns")],
                   (run.time.values[1:] * 1e9).astype("timedelta64[ns]")]),
        "time: sample 0 is NaT"),
    "rate nan": (lambda run: with_values(run, "rate", np.full(200, np.nan)),
                 "rate: sample 0 is nan while powered"),
    "seed 1.7": (lambda run: run.assign_attrs(seed=1.7),
                 "seed 1.7: .*whole number"),
    "seed -1": (lambda run: run.assign_attrs(seed=-1), "seed -1"),
    "seed true": (lambda run: run.assign_attrs(seed=True), "seed True"),
    "seed text": (lambda run: run.assign_attrs(seed="x"), "seed 'x'"),
}


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("use", [use for _, use in USES],
                         ids=[name for name, _ in USES])
def test_what_is_no_recording_is_refused_by_every_call(run, bad, use,
                                                       tmp_path):
    make, words = BAD[bad]
    with pytest.raises(ValueError, match=words):
        use(make(run), tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("unit", ["ns", "us", "ms"])
def test_time_differences_are_converted_to_seconds_exactly(run, unit,
                                                           tmp_path):
    per_second = {"ns": 10 ** 9, "us": 10 ** 6, "ms": 1000}[unit]
    counts = np.round(run.time.values * per_second).astype(np.int64)
    times = counts.astype(f"timedelta64[{unit}]")
    run.assign_coords(time=times).beamgyro.save(tmp_path / "a.h5")
    again = bg.open_recording(tmp_path / "a.h5")
    np.testing.assert_array_equal(again.time.values, run.time.values)


def test_time_differences_of_years_keep_their_nanoseconds():
    from beamgyro import _arguments
    counts = np.array([0, 1, 10 ** 9, 2 ** 53 + 1, 10 ** 17 + 300_000_001])
    found = _arguments.seconds(counts.astype("timedelta64[ns]"), "time")
    for seconds, count in zip(found, counts.tolist()):
        # Division of Python's integers is rounded once.
        assert abs(seconds - count / 10 ** 9) <= np.spacing(count / 10 ** 9)
    weeks = np.array([0, 2], "timedelta64[W]")
    assert _arguments.seconds(weeks, "time").tolist() == [0, 1209600]
    with pytest.raises(ValueError, match="unit M"):
        _arguments.seconds(np.array([0, 2], "timedelta64[M]"), "time")


@pytest.mark.parametrize("same", [
    lambda run: run.astype(">f8"),
    lambda run: run.assign(status=run.status.astype(float)),
    lambda run: run.assign(status=run.status.astype(np.int64)),
    lambda run: run.isel(time=np.repeat(np.arange(200), 2)).isel(
        time=slice(None, None, 2)),
    lambda run: run.astype("longdouble").assign_coords(
        time=run.time.astype("longdouble")),
])
def test_the_layout_of_arrays_makes_no_difference(run, same, tmp_path):
    run.beamgyro.save(tmp_path / "a.h5")
    other = same(run)
    other.encoding = run.encoding  # which astype() drops
    other.beamgyro.save(tmp_path / "b.h5")
    assert ((tmp_path / "a.h5").read_bytes()
            == (tmp_path / "b.h5").read_bytes())


NAN, INF = float("nan"), float("inf")


@pytest.mark.parametrize("call, words", [
    (lambda run: bg.training_rows(run, every_s=-1), "every_s -1"),
    (lambda run: bg.training_rows(run, every_s=NAN), "every_s nan"),
    (lambda run: bg.training_rows(run, every_s=INF), "every_s inf"),
    (lambda run: bg.training_rows(run, every_s=True), "every_s True"),
    (lambda run: bg.training_rows(run, []), "inputs: is empty"),
    (lambda run: bg.training_rows([]), "no recordings"),
    (lambda run: bg.features(run, []), "inputs: is empty"),
    (lambda run: bg.validate(as_is, run, full_scale=-1), "full_scale -1"),
    (lambda run: bg.validate(as_is, run, full_scale=0), "full_scale 0"),
    (lambda run: bg.validate(as_is, run, full_scale=NAN), "full_scale nan"),
    (lambda run: bg.validate(as_is, run, full_scale=INF), "full_scale inf"),
    (lambda run: bg.validate(as_is, run, full_scale=True), "full_scale True"),
    (lambda run: bg.validate(as_is, run, jobs=10 ** 6), "jobs 1000000"),
    (lambda run: bg.validate(as_is, run, progress="yes"), "progress 'yes'"),
    (lambda run: bg.Campaign(SMALL).device(20), "no device 20.* 0 to 19"),
    (lambda run: bg.Campaign(SMALL).device(-1), "device -1"),
    (lambda run: bg.Campaign(SMALL).device(1.0), "device 1.0"),
    (lambda run: bg.Campaign(SMALL).device(True), "device True"),
    (lambda run: bg.Campaign(SMALL, 0), "devices 0"),
    (lambda run: bg.Campaign(SMALL, 2.5), "devices 2.5"),
    (lambda run: bg.characterise(NOMINAL, []), "beam_temperature: is empty"),
    (lambda run: bg.characterise(NOMINAL, ["25"]), "beam_temperature: .*text"),
    (lambda run: bg.characterise(NOMINAL, [True]), "beam_temperature: .*true"),
    (lambda run: bg.characterise(NOMINAL, [NAN]), "nan degC"),
    (lambda run: bg.characterise(NOMINAL, slice(0, 60, NAN)), "nan"),
    (lambda run: bg.characterise(NOMINAL, slice(-40, 60, 1e-9)),
     "1e-09 K makes 1e.11 temperatures .*at most 1000000"),
    (lambda run: bg.characterise(NOMINAL, slice(0, 60, -1)),
     "-1 K does not lead from 0 to 60 degC"),
    (lambda run: bg.characterise(NOMINAL, slice(0, 60, 0)), "does not lead"),
    (lambda run: bg.characterise(NOMINAL, slice(0, 60)), "START, STOP"),
    (lambda run: bg.run(WARM_UP, set={"name": b"abc"}), "name: .*bytes"),
    (lambda run: bg.run(WARM_UP, set={"name": bytearray(b"abc")}),
     "name: .*bytearray"),
    (lambda run: bg.run(WARM_UP, set={"power.on_s": [b"0"]}), "bytes"),
    (lambda run: bg.run(WARM_UP, set={"duration_s": memoryview(b"0")}),
     "memoryview"),
    (lambda run: bg.run(WARM_UP, set={"device": pathlib.PurePosixPath("x")}),
     "device"),
    (lambda run: bg.run(WARM_UP, progress="yes"), "progress 'yes'"),
    (lambda run: bg.run(WARM_UP, progress=1), "progress 1"),
    (lambda run: bg.train(SCENARIOS / "models/cubic.toml", run, seed=-1),
     "seed -1"),
    (lambda run: bg.train(SCENARIOS / "models/cubic.toml", run, seed=True),
     "seed True"),
    (lambda run: bg.sensitivity(SMALL, samples=2 ** 31),
     "2147483648 samples; expected 32 to 1000000"),
    (lambda run: bg.sensitivity(SMALL, range_degC=(NAN, 3)),
     "range_degC nan"),
])
def test_what_no_number_can_mean_is_refused(run, call, words):
    with pytest.raises(ValueError, match=words):
        call(run)


def test_runs_without_a_powered_sample_make_no_rows():
    off = bg.run(WARM_UP, set={"duration_s": 20, "power.on_s": [15.0]})
    with pytest.raises(ValueError, match="run 1: no sample is powered, locked"):
        bg.training_rows(off.isel(time=slice(0, 100)))
    rows, _ = bg.training_rows(off)
    assert len(rows) == int((off.status == 0).sum()) <= 50


@pytest.mark.parametrize("options, words", [
    ({"ramp_K_per_min": -1.0}, "-1; expected a number in"),
    ({"correlation_K": -1.0}, "-1; expected a number > 0"),
    ({"temperature_degC": -300.0}, "-300; expected a number in"),
])
def test_options_of_an_export_have_the_ranges_of_the_command(
        run, options, words, tmp_path):
    trained = bg.train(SCENARIOS / "models/cubic.toml", bg.run(
        SCENARIOS / "soak_sweep_train.toml", set={"output_rate_Hz": 0.1}))
    run.beamgyro.save(tmp_path / "rest.h5")
    with pytest.raises(ValueError, match=words):
        bg.export(trained, "ekf", rest=tmp_path / "rest.h5", **options)


def test_numbers_of_numpy_are_numbers(run):
    rows, _ = bg.training_rows(run, every_s=np.float32(1))
    assert rows.shape == (20, 1)
    assert bg.Campaign(SMALL).device(np.int64(3)) == bg.Campaign(
        SMALL).device(3)
    table = bg.characterise(NOMINAL, iter([25.0]))
    assert table.temperature.values.tolist() == [25.0]
    table = bg.characterise(NOMINAL, np.float32(25))
    assert table.temperature.values.tolist() == [25.0]


def test_a_recording_is_judged_once(run, tmp_path):
    run.beamgyro.save(tmp_path / "a.h5")
    (tmp_path / "b.h5").write_bytes((tmp_path / "a.h5").read_bytes())
    for runs in ([run, run], {"a": run, "b": run},
                 [tmp_path / "a.h5", tmp_path / "b.h5"],
                 [tmp_path / "a.h5", tmp_path / "a.h5"]):
        with pytest.raises(ValueError, match="is the same recording as"):
            bg.validate(as_is, runs)


def test_recordings_that_are_judged_have_names_of_their_own(run):
    other = bg.run(WARM_UP, set={"duration_s": 20}, seed=9)
    with pytest.raises(ValueError, match="a.h5: is the name of two"):
        bg.validate(as_is, {"a": run, "a.h5": other})
    both = bg.validate(as_is, {"a": run, "b": other})
    alone = bg.validate(as_is, {"b": other})
    name = "residual_rms_deg_per_s"
    assert (both.metrics[name]["after"]["value"]
            != alone.metrics[name]["after"]["value"])


def test_units_that_arithmetic_lost_are_warned_of(run):
    lost = run.assign(rate=run.rate * np.pi / 180)
    with pytest.warns(bg.BeamgyroWarning, match="rate: states no units"):
        bg.features(lost, ["temperature"])
    late = run.assign_coords(time=run.time * 1000)
    with pytest.warns(bg.BeamgyroWarning, match="time: states no units"):
        bg.features(late, ["temperature"])
    without = run.copy()
    for variable in without.variables.values():
        variable.attrs.pop("units", None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bg.features(without, ["temperature"])
        spelt = run.copy()
        spelt.rate.attrs["units"] = "deg/s"
        bg.features(spelt, ["temperature"])


def test_a_coordinate_without_a_dimension_is_left_out(run):
    numbered = run.assign_coords(device=3)
    assert np.array_equal(bg.features(numbered, ["temperature"]),
                          bg.features(run, ["temperature"]))


def test_a_run_in_memory_keeps_its_device_whatever_its_name(run):
    found = [bg.validate(as_is, {name: run}).warnings
             for name in ("a", "a.csv")]
    assert not any("no device is stated" in text
                   for texts in found for text in texts)
    bare = run.copy()
    bare.encoding = {}
    with pytest.warns(bg.BeamgyroWarning, match="no device is stated"):
        bg.validate(as_is, bare)
