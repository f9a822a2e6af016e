# SPDX-License-Identifier: MIT
"""Gyros that are stepped inside another simulation."""

import copy
import math
import pickle
import threading

import numpy as np
import pytest

import beamgyro as bg
from program import SCENARIOS

NOMINAL = SCENARIOS / "devices/nominal.toml"
MEASURED = ("output", "rate", "temperature", "drive_frequency",
            "drive_voltage", "quadrature")


@pytest.fixture(scope="module", name="device")
def _device():
    return bg.Device(NOMINAL)


def values(sample):
    return [getattr(sample, name) for name in ("time", *MEASURED, "status")]


def truths(sample):
    return [getattr(sample.truth, name) for name in dir(sample.truth)
            if name.startswith("true_")]


def same(a, b):
    return all(x == y or (math.isnan(x) and math.isnan(y))
               for x, y in zip(values(a) + truths(a), values(b) + truths(b)))


def test_a_scenario_replayed_gives_the_samples_of_its_run():
    scenario = bg.Scenario(SCENARIOS / "ten_minutes.toml",
                           set={"readout.adc_bits": 32})
    run = bg.run(scenario)
    ambient = float(run.true_ambient_temperature[0])
    gyro = scenario.device.with_({"readout.adc_bits": 32}).start(
        seed=scenario.seed, noise_rate_Hz=scenario.output_rate_Hz,
        ambient=ambient)
    rates = [gyro.now().rate]
    for _ in range(999):
        rates.append(gyro.step(dt=1 / scenario.output_rate_Hz).rate)
    np.testing.assert_allclose(rates, run.rate[:1000], atol=5e-6)


def test_inputs_stay_and_run_along_lines(device):
    gyro = device.start(noise=False)
    for _ in range(30):
        out = gyro.step(rate=20.0, dt=0.1)
    held = gyro.step(dt=0.1)
    assert held.truth.true_rate == 20.0
    assert out.rate == pytest.approx(20.5, abs=0.2)
    end = gyro.step(rate=(20.0, -10.0), ambient=(25.0, 26.0), dt=0.1)
    assert end.truth.true_rate == pytest.approx(-10.0)
    assert end.truth.true_ambient_temperature == pytest.approx(26.0)
    assert gyro.step(dt=0.1).truth.true_rate == pytest.approx(-10.0)
    off = gyro.step(dt=0.1, powered=False)
    assert math.isnan(off.rate) and off.status == 1
    assert math.isfinite(off.truth.true_bias)
    assert gyro.step(dt=0.1).status == 1


def test_snapshots_go_on_alike(device):
    gyro = device.start(seed=4, temperature_degC=10.0, age_hours=100.0)
    for k in range(20):
        gyro.step(rate=float(k), dt=0.01)
    others = [copy.copy(gyro), copy.deepcopy(gyro),
              pickle.loads(pickle.dumps(gyro))]
    again = device.start(seed=4, temperature_degC=10.0, age_hours=100.0)
    again.restore(gyro.state())
    for k in range(20):
        expected = gyro.step(rate=-float(k), dt=0.02)
        for other in (*others, again):
            assert same(other.step(rate=-float(k), dt=0.02), expected)
    with pytest.raises(ValueError, match="no state of this device"):
        device.start(seed=5).restore(gyro.state())


def test_advance_is_step_after_step(device):
    rate = 30 * np.sin(np.arange(200) / 9)
    one, all_at_once = (device.start(seed=2) for _ in range(2))
    run = all_at_once.advance({"rate": rate, "ambient": 30.0}, dt=0.01)
    samples = [one.step(rate=r, ambient=30.0, dt=0.01) for r in rate]
    for name in MEASURED:
        assert [getattr(s, name) for s in samples] == run[name].values.tolist()
    assert [s.truth.true_bias for s in samples] == run.true_bias.values.tolist()
    assert same(one.now(), all_at_once.now())
    assert run.beamgyro is not None
    line = device.start(seed=2)
    by_lines = line.advance({"rate": rate}, dt=0.01, linear=True)
    assert by_lines.true_rate.values.tolist() == pytest.approx(rate.tolist())


def test_step_all_is_each_step(device):
    gyros = [device.start(seed=k) for k in range(70)]
    alone = [copy.copy(gyro) for gyro in gyros]
    rates = np.linspace(-50, 50, len(gyros))
    for jobs in (1, 2, 0):
        out = bg.step_all(gyros, rate=(rates, -rates), ambient=20.0, dt=0.01,
                          jobs=jobs)
        expected = [one.step(rate=(r, -r), ambient=20.0, dt=0.01)
                    for one, r in zip(alone, rates)]
        for name in (*MEASURED, "time", "status"):
            assert out[name].tolist() == [getattr(s, name) for s in expected]
        assert out["true_bias"].tolist() == [
            s.truth.true_bias for s in expected]
    rates[33] = math.nan
    before = [gyro.state() for gyro in gyros]
    with pytest.raises(ValueError, match="gyro 33"):
        bg.step_all(gyros, rate=rates, dt=0.01)
    assert [gyro.state() for gyro in gyros] == before


