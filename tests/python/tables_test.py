# SPDX-License-Identifier: MIT
"""Results as tables of pandas, campaigns as mappings, units of arrays."""

import math
import pickle

import numpy as np
import pytest
import xarray

import beamgyro as bg

from program import SCENARIOS

NOMINAL = SCENARIOS / "devices/nominal.toml"
REST = {"name": "rest", "device": str(NOMINAL), "fidelity": "quasistatic",
        "duration_s": 60, "output_rate_Hz": 1, "seed": 1,
        "ambient": {"constant_degC": 25}}
KEYS = {"name": "mine", "seed": 3, "devices": 3, "devices_per_file": 2,
        "device": str(NOMINAL),
        "tolerances": {"mount.axis_angle_deg": {
            "normal": {"mean": 0, "sigma": 1}}},
        "run": [{"name": "rest", "scenario": REST}]}


def test_a_validation_is_a_table(sweeps):
    cubic = bg.train(SCENARIOS / "models/cubic.toml", sweeps[0])
    limits = {"residual_rms_deg_per_s": {"max": 1e-6, "source": "none"},
              "scale_factor_error_ppm": {"max": 1e4, "source": "none"}}
    result = bg.validate(cubic, sweeps[1], spec={"name": "mine",
                                                 "limits": limits})
    metrics = result.to_dataframe()
    assert list(metrics.index) == list(result.metrics)
    one = result.metrics["residual_rms_deg_per_s"]
    row = metrics.loc["residual_rms_deg_per_s"]
    assert row.after == one["after"]["value"]
    assert [row.after_low, row.after_high] == one["after"]["interval"]
    table = result.to_dataframe("limits")
    assert list(table.index) == list(limits)
    assert table.loc["residual_rms_deg_per_s", "result"] == "fail"
    assert math.isnan(table.loc["scale_factor_error_ppm", "value"])
    checks = result.to_dataframe("checks")
    assert checks.passed.to_dict() == {
        name: one["passed"] for name, one in result.checks.items()}
    with pytest.raises(ValueError, match="table 'all': expected one of"):
        result.to_dataframe("all")


def test_allan_and_curves_are_tables(sweeps):
    found = bg.allan(bg.run(SCENARIOS / "ten_minutes.toml"))
    table = found.to_dataframe()
    assert table.index.name == "tau"
    assert list(table.deviation) == [one["deviation"]
                                     for one in found.data["oadev"]]
    curves = bg.curve_figures(bg.characterise(
        bg.Campaign(KEYS), slice(-20, 40, 2)))
    assert len(curves.to_dataframe()) == 3


def test_a_mapping_makes_the_set_of_its_file(tmp_path):
    campaign = bg.Campaign(KEYS)
    assert campaign == bg.Campaign(dict(KEYS))
    assert pickle.loads(pickle.dumps(campaign)) == campaign
    # The same in every process, wherever the project lies.
    assert "/tmp" not in campaign.text.replace(str(SCENARIOS), "")
    assert bg.Campaign(KEYS, devices=2).devices == 2
    (tmp_path / "rest.toml").write_text(bg.Scenario(REST).text)
    assert bg.Campaign({**KEYS, "run": [{"name": "rest", "scenario":
                        bg.Scenario(REST)}]}).devices == 3
    made = bg.generate(campaign, tmp_path / "set")
    assert made.runs == ["rest"] and len(made) == 3
    own = bg.run(bg.Scenario(REST, device=campaign.device(1)))
    np.testing.assert_allclose(made["rest", 1].true_bias, own.true_bias,
                               rtol=2**-24)  # a set is in single precision


@pytest.mark.parametrize("keys, words", [
    ({"devies": 3}, "campaign.toml:.*: devies: unknown key"),
    ({"run": 3}, "campaign: run: expected a sequence of mappings"),
    ({"device": 3}, "campaign: device 3: expected a file"),
    ({"run": [{"name": "rest", "scenario": {**REST, "fidelity": "x"}}]},
     "scenario.toml:.*fidelity")])
def test_a_wrong_mapping_is_named_by_its_key(keys, words):
    with pytest.raises(ValueError, match=words):
        bg.Campaign({**KEYS, **keys})


@pytest.mark.parametrize("unit, factor, offset", [
    ("degC", 1, 0), ("K", 1, 273.15), ("degF", 1.8, 32)])
def test_temperatures_have_the_unit_that_their_array_states(
        unit, factor, offset):
    plain = [-20.0, 25.0, 40.0]
    given = xarray.DataArray(factor * np.array(plain) + offset,
                             attrs={"units": unit})
    np.testing.assert_allclose(bg.characterise(NOMINAL, given).bias,
                               bg.characterise(NOMINAL, plain).bias,
                               rtol=1e-9)  # the unit rounds the temperature


def test_another_unit_of_temperatures_is_refused():
    with pytest.raises(ValueError, match="the unit 'V'; expected degC"):
        bg.characterise(NOMINAL, xarray.DataArray([25.0], attrs={
            "units": "V"}))


def test_a_mean_of_status_bits_is_a_warning():
    run = bg.run(SCENARIOS / "ten_minutes.toml")
    means = run.coarsen(time=2).mean()
    with pytest.warns(bg.BeamgyroWarning, match="status: holds floats"):
        bg.allan(means)
