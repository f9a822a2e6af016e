# SPDX-License-Identifier: MIT
"""Curves of a campaign, what describes them, and the area metric."""

import json
import tomllib
import warnings

import numpy as np
import pytest
import xarray as xr

import beamgyro as bg
from program import PROGRAM, ROOT, SCENARIOS, said

CAMPAIGN = SCENARIOS / "campaigns/small.toml"
NOMINAL = SCENARIOS / "devices/nominal.toml"
GRID = slice(-20, 50, 2)


@pytest.fixture(scope="module", name="curves")
def make_curves():
    return bg.characterise(CAMPAIGN, GRID, devices=6)


def test_a_row_is_the_curve_of_the_device_alone(curves):
    assert curves["bias"].dims == ("device", "temperature")
    campaign = bg.Campaign(CAMPAIGN, devices=6)
    for number in (0, 5):
        alone = bg.characterise(campaign.device(number), GRID)
        for name in alone.data_vars:
            np.testing.assert_array_equal(
                curves[name].sel(device=number), alone[name], err_msg=name)
            assert curves[name].attrs["units"] == alone[name].attrs["units"]


def test_files_of_the_command_have_the_same_values(curves, tmp_path):
    for name in ("c.csv", "c.h5"):
        said(PROGRAM, "characterise", CAMPAIGN, "--devices", 6, "-o", name,
             "--beam-temperature", "-20:50:2", cwd=tmp_path)
    assert curves.encoding["csv"] == (tmp_path / "c.csv").read_text()
    for engine in ("h5netcdf", "netcdf4"):
        with xr.open_dataset(tmp_path / "c.h5", engine=engine) as read:
            assert read.attrs["filetype"] == "beamgyro-curves"
            for name in curves.variables:
                np.testing.assert_array_equal(read[name], curves[name])


def test_figures_are_those_of_the_command(curves, tmp_path):
    text = said(PROGRAM, "characterise", CAMPAIGN, "--devices", 6, "-o",
                "c.csv", "--beam-temperature", "-20:50:2", "--json", "f.json",
                "--range", "-10:40", "--zero-at", 25, "--round", 0.0074,
                cwd=tmp_path)
    found = bg.curve_figures(curves, range_degC=(-10, 40), zero_at_degC=25,
                             round_deg_per_s=0.0074, name="small")
    assert str(found) == text
    assert found.to_json() == (tmp_path / "f.json").read_text()
    assert found.figures["kink"] == json.loads(
        found.to_json())["figures"]["kink"]["values"]
    array = curves["bias"].transpose("temperature", "device")
    assert bg.curve_figures(array).data == bg.curve_figures(curves).data


def test_curves_of_others_are_described():
    T = np.linspace(-20, 50, 71)
    units = xr.DataArray([T, T ** 2, 0 * T], {"temperature": T},
                         ("device", "temperature"))
    found = bg.curve_figures(units, range_degC=(0, 50))
    np.testing.assert_allclose(found.figures["pp_deg_per_s"], [50, 2500, 0])
    assert found.figures["left_by_line"][0] < 1e-20
    assert found.figures["kink"][1] == pytest.approx(18 / 2500)
    assert found.figures["kink"][2] is None
    assert found.data["flat"] == 1


def test_devices_that_do_not_work_are_named(tmp_path):
    campaign = CAMPAIGN.read_text().replace(
        "../", f"{SCENARIOS}/").replace(
        "[tolerances]", '[tolerances]\n"air.inverse_Q" = { normal = { mean = '
        "1e-4, sigma = 2e-4 } }")
    (tmp_path / "c.toml").write_text(campaign)
    with pytest.warns(bg.BeamgyroWarning, match="of 8 devices do not work"):
        curves = bg.characterise(tmp_path / "c.toml", 25.0, devices=8)
    assert 0 < curves.sizes["device"] < 8


