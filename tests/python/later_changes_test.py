# SPDX-License-Identifier: MIT
"""Files and directories that change after something was made of them."""

import os
import pickle
import shutil

import pytest

import beamgyro as bg
from program import SCENARIOS

SMALL = SCENARIOS / "campaigns/small.toml"


def profile(path, temperature):
    path.parent.mkdir(exist_ok=True)
    path.write_text("time_s,temperature_degC\n"
                    f"0,{temperature}\n100,{temperature}\n")


@pytest.fixture(name="scenario")
def make_scenario(tmp_path, monkeypatch):
    """A scenario with a profile in a file of the working directory."""
    profile(tmp_path / "cold/profile.csv", -20)
    profile(tmp_path / "hot/profile.csv", 45)
    monkeypatch.chdir(tmp_path / "cold")
    return bg.Scenario({
        "name": "x", "description": "profile",
        "device": str(SCENARIOS / "devices/nominal.toml"),
        "fidelity": "quasistatic", "duration_s": 20, "output_rate_Hz": 1,
        "seed": 1, "ambient": {"file": "profile.csv"}})


def first_temperature(scenario, **options):
    return round(float(bg.run(scenario, **options).temperature[0]))


def use_another_directory(folder):
    os.chdir(folder.parent / "hot")


def change_the_file(folder):
    profile(folder / "profile.csv", 45)


def remove_the_file(folder):
    (folder / "profile.csv").unlink()


@pytest.mark.parametrize("change", [use_another_directory, change_the_file,
                                    remove_the_file])
def test_a_scenario_keeps_the_profiles_that_it_read(scenario, change,
                                                    tmp_path):
    pickled = pickle.dumps(scenario)
    change(tmp_path / "cold")
    twin = pickle.loads(pickled)
    assert twin == scenario
    for made in (scenario, twin, scenario.with_(seed=2),
                 scenario.with_(device=SCENARIOS / "devices/lifelike.toml")):
        assert first_temperature(made) == -20
        assert first_temperature(made, seed=3) == -20


def test_a_profile_may_be_in_another_encoding(scenario, tmp_path):
    path = tmp_path / "cold/profile.csv"
    path.write_bytes(b"time_s,temperature_degC,\xb0\n0,-20,1\n100,-20,1\n")
    read = bg.Scenario.parse(scenario.text, scenario.device)
    assert read != scenario
    assert pickle.loads(pickle.dumps(read)) == read


def test_scenarios_with_other_profiles_are_not_equal(scenario, tmp_path):
    text, device = scenario.text, scenario.device
    cold = bg.Scenario.parse(text, device)
    os.chdir(tmp_path / "hot")
    hot = bg.Scenario.parse(text, device)
    assert first_temperature(hot) == 45
    assert hot != cold
    assert cold.with_({"ambient.file": str(tmp_path / "hot/profile.csv")}
                      ) != cold


def test_a_set_is_that_of_its_directory(tmp_path, monkeypatch):
    for folder, seed in (("one", 1), ("other", 2)):
        (tmp_path / folder).mkdir()
        monkeypatch.chdir(tmp_path / folder)
        bg.generate(SMALL, "set", devices=3, progress=False)
        if folder == "one":
            made = bg.open_set("set")
    other = bg.open_set("set")
    assert made != other
    assert pickle.loads(pickle.dumps(made)) == made
    run = made.runs[0]
    with made.view(run) as view:
        before = view.rate.values.copy()
    assert made.directory == tmp_path / "one/set"
    shutil.rmtree(tmp_path / "other")
    os.chdir(tmp_path)
    with made.view(run) as view:
        assert view.rate.values.tobytes() == before.tobytes()
    shutil.rmtree(made.directory)
    with pytest.raises(ValueError, match=f"{run}.nc: no such file"):
        made.view(run)
