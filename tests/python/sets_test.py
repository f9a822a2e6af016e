# SPDX-License-Identifier: MIT
"""Sets, Allan deviations, plans and sensitivity."""

import pickle

import numpy as np
import pytest

import beamgyro as bg
from program import PROGRAM, SCENARIOS, said


@pytest.fixture(scope="module", name="campaign")
def make_campaign():
    return SCENARIOS / "campaigns/small.toml"


@pytest.fixture(scope="module", name="made")
def make_set(campaign, tmp_path_factory):
    shares = []
    folder = tmp_path_factory.mktemp("set") / "made"
    made = bg.generate(campaign, folder, devices=6, jobs=2,
                       progress=shares.append)
    assert all(0 <= share <= 1 for share in shares)
    return made


def test_a_set_has_the_bytes_of_the_command(campaign, made, tmp_path):
    said(PROGRAM, "generate", campaign, "-o", "set", "--devices", 6,
         cwd=tmp_path)
    command, python = (
        {path.relative_to(folder): path.read_bytes()
         for path in folder.rglob("*") if path.is_file()}
        for folder in (tmp_path / "set", made.directory))
    assert python == command


def test_recordings_of_a_set_are_read_when_asked_for(made):
    run = made.runs[0]
    key = (run, 1)
    recording = made[key]
    assert len(made) == 6 * len(made.runs)
    assert key in made
    assert (run, 6) not in made
    with made.view(run) as view:
        np.testing.assert_allclose(
            recording.temperature, view.temperature.isel(device=1),
            rtol=1e-6)  # stored in single precision at most
    assert pickle.loads(pickle.dumps(made)) == made
    assert made.verify() == []
    with pytest.raises(ValueError, match="99"):
        made.recording(run, 99)


def test_parameters_of_a_set_are_over_its_devices(made):
    table = made.parameters()
    assert table.sizes["device"] == 6
    name = next(iter(table.data_vars))
    assert np.ptp(table[name].values) > 0
    parts = [made.part(device) for device in range(made.devices)]
    assert set(parts) <= {"train", "validation", "test"}
    assert made.devices_of("train") == [
        device for device, part in enumerate(parts) if part == "train"]


def test_a_finished_set_is_not_overwritten(campaign, made):
    with pytest.raises(ValueError, match="resume"):
        bg.generate(campaign, made.directory, devices=6, progress=False)
    again = bg.generate(campaign, made.directory, devices=6, resume=True,
                        progress=False)
    assert again == made


def test_damage_is_found(campaign, tmp_path):
    made = bg.generate(campaign, tmp_path / "set", devices=2, progress=False)
    file = next(made.directory.rglob("*.h5"))
    data = bytearray(file.read_bytes())
    data[len(data) // 2] ^= 1
    file.write_bytes(data)
    assert file.name in made.verify()[0][0]


def test_allan_of_white_noise_falls_with_the_root_of_the_time(tmp_path):
    samples = np.random.default_rng(1).normal(size=2 ** 16)
    result = bg.allan(samples, rate_Hz=10)
    curve = result.to_dataset("oadev")
    column = [name for name in curve.data_vars if "deviation" in name][0]
    short = curve[column].sel(tau=0.1, method="nearest")
    # One sample is a tenth of a second; of 65,536 the error is 0.4 %.
    assert float(short) == pytest.approx(1.0, rel=0.02)
    tenth = curve[column].sel(tau=12.8, method="nearest")
    assert float(tenth) == pytest.approx(128 ** -0.5, rel=0.1)
    path = tmp_path / "rates.csv"
    path.write_text("\n".join(map(repr, samples.tolist())) + "\n")
    told = said(PROGRAM, "allan", path, "--rate-Hz", 10, "--json",
                tmp_path / "a.json")
    assert str(bg.allan(path, rate_Hz=10)) == told
    assert bg.allan(path, rate_Hz=10).to_json() == (
        tmp_path / "a.json").read_text()


def test_sensitivity_is_that_of_the_command(campaign, tmp_path):
    told = said(PROGRAM, "sensitivity", campaign, "--samples", 64, "--figure",
                "bias_pp_deg_per_s", "--json", tmp_path / "s.json")
    found = bg.sensitivity(campaign, samples=64,
                           figures=["bias_pp_deg_per_s"])
    assert found.to_json() == (tmp_path / "s.json").read_text()
    assert str(found) == told
    indices = found.figures["bias_pp_deg_per_s"]
    assert indices[0]["total"] >= indices[-1]["total"]
    assert indices[0]["key"] in found._repr_html_()


def test_tasks_make_the_set_together(campaign, made, tmp_path):
    folder = tmp_path / "shared"
    assert bg.generate(campaign, folder, devices=6, shard=(2, 2),
                       progress=False) is None
    whole = bg.generate(campaign, folder, devices=6, shard=(1, 2),
                        progress=False)
    assert whole is not None and len(whole) == 6
    for path in made.directory.rglob("*"):
        if path.is_file():
            twin = folder / path.relative_to(made.directory)
            assert twin.read_bytes() == path.read_bytes()


@pytest.mark.parametrize("shard", [(0, 2), (3, 2), (1,), "1/2", 1, (1, 2, 3),
                                   (1, 1.5)])
def test_what_is_no_task_is_said(campaign, tmp_path, shard):
    with pytest.raises(ValueError, match="shard"):
        bg.generate(campaign, tmp_path / "set", shard=shard, progress=False)
    assert not (tmp_path / "set").exists()