def test_area_metric_of_shifts():
    sample = np.random.default_rng(1).normal(size=77)
    assert bg.area_metric(sample, sample + 0.3) == pytest.approx(0.3)
    shares = np.linspace(0.05, 0.95, 19)
    assert bg.area_metric(sample + 0.3, np.quantile(sample, shares),
                          shares=shares) == pytest.approx(0.3, abs=0.02)
    halves = bg.half_split(sample, draws=200)
    # Of two samples of 38 and 39 normal numbers, sqrt(1/38 + 1/39) each way.
    assert 0.1 < halves.median < 0.3 < halves.p95 < 0.7


def test_the_published_table_is_one_of_quantiles():
    table = tomllib.loads(
        (ROOT / "docs/hardware/xv7081bb.toml").read_text())["curves"]
    quantiles = table["quantiles"]
    shares = quantiles.pop("shares")
    for values in quantiles.values():
        # The table against points of itself: less than their steps.
        even = np.interp(np.linspace(0, 1, 77), shares, values)
        assert bg.area_metric(even, values, shares=shares) < 0.02
    median = dict(zip(shares, quantiles["pp_deg_per_s"]))[0.5]
    assert table["half_split"]["log10_pp"]["median"] < table["pp_log10_sigma"]
    assert table["round_deg_per_s"] < median / 5


REFUSED = {
    "set of a campaign": (lambda c: bg.characterise(
        CAMPAIGN, set={"beam.length_m": 0.04}), "set .*for a device"),
    "devices of a device": (lambda c: bg.characterise(
        NOMINAL, devices=3), "devices 3: is for a campaign"),
    "jobs of a device": (lambda c: bg.characterise(NOMINAL, jobs=2),
                         "jobs 2: is for a campaign"),
    "no devices": (lambda c: bg.characterise(CAMPAIGN, devices=0),
                   "devices 0"),
    "a scenario": (lambda c: bg.characterise(SCENARIOS / "rest.toml"),
                   "is a scenario"),
    "narrow": (lambda c: bg.curve_figures(c, range_degC=(0, 10)),
               "range_degC.*6 temperatures.*8 or more"),
    "zero beyond": (lambda c: bg.curve_figures(c, zero_at_degC=60),
                    "zero_at_degC=60.*-20 to 50 degC"),
    "round 0": (lambda c: bg.curve_figures(c, round_deg_per_s=0.0),
                "round_deg_per_s=0"),
    "falling": (lambda c: bg.curve_figures(c.isel(
        temperature=slice(None, None, -1))), "increase"),
    "nan": (lambda c: bg.curve_figures(c["bias"].where(c["bias"] > 1e9)),
            "curves: value 0 is nan"),
    "a device": (lambda c: bg.curve_figures(bg.characterise(NOMINAL, GRID)),
                 "device and temperature"),
    "a list": (lambda c: bg.curve_figures([[1.0]]), "device and temperature"),
    "empty": (lambda c: bg.area_metric([], [1.0]), "1 or more"),
    "inf": (lambda c: bg.area_metric([1.0], [np.inf]), "finite"),
    "shares": (lambda c: bg.area_metric([1.0], [1, 2], shares=[0.5, 0.5]),
               "shares: do not increase"),
    "lengths": (lambda c: bg.area_metric([1.0], [1, 2], shares=[0.5]),
                "as many values"),
    "no quantiles": (lambda c: bg.area_metric([1.0], [2, 1], shares=[0, 1]),
                     "values: fall"),
    "one": (lambda c: bg.half_split([1.0]), "2 or more"),
    "draws": (lambda c: bg.half_split([1.0, 2.0], draws=0), "draws 0"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_wrong_arguments_are_named(name, curves):
    call, message = REFUSED[name]
    with warnings.catch_warnings(), pytest.raises(ValueError, match=message):
        warnings.simplefilter("error")
        call(curves)


def test_progress_ends_at_one_and_stops():
    shares = []
    bg.characterise(CAMPAIGN, GRID, devices=20, progress=shares.append)
    assert shares[0] == 0 and shares[-1] == 1
