# SPDX-License-Identifier: MIT
"""Devices of data sheets, and devices in formats of simulators."""

import inspect
import pickle
import re

import pytest

import beamgyro as bg
from program import CUBIC, PROGRAM, SCENARIOS, said

NOMINAL = SCENARIOS / "devices/nominal.toml"
FIGURES = {"length": 9e-3, "quality": 400, "mount": "epoxy", "bits": 8,
           "sensor_range_degC": (-40, 85), "noise_deg_per_s_per_sqrt_Hz": 0.02}


def words_of(figures):
    """The options of the command for these figures."""
    for name, value in figures.items():
        yield "--" + name.replace("_", "-")
        yield (":".join(map(str, value)) if isinstance(value, tuple)
               else str(value))


@pytest.fixture(scope="module", name="small")
def design():
    return bg.design_device(NOMINAL, **FIGURES)


def test_a_device_of_a_data_sheet_is_that_of_the_command(small, tmp_path):
    said(PROGRAM, "device", "--like", NOMINAL, *words_of(FIGURES), "-o",
         tmp_path / "small.toml")
    assert small.text == (tmp_path / "small.toml").read_text()
    assert isinstance(small, bg.Device)
    run = bg.run(SCENARIOS / "ten_minutes.toml", device=small)
    assert run.sizes["time"] == 3000


def test_it_tells_where_its_keys_come_from(small):
    derivation = small.derivation
    assert derivation["beam.length_m"] == "nominal.toml x 0.225: length"
    keys = re.findall(r"^(\S+) = ", small.text, re.MULTILINE)
    assert len(derivation) == len(keys) > 80
    [quality] = [one for one in small.figures if one.name == "quality factor"]
    assert quality.asked == 400 and quality.is_met
    assert quality.measured == pytest.approx(400, rel=0.02)


def test_it_pickles_as_itself(small):
    copy = pickle.loads(pickle.dumps(small))
    assert copy == small and copy.figures == small.figures
    assert copy.derivation == small.derivation


def test_its_keywords_are_the_options_of_the_command():
    keywords = list(inspect.signature(bg.design_device).parameters)
    options = re.findall(r"^  (?:-\w, )?--([\w-]+)",
                         said(PROGRAM, "help", "device"), re.MULTILINE)
    options = [one.replace("-", "_") for one in options]
    assert sorted(keywords) == sorted(set(options) - {"output", "quiet", "help",
                                             "version"})
    for name in keywords:
        assert f" {name}:" in bg.design_device.__doc__


@pytest.mark.parametrize("figures, words", [
    ({"lenght": 9e-3}, "unexpected keyword argument 'lenght'"),
    ({"length": "9 mm"}, "length '9 mm': is no number"),
    ({"length": -1.0}, "length"), ({"bits": 8.5}, "bits 8.5"),
    ({"mount": "glue"}, "mount"), ({"sensor_range_degC": 3}, "two numbers"),
    ({"range_deg_per_s": 300, "full_scale_deg_per_s": 100}, "full_scale")])
def test_what_is_wrong_is_named(figures, words):
    with pytest.raises((TypeError, ValueError), match=words):
        bg.design_device(**figures)


@pytest.mark.parametrize("format, options, words", [
    ("ardupilot-sitl", {}, []),
    ("ardupilot-sitl", {"range_degC": (-20, 40), "axes": ["x"],
                        "temperature_degC": 20.0, "instance": 2},
     ["--range", "-20:40", "--axis", "x", "--temperature-degC", "20",
      "--instance", "2"]),
    ("sdf", {"update_rate_Hz": 250, "name": "mine"},
     ["--update-rate-Hz", "250", "--name", "mine"])])
def test_simulators_get_the_files_of_the_command(format, options, words,
                                                 tmp_path):
    said(PROGRAM, "export", NOMINAL, "--format", format, "-o",
         tmp_path / "command", *words)
    files = bg.export(bg.Device(NOMINAL), format, tmp_path / "python",
                      **options)
    made = {path.name: path.read_text()
            for path in (tmp_path / "command").iterdir()}
    assert files == made
    assert files == {path.name: path.read_text()
                     for path in (tmp_path / "python").iterdir()}


def test_devices_and_compensators_go_together(tmp_path):
    (tmp_path / "model.toml").write_text(CUBIC)
    run = bg.run(SCENARIOS / "ramp.toml", set={"output_rate_Hz": 1})
    bg.train(tmp_path / "model.toml", run).save(tmp_path / "c.json")
    said(PROGRAM, "export", NOMINAL, tmp_path / "c.json", "--format",
         "ardupilot-sitl", "-o", tmp_path / "command")
    files = bg.export([str(NOMINAL), tmp_path / "c.json"], "ardupilot-sitl")
    assert files == {path.name: path.read_text()
                     for path in (tmp_path / "command").iterdir()}


@pytest.mark.parametrize("format, options, words", [
    ("c", {"range_degC": (0, 1)}, "range_degC: no option of the format c"),
    ("sdf", {"force": True}, "force: no option of the format sdf"),
    ("sdf", {"range_degC": (0, 1)}, "range_degC"),
    ("sdf", {"update_rate_Hz": -1}, "update_rate_Hz")])
def test_options_of_other_formats_are_refused(format, options, words):
    with pytest.raises(ValueError, match=words):
        bg.export(NOMINAL, format, **options)
