# SPDX-License-Identifier: MIT
"""A dataset that was changed says so where it is saved; others keep their
bytes. Training takes no recording twice."""

import warnings

import h5py
import pytest
import xarray as xr

import beamgyro as bg
from program import PROGRAM, SCENARIOS, ended

CHANGED = "changed after simulation"
CUBIC = SCENARIOS / "models/cubic.toml"
SHORT = {"duration_s": 30}


def test_what_was_not_changed_keeps_its_bytes(tmp_path):
    bg.run_to_file(SCENARIOS / "warm_up.toml", tmp_path / "a.h5", set=SHORT)
    expected = (tmp_path / "a.h5").read_bytes()
    made = bg.run(SCENARIOS / "warm_up.toml", set=SHORT)
    for number, run in enumerate(
            [made, made.copy(deep=True), bg.open_recording(tmp_path / "a.h5")]):
        run.beamgyro.save(tmp_path / f"{number}.h5")
        assert (tmp_path / f"{number}.h5").read_bytes() == expected


def changed_rate(run):
    run["rate"] = run.rate.copy(data=run.true_rate.values + 0.001)
    return run


def changed_in_place(run):
    run.rate.values[3] += 1e-9
    return run


def changed_truth(run):
    return run.assign(true_bias=run.true_bias + 1e-9)


def part_of(run):
    return run.isel(time=slice(0, 100))


def with_a_variable(run):
    return run.assign(strain=run.rate * 2)


@pytest.mark.parametrize("change", [
    changed_rate, changed_in_place, changed_truth, part_of, with_a_variable])
def test_what_was_changed_says_so_once(change, tmp_path):
    run = change(bg.run(SCENARIOS / "warm_up.toml", set=SHORT))
    run.beamgyro.save(tmp_path / "a.h5")
    with h5py.File(tmp_path / "a.h5") as file:
        lines = file.attrs["history"].decode().splitlines()
    assert lines[0].endswith(": run")
    assert lines[1:] == [CHANGED]
    assert f"\n{CHANGED}\n" in ended(PROGRAM, "info", tmp_path / "a.h5").stdout
    again = bg.open_recording(tmp_path / "a.h5")
    again.beamgyro.save(tmp_path / "b.h5")
    assert ((tmp_path / "a.h5").read_bytes()
            == (tmp_path / "b.h5").read_bytes())
    changed_rate(again).beamgyro.save(tmp_path / "c.h5")
    assert bg.open_recording(tmp_path / "c.h5").history.splitlines() == lines


def test_the_answer_of_a_compensator_keeps_the_line():
    run = changed_rate(bg.run(SCENARIOS / "warm_up.toml", set=SHORT))
    answered = bg.compensate(lambda signals: signals.rate.values, run)
    assert answered.history.splitlines()[1] == CHANGED


def test_fewer_variables_are_no_change(tmp_path):
    run = bg.run(SCENARIOS / "warm_up.toml", set=SHORT)
    run.drop_vars("true_bias").beamgyro.save(tmp_path / "a.h5")
    assert bg.open_recording(tmp_path / "a.h5").history == run.history


def test_a_dataset_made_anew_is_not_known_to_be_a_simulation(tmp_path):
    run = bg.run(SCENARIOS / "warm_up.toml", set=SHORT)
    bg.save_recording(xr.Dataset(run.variables, attrs=run.attrs),
                      tmp_path / "a.h5")
    assert bg.open_recording(tmp_path / "a.h5").history.splitlines()[1:] == [
        f"not known to be un{CHANGED}"]


def test_training_takes_each_recording_once(sweeps, tmp_path):
    first, second, _ = sweeps
    first.beamgyro.save(tmp_path / "a.h5")
    for again in (first, first.copy(deep=True), first.drop_vars("true_bias"),
                  tmp_path / "a.h5"):
        with pytest.raises(ValueError, match="same recording as run 1"):
            bg.train(CUBIC, [first, second, again], cross_validation="run")
        with pytest.raises(ValueError, match="must be another run"):
            bg.train(CUBIC, first, [second, again])
    half = first.isel(time=slice(3000, 9000))
    for runs in ([first, half], [half, first]):
        with pytest.raises(ValueError, match="samples are those of run"):
            bg.train(CUBIC, runs)
    with pytest.raises(ValueError, match="samples are those of run 1"):
        bg.train(CUBIC, first, half)


def test_a_shared_seed_is_warned_of(sweep_keys, sweeps):
    held = bg.run(sweep_keys, set={"ambient.points": [[0, 40], [12000, -30]]})
    with pytest.warns(bg.BeamgyroWarning, match="share the seed of noise 3"):
        bg.train(CUBIC, sweeps[0], held)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "(?!.*seed of noise)")
        bg.train(CUBIC, sweeps[:2], sweeps[2])
