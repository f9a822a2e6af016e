# SPDX-License-Identifier: MIT
"""Our populations against the published figures of a real gyro."""

import re
import tomllib

import numpy as np
import pytest

import beamgyro as bg
from program import ROOT, SCENARIOS

HARDWARE = tomllib.loads((ROOT / "docs/hardware/xv7081bb.toml").read_text())
CURVES = HARDWARE["curves"]
SEEDS = range(1, 6)
LOGARITHMS = {"pp_deg_per_s": "log10_pp",
              "left_by_cubic": "log10_left_by_cubic"}


def figures_of(campaign, seed, folder):
    """300 units of another seed, as the drawing shows the real ones."""
    path = SCENARIOS / f"campaigns/{campaign}.toml"
    text = re.sub(r"(?m)^seed = .*", f"seed = {seed}", path.read_text())
    file = folder / f"{campaign}_{seed}.toml"
    file.write_text(text.replace('"../', f'"{SCENARIOS}/'))
    low, high = CURVES["range_degC"]
    curves = bg.characterise(file, slice(low, high, 0.5), devices=300)
    assert curves.sizes["device"] == 300
    return bg.curve_figures(curves, range_degC=(low, high),
                            zero_at_degC=CURVES["zero_at_degC"],
                            round_deg_per_s=CURVES["round_deg_per_s"])


def areas(found):
    """The area metrics from the real units, in 95 % points of their halves."""
    quantiles = CURVES["quantiles"]
    for name in (*LOGARITHMS, "kink"):
        scale = np.log10 if name in LOGARITHMS else np.asarray
        area = bg.area_metric(scale(np.array(found.figures[name])),
                              scale(np.array(quantiles[name])),
                              shares=quantiles["shares"])
        yield name, area / CURVES["half_split"][
            LOGARITHMS.get(name, name)]["p95"]


@pytest.fixture(scope="module")
def trimmed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trimmed")
    return [figures_of("trimmed", seed, folder) for seed in SEEDS]


def test_trimmed_units_are_as_far_from_the_real_ones_as_chance(trimmed):
    for found in trimmed:
        for name, ratio in areas(found):
            assert ratio <= 1.5, name


def test_trimmed_units_differ_as_the_real_ones(trimmed):
    first = [found.data["component_shares"][0] for found in trimmed]
    assert 0.5 <= np.mean(first) <= 0.7
    for found in trimmed:
        assert 0.2 <= found.data["pp_log10_sigma"] <= 0.4


def white_noise_of(device):
    """What the output at rest shows [deg/sqrt(s)]."""
    recording = bg.run(SCENARIOS / "rest.toml", device=device, set={
        "duration_s": 1000, "output_rate_Hz": 100})
    found = bg.allan(recording.isel(time=recording.time >= 500))
    return found.coefficients["N"]["per_second"]["value"]


def test_trimmed_device_has_the_figures_of_the_data_sheet():
    sheet = HARDWARE["data_sheet"]
    device = tomllib.loads((SCENARIOS / "devices/trimmed.toml").read_text())
    at_25 = bg.characterise(device, 25)
    low, high = sheet["drive_frequency_Hz"]
    assert low <= at_25["drive_frequency"].item() <= high
    assert (sheet["split_Hz"]["min"] <= at_25["split"].item()
            <= sheet["split_Hz"]["max"])
    assert (device["readout"]["full_scale_deg_per_s"]
            == sheet["full_scale_deg_per_s"])
    # Both of white noise: one side of the spectrum, and an hour of it. As the
    # output shows it, with the noise of beam and amplifiers.
    walk = white_noise_of(SCENARIOS / "devices/trimmed.toml")
    assert walk * np.sqrt(2) == pytest.approx(
        sheet["noise_density_deg_per_s_per_sqrt_Hz"], rel=0.02)
    assert walk * 60 == pytest.approx(
        sheet["angle_random_walk_deg_per_sqrt_h"], rel=0.03)
    assert device["thermal"]["electronics_power_W"] == pytest.approx(
        sheet["supply_A"] * sheet["supply_V"])


@pytest.mark.parametrize("campaign", ["population", "lifelike"])
def test_the_untrimmed_classes_are_another_family(campaign, tmp_path):
    """What docs/hardware.md says of them: none of their figures agrees."""
    for name, ratio in areas(figures_of(campaign, 1, tmp_path)):
        assert ratio > 3, name