BAD_STEPS = [
    ({}, "dt"), ({"dt": 0.0}, "duration"), ({"dt": -1.0}, "duration"),
    ({"dt": math.nan}, "duration"), ({"dt": math.inf}, "duration"),
    ({"dt": 2e5}, "duration"), ({"dt": "0.1"}, "dt"), ({"dt": None}, "dt"),
    ({"dt": True}, "dt"), ({"dt": [0.1]}, "dt"),
    ({"dt": 0.1, "rate": math.nan}, "rate"),
    ({"dt": 0.1, "rate": math.inf}, "rate"),
    ({"dt": 0.1, "rate": 1e9}, "rate"), ({"dt": 0.1, "rate": "1"}, "rate"),
    ({"dt": 0.1, "rate": ()}, "rate"), ({"dt": 0.1, "rate": (1.0,)}, "rate"),
    ({"dt": 0.1, "rate": (1.0, 2.0, 3.0)}, "rate"),
    ({"dt": 0.1, "rate": (1.0, None)}, "rate"),
    ({"dt": 0.1, "rate": (1.0, math.nan)}, "rate"),
    ({"dt": 0.1, "rate": 1j}, "rate"), ({"dt": 0.1, "rate": False}, "rate"),
    ({"dt": 0.1, "rate": {}}, "rate"),
    ({"dt": 0.1, "rate": np.zeros(3)}, "rate"),
    ({"dt": 0.1, "cross_rate_x": math.nan}, "rate"),
    ({"dt": 0.1, "cross_rate_y": 1e5}, "rate"),
    ({"dt": 0.1, "acceleration_x": math.nan}, "acceleration"),
    ({"dt": 0.1, "acceleration_y": 1e9}, "acceleration"),
    ({"dt": 0.1, "acceleration_z": "g"}, "acceleration"),
    ({"dt": 0.1, "ambient": 151.0}, "ambient"),
    ({"dt": 0.1, "ambient": -101.0}, "ambient"),
    ({"dt": 0.1, "ambient": math.nan}, "ambient"),
    ({"dt": 0.1, "ambient": 298.15}, "ambient"),
    ({"dt": 0.1, "powered": 1}, "powered"),
    ({"dt": 0.1, "powered": "on"}, "powered"),
    ({"dt": 0.1, "speed": 1.0}, "speed"),
]


@pytest.mark.parametrize("arguments, words", BAD_STEPS)
def test_a_bad_step_changes_nothing(device, arguments, words):
    gyro = device.start(seed=1)
    gyro.step(dt=0.1, rate=3.0)
    before = gyro.state()
    with pytest.raises((ValueError, TypeError), match=words):
        gyro.step(**arguments)
    assert gyro.state() == before


@pytest.mark.parametrize("arguments, words", [
    ({"seed": -1}, "seed"), ({"seed": 1.5}, "seed"),
    ({"noise_rate_Hz": -1.0}, "noise"), ({"noise_rate_Hz": math.nan}, "noise"),
    ({"noise_rate_Hz": 1e9}, "noise"), ({"temperature_degC": 200.0}, "degC"),
    ({"temperature_degC": "hot"}, "temperature"),
    ({"fidelity": "carrier"}, "fidelity"), ({"fidelity": 1}, "fidelity"),
    ({"age_hours": -1.0}, "age"), ({"ambient": math.nan}, "ambient"),
    ({"history": [(-10.0, 20.0), (-1.0, 20.0)]}, "history"),
    ({"rate": math.inf}, "rate"), ({"heat": 1.0}, "heat"),
])
def test_a_bad_start_is_refused(device, arguments, words):
    with pytest.raises((ValueError, TypeError), match=words):
        device.start(**arguments)


@pytest.mark.parametrize("inputs, words", [
    ({}, "no input is an array"), ({"rate": 1.0}, "no input is an array"),
    ({"rate": []}, "at least 1"), ({"rate": [1.0], "ambient": [1.0, 2.0]},
                                   "ambient has 2"),
    ({"speed": [1.0]}, "speed"), ({"rate": ["a"]}, "rate"),
    ({"rate": [[1.0]]}, "dimensions"), ({"rate": [1.0, math.nan]}, "step 1"),
])
def test_a_bad_series_changes_nothing(device, inputs, words):
    gyro = device.start(seed=1)
    before = gyro.state()
    with pytest.raises(ValueError, match=words):
        gyro.advance(inputs, dt=0.1)
    assert gyro.state() == before


def test_gyros_in_threads(device):
    def work(seed, out):
        gyro = device.start(seed=seed)
        for k in range(2000):
            gyro.step(rate=float(k % 50), dt=0.01)
        out[seed] = gyro.state()
    together, alone = {}, {}
    threads = [threading.Thread(target=work, args=(k, together))
               for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for seed in range(4):
        work(seed, alone)
    assert together == alone
