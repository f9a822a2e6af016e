# SPDX-License-Identifier: MIT
"""Logs of real gyros."""

import pytest

import beamgyro as bg
from program import PROGRAM, said

MAP = """
[time]
column = "t"
unit = "s"
[gyro]
column = "gyro"
unit = "deg/s"
[temperature]
column = "T"
unit = "degC"
"""
KEYS = {"time": {"column": "t", "unit": "s"},
        "gyro": {"column": "gyro", "unit": "deg/s"},
        "temperature": {"column": "T", "unit": "degC"}}


@pytest.fixture(name="log")
def make_log(tmp_path):
    lines = [f"{k / 10},{20 + k / 100},{0.5 + k / 1000}" for k in range(50)]
    lines[7] = "0.7,,0.5"
    path = tmp_path / "log.csv"
    path.write_text("t,T,gyro\n" + "\n".join(lines) + "\n")
    (tmp_path / "map.toml").write_text(MAP)
    return path


def test_it_has_the_bytes_of_the_command(log, tmp_path):
    text = said(PROGRAM, "import", log, "--map", tmp_path / "map.toml",
                "-o", tmp_path / "command.h5")
    found = bg.import_log(log, tmp_path / "map.toml")
    assert found.encoding["beamgyro"]["import"] == text
    assert "49 kept" in text
    found.beamgyro.save(tmp_path / "python.h5")
    assert (tmp_path / "python.h5").read_bytes() == (
        tmp_path / "command.h5").read_bytes()
    assert bg.import_log(log, KEYS).identical(found)


@pytest.mark.parametrize("arguments, words", [
    ({"map": {**KEYS, "speed": 1}}, "map:1:1: speed: unknown key"),
    ({"map": {**KEYS, "temperature": {"column": "heat", "unit": "degC"}}},
     "heat"),
    ({"map": 3}, "map 3: expected the name of a log map, or a mapping"),
    ({"log": "nothing.csv"}, "nothing.csv"),
    ({"axis": "w"}, "axis"),
    ({"join": "other.csv"}, "other.csv"),
])
def test_what_is_wrong_is_said(log, arguments, words):
    with pytest.raises(ValueError, match=words):
        bg.import_log(**{"log": log, "map": KEYS, **arguments})
