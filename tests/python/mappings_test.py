# SPDX-License-Identifier: MIT
"""Specifications and qualifications as mappings, and what is not stated."""

import warnings

import numpy as np
import pytest

import beamgyro as bg
from program import SCENARIOS

KEYS = {"duration_s": 600, "output_rate_Hz": 1}


@pytest.fixture(scope="module", name="cubic")
def make_compensator():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return bg.train(SCENARIOS / "models/cubic.toml", bg.run(
            SCENARIOS / "soak_sweep_train.toml", set={"output_rate_Hz": 0.1}))


def test_a_specification_needs_no_name_and_no_sources(cubic):
    run = bg.run(SCENARIOS / "soak_sweep_test.toml",
                 set={"output_rate_Hz": 0.1})
    limit = {"residual_rms_deg_per_s": {"max": 1e-6}}
    result = bg.validate(cubic, run, spec={"limits": limit})
    assert result.verdict == "fail"
    own = bg.validate(cubic, run, spec={
        "name": "mine", "limits": {"residual_rms_deg_per_s": {
            "max": 1e-6, "source": "not stated"}}})
    assert own == result


def test_a_qualification_may_be_a_mapping(cubic, monkeypatch, tmp_path):
    (tmp_path / "runs").mkdir()
    rest = (SCENARIOS / "warm_up.toml").read_text().replace(
        '"devices/', f'"{SCENARIOS}/devices/')
    (tmp_path / "runs/rest.toml").write_text(rest)
    monkeypatch.chdir(tmp_path)
    scenario = {"name": "sweep", "device": str(
        SCENARIOS / "devices/nominal.toml"), "fidelity": "quasistatic",
        "duration_s": 3000, "output_rate_Hz": 1, "seed": 4,
        "ambient": {"points": [[0, 0], [3000, 40]]}}
    table = {
        "name": "short", "description": "two runs",
        "run": [{"name": "rest", "purpose": "warm_up",
                 "scenario": "runs/rest.toml", "overrides": {
                     **KEYS, "ambient.constant_degC": 10.0}},
                {"name": "ramp", "purpose": "ramp", "scenario": scenario}],
        "training": [{"name": "train", "scenario": scenario,
                      "overrides": {"seed": 9}}]}
    device = SCENARIOS / "devices/nominal.toml"
    found = bg.validate(cubic, device=device, qualification=table)
    assert "rest" in str(found.data) and "ramp" in str(found.data)
    with pytest.raises(ValueError, match="qualification: run: expected a seq"):
        bg.validate(cubic, device=device, qualification={**table, "run": 3})
    with pytest.raises(ValueError, match="run_0_scenario 3: expected a file"):
        bg.validate(cubic, device=device, qualification={
            **table, "run": [{"name": "rest", "purpose": "warm_up",
                              "scenario": 3}]})


class Slope:
    """Predicts from one feature without a name."""

    n_features_in_ = 1

    def predict(self, rows):
        return 0 * rows[:, 0]


def test_inputs_that_are_not_stated_are_a_warning():
    run = bg.run(SCENARIOS / "warm_up.toml", set=KEYS)
    with pytest.warns(bg.BeamgyroWarning, match="Slope: states no inputs"):
        unstated = bg.compensate(Slope(), run)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        stated = bg.compensate(
            bg.Compensator(Slope(), inputs=["temperature"]), run)
    np.testing.assert_array_equal(unstated.compensated_rate,
                                  stated.compensated_rate)


def test_a_dataset_is_no_answer():
    run = bg.run(SCENARIOS / "warm_up.toml", set=KEYS)
    with pytest.raises(ValueError, match=r"is a dataset.*dataset\[.rate.\]"):
        bg.compensate(lambda signals: signals, run)


def test_a_set_shows_its_parts_in_notebooks(tmp_path):
    made = bg.generate(SCENARIOS / "campaigns/small.toml", tmp_path / "set",
                       devices=4, progress=False)
    shown = made._repr_html_()
    assert "warm_up" in shown and "0 of 4 runs" in shown
    assert f"4: {len(made.devices_of('train'))} train" in shown
