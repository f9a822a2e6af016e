# SPDX-License-Identifier: MIT
"""An array of xarray that states a unit is read in it, or refused."""

import copy

import numpy as np
import pytest
import xarray as xr

import beamgyro as bg
from program import SCENARIOS

NOMINAL = SCENARIOS / "devices/nominal.toml"
T = np.linspace(-20.0, 50.0, 71)


def stating(values, unit):
    return xr.DataArray(values, attrs={"units": unit})


def curves(unit="degree/s", temperature=T, temperature_unit="degC"):
    values = np.outer(np.arange(1.0, 11.0), 1e-3 * T ** 2)
    return xr.DataArray(values, dims=("device", "temperature"), coords={
        "temperature": ("temperature", temperature,
                        {"units": temperature_unit})}, attrs={"units": unit})


@pytest.fixture(name="gyro")
def _gyro():
    return bg.Device(NOMINAL).start(seed=1)


def refuses(call, *words):
    with pytest.raises(ValueError) as caught:
        call()
    for word in words:
        assert word in str(caught.value)


def test_curve_figures_read_the_unit_of_temperatures():
    expected = str(bg.curve_figures(curves()))
    kelvins = curves(temperature=T + 273.15, temperature_unit="K")
    assert str(bg.curve_figures(kelvins)) == expected
    assert str(bg.curve_figures(curves(unit="deg/s"))) == expected


def test_curve_figures_refuse_another_unit():
    refuses(lambda: bg.curve_figures(curves(unit="rad/s")), "curves", "rad/s",
            "degree/s")


def test_area_metric_refuses_two_units():
    here = stating(np.arange(5.0), "degree/s")
    assert bg.area_metric(here, stating(np.arange(5.0), "deg/s")) == 0
    refuses(lambda: bg.area_metric(here, stating(np.arange(5.0), "rad/s")),
            "other", "rad/s")


@pytest.mark.parametrize("name, unit", [("rate", "rad/s"),
                                        ("cross_rate_x", "rad/s"),
                                        ("acceleration_z", "g"),
                                        ("ambient", "furlong")])
def test_steps_refuse_another_unit(gyro, name, unit):
    before = gyro.state()
    refuses(lambda: gyro.advance({name: stating([1.0, 2.0], unit)}, 0.1), name,
            unit)
    refuses(lambda: bg.step_all([gyro], dt=0.1, **{name: stating([1.], unit)}),
            name, unit)
    refuses(lambda: gyro.step(dt=0.1, **{name: stating(1.0, unit)}), name,
            "xarray")
    assert gyro.state() == before


def test_steps_read_the_unit_of_the_ambient(gyro):
    other = copy.copy(gyro)
    fahrenheit = other.advance({"ambient": stating([77.0, 86.0], "degF")}, 0.1)
    celsius = gyro.advance({"ambient": [25.0, 30.0]}, 0.1)
    np.testing.assert_allclose(fahrenheit.true_bias, celsius.true_bias,
                               rtol=1e-9)


def test_an_estimator_refuses_another_unit_of_the_bias():
    X = np.column_stack([60.0 * np.arange(71), T])
    refuses(lambda: bg.Estimator("cubic").fit(X, stating(T, "degree/h")), "y",
            "degree/h")


def test_an_answer_in_another_unit_is_refused():
    scenario = {"name": "rest", "description": "at rest",
                "device": str(NOMINAL), "fidelity": "quasistatic",
                "duration_s": 60, "output_rate_Hz": 1, "seed": 1,
                "ambient": {"constant_degC": 25}}

    def in_radians(dataset):
        return stating(np.deg2rad(dataset.rate.values), "rad/s")
    refuses(lambda: bg.compensate(in_radians, bg.run(scenario)), "rad/s")
