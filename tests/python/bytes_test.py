# SPDX-License-Identifier: MIT
"""Python and the command line give the same values, attributes and bytes."""

import shutil

import numpy as np
import pytest
import xarray as xr

import beamgyro as bg
from program import PROGRAM, ROOT, SCENARIOS, SHIPPED_SCENARIOS, ended, said

SHORT = {
    "quasistatic": {"duration_s": 8, "output_rate_Hz": 10},
    "envelope": {"duration_s": 2, "output_rate_Hz": 10},
    "carrier": {"duration_s": 0.4, "output_rate_Hz": 50},
}


@pytest.mark.parametrize("fidelity", SHORT)
@pytest.mark.parametrize("scenario", SHIPPED_SCENARIOS[:20],
                         ids=lambda path: path.stem)
def test_recording_is_that_of_the_command(scenario, fidelity, tmp_path):
    changes = SHORT[fidelity]
    options = [word for key, value in changes.items()
               for word in ("--set", f"{key}={value}")]
    said(PROGRAM, "run", scenario, "-o", "command.h5", *options, "--fidelity",
         fidelity, "--seed", 11, cwd=tmp_path)
    made = bg.run(scenario, set=changes, seed=11, fidelity=fidelity)
    bg.save_recording(made, tmp_path / "python.h5")
    command = (tmp_path / "command.h5").read_bytes()
    assert (tmp_path / "python.h5").read_bytes() == command
    with xr.open_dataset(tmp_path / "command.h5", engine="h5netcdf") as read:
        assert_same(made, read)


def assert_same(made, read):
    """Names and order, dimensions, types, bits and attributes."""
    assert list(made.variables) == list(read.variables)
    assert list(made.coords) == list(read.coords)
    assert made.attrs == read.attrs
    assert ({k: type(v) for k, v in made.attrs.items()}
            == {k: type(v) for k, v in read.attrs.items()})
    for name, variable in read.variables.items():
        mine = made.variables[name]
        assert (mine.dims, mine.dtype) == (variable.dims, variable.dtype)
        assert mine.values.tobytes() == variable.values.tobytes(), name
        assert list(mine.attrs) == list(variable.attrs)
        for key, value in variable.attrs.items():
            np.testing.assert_array_equal(mine.attrs[key], value)
            assert np.asarray(mine.attrs[key]).dtype == np.asarray(
                value).dtype
        assert mine.encoding["dtype"] == variable.encoding["dtype"]


def test_csv_of_a_run_is_that_of_the_command(tmp_path):
    said(PROGRAM, "run", SCENARIOS / "warm_up.toml", "-o", "a.csv", "--set",
         "duration_s=30", cwd=tmp_path)
    bg.run_to_file(SCENARIOS / "warm_up.toml", tmp_path / "b.csv",
                   set={"duration_s": 30})
    assert ((tmp_path / "a.csv").read_bytes()
            == (tmp_path / "b.csv").read_bytes())


def test_characterise_gives_the_table_of_the_command(tmp_path):
    device = SCENARIOS / "devices/nominal.toml"
    said(PROGRAM, "characterise", device, "-o", "a.csv", "--beam-temperature",
         "-20:40:10", cwd=tmp_path)
    table = bg.characterise(device, slice(-20, 40, 10))
    assert table.encoding["csv"] == (tmp_path / "a.csv").read_text()
    header, *rows = (tmp_path / "a.csv").read_text().splitlines()
    column = header.split(",").index("bias_deg_per_s")
    np.testing.assert_allclose(
        table["bias"], [float(row.split(",")[column]) for row in rows],
        rtol=1e-8)  # the table has nine digits


def test_compensator_and_its_answers_are_those_of_the_command(
        sweeps, tmp_path):
    for name, sweep in zip(("a", "b"), sweeps):
        sweep.beamgyro.save(tmp_path / f"{name}.h5")
    model = SCENARIOS / "models/cubic.toml"
    said(PROGRAM, "train", "a.h5", "--model", model, "-o", "c.json",
         cwd=tmp_path)
    said(PROGRAM, "compensate", "c.json", "b.h5", "-o", "d.h5", cwd=tmp_path)
    trained = bg.train(model, tmp_path / "a.h5")
    assert trained.text == (tmp_path / "c.json").read_text()
    answer = bg.compensate(tmp_path / "c.json", sweeps[1])
    answer.beamgyro.save(tmp_path / "e.h5")
    assert ((tmp_path / "e.h5").read_bytes()
            == (tmp_path / "d.h5").read_bytes())


def test_validation_is_that_of_the_command(sweeps, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sweeps[0].beamgyro.save(tmp_path / "a.h5")
    sweeps[1].beamgyro.save(tmp_path / "b.h5")
    bg.train(SCENARIOS / "models/cubic.toml",
             tmp_path / "a.h5").save(tmp_path / "c.json")
    shutil.copy(ROOT / "specs/uav.toml", tmp_path / "spec.toml")
    for arguments, options in [
            ([], {}), (["--spec", "spec.toml"], {"spec": "spec.toml"})]:
        answer = ended(PROGRAM, "validate", "c.json", "b.h5", *arguments,
                       "--json", "v.json", cwd=tmp_path, allowed=(0, 3))
        result = bg.validate("c.json", "b.h5", **options)
        assert str(result) == answer.stdout
        assert result.to_json() == (tmp_path / "v.json").read_text()
        assert result.passed == (answer.returncode == 0)
