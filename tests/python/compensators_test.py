# SPDX-License-Identifier: MIT
"""Compensators of Python: functions, estimators, networks."""

import pickle
import shutil

import numpy as np
import pytest

import beamgyro as bg
import qualified
from program import SCENARIO, SCENARIOS, ramp

CUBIC = SCENARIOS / "models/cubic.toml"
TWO_CYCLES = {"power.on_s": [0.0, 8000.0], "power.off_s": [6000.0]}


def test_a_function_sees_measured_signals_of_one_powered_stretch(sweep_keys):
    run = bg.run(sweep_keys, set=TWO_CYCLES)
    seen = []

    def nothing(signals):
        seen.append(signals)
        return signals.rate

    answer = bg.compensate(nothing, run)
    assert len(seen) == 2
    for signals in seen:
        assert "true_rate" not in signals.variables
        assert "true_beam_temperature" not in signals.variables
        assert not np.isnan(signals.rate).any()
        assert all(variable.attrs["role"] == "measured"
                   for variable in signals.variables.values())
        assert "device" not in str(signals.encoding.get("beamgyro", {})
                                   ).replace("'device': ''", "")
    np.testing.assert_array_equal(answer.compensated_rate, run.rate)


def test_a_function_may_take_arrays_and_state_a_sigma(sweeps):
    def known(signals):
        return signals["rate"] - 1.0, np.full(signals["rate"].size, 0.5)

    compensator = bg.Compensator(known, inputs=["rate"], arrays=True,
                                 name="one less")
    answer = bg.compensate(compensator, sweeps[0])
    np.testing.assert_array_equal(answer.compensated_rate,
                                  sweeps[0].rate - 1.0)
    assert (answer.compensated_rate_sigma == 0.5).all()
    assert answer.attrs["compensator"] == "one less"


def test_the_exception_of_a_function_reaches_the_caller(sweeps):
    def broken(signals):
        return signals["gyro"]

    with pytest.raises(KeyError, match="gyro"):
        bg.compensate(broken, sweeps[0])
    with pytest.raises(KeyError, match="gyro"):
        bg.validate(broken, sweeps[0])


def test_too_few_answers_are_an_error(sweeps):
    with pytest.raises(RuntimeError, match="answers"):
        bg.compensate(lambda signals: signals.rate[:5], sweeps[0])


def test_an_estimator_does_what_the_cubic_does(sweeps):
    pipeline = pytest.importorskip("sklearn.pipeline")
    from sklearn.linear_model import LinearRegression
    from sklearn.preprocessing import PolynomialFeatures
    rows, labels = bg.training_rows(sweeps[0])
    estimator = pipeline.make_pipeline(PolynomialFeatures(3),
                                       LinearRegression())
    estimator.fit(rows, labels)
    mine = bg.compensate(estimator, sweeps[1])
    cubic = bg.compensate(bg.train(CUBIC, sweeps[0]), sweeps[1])
    # Both are least squares of the same rows; the program averages them over
    # blocks, which moves the curve by much less than the drift of degrees.
    difference = mine.compensated_rate - cubic.compensated_rate
    drift = np.ptp(labels)
    assert abs(difference).max() < 0.02 * drift


def test_it_keeps_the_name_that_it_is_saved_under(sweeps, tmp_path):
    trained = bg.train(CUBIC, sweeps[0])
    text = trained.text
    trained.save(tmp_path / "my_gyro.json")
    assert trained.name == "my_gyro.json" and trained.text == text
    assert trained == bg.Compensator(tmp_path / "my_gyro.json")
    assert "my_gyro.json" in str(bg.validate(trained, sweeps[1]))
    bg.export(trained, "c", tmp_path / "firmware")
    assert (tmp_path / "firmware/my_gyro.c").exists()


def test_rows_are_of_locked_samples_of_one_power_on():
    run = bg.run(SCENARIOS / "warm_up.toml", set={
        "fidelity": "envelope", "duration_s": 130, "output_rate_Hz": 100,
        "power": {"on_s": [0.0, 71.0], "off_s": [40.0]}})
    status = run.status.values
    assert {0, 1, 4} <= set(status.tolist())  # also unpowered and unlocked
    rows, labels = bg.training_rows(run)
    good = status == 0
    np.testing.assert_array_equal(
        labels, (run.rate - run.true_rate).values[good])
    np.testing.assert_array_equal(rows[:, 0], run.temperature.values[good])
    assert abs(labels).max() < 5  # it is 74 deg/s while the loops lock
    # Blocks of 20 s are counted from each power-on: 2 of the first, and of the
    # second 2 whole ones and one of 19 s, which is more than half full.
    rows, labels = bg.training_rows(run, every_s=20)
    assert len(labels) == 2 + 3
    time = run.time.values
    for number, (begin, end) in enumerate([
            (0, 20), (20, 40), (71, 91), (91, 111), (111, 130)]):
        inside = good & (time >= begin) & (time < end)
        assert labels[number] == pytest.approx(
            float((run.rate - run.true_rate).values[inside].mean()))
    # Blocks of 30 s: the rest of 10 s of the first is less than half full.
    assert len(bg.training_rows(run, every_s=30)[1]) == 1 + 2


def test_an_estimator_is_given_the_features_that_it_was_fitted_to(sweeps):
    pytest.importorskip("sklearn")
    import pandas as pd
    from sklearn.linear_model import LinearRegression
    names = ["temperature", "temperature_lowpass(100)"]
    rows, labels = bg.training_rows(sweeps[0], names, every_s=60)
    estimator = LinearRegression().fit(pd.DataFrame(rows, columns=names),
                                       labels)
    answer = bg.compensate(estimator, sweeps[1])
    expected = sweeps[1].rate - estimator.predict(
        pd.DataFrame(bg.features(sweeps[1], names), columns=names))
    np.testing.assert_array_equal(answer.compensated_rate, expected)


def test_a_torch_module_is_a_compensator(sweeps):
    torch = pytest.importorskip("torch")

    class Line(torch.nn.Module):
        beamgyro_inputs = ["temperature"]

        def __init__(self):
            super().__init__()
            self.slope = torch.nn.Parameter(torch.tensor(0.25))

        def forward(self, rows):
            return self.slope * rows

    answer = bg.compensate(Line(), sweeps[0])
    expected = sweeps[0].rate - 0.25 * sweeps[0].temperature
    # The network computes in single precision, of temperatures up to 50.
    np.testing.assert_allclose(answer.compensated_rate, expected, atol=4e-6)


def test_validation_of_a_function_prints_and_shows(sweeps):
    trained = bg.train(CUBIC, [sweeps[0], sweeps[2]])  # one tells no sigma

    def the_same(signals):
        own = bg.compensate(trained, signals)
        return own.compensated_rate

    result = bg.validate(the_same, sweeps[1], full_scale=150)
    native = bg.validate(trained, sweeps[1], full_scale=150)
    # The trained one states a sigma, which has metrics of its own.
    assert result.metrics.keys() < native.metrics.keys()
    name = next(iter(result.metrics))
    assert result.metrics[name]["after"] == native.metrics[name]["after"]
    assert "residual_rms_deg_per_s" in result._repr_html_()
    assert result.verdict in ("pass", "fail", "undecided")
    assert result.passed == (result.verdict == "pass")
    assert str(result)


def test_a_trained_compensator_pickles_by_its_text(sweeps, tmp_path):
    trained = bg.train(CUBIC, sweeps[0])
    twin = pickle.loads(pickle.dumps(trained))
    assert twin == trained
    trained.save(tmp_path / "c.json")
    assert bg.Compensator(tmp_path / "c.json") == trained
    low, high = trained.temperature_range
    assert -40 < low < high < 60


def test_export_writes_what_it_returns(sweeps, tmp_path):
    trained = bg.train(CUBIC, sweeps[0])
    files = bg.export(trained, "c", tmp_path, name="cubic")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()
            } == files
    with pytest.raises(ValueError, match="colour"):
        bg.export(trained, "c", colour="red")


def test_a_stretch_of_a_recording_keeps_what_it_is(sweeps):
    part = sweeps[0].isel(time=slice(0, 4000))
    answer = bg.compensate(bg.train(CUBIC, sweeps[0]), part)
    assert answer.sizes["time"] == 4000


def test_other_units_are_refused(sweeps):
    other = sweeps[0].copy()
    other.rate.attrs["units"] = "rad/s"
    with pytest.raises(ValueError, match="rate: units"):
        bg.compensate(bg.train(CUBIC, sweeps[0]), other)


def short_qualification(folder):
    """A device and the qualification that it goes through."""
    for name, text in {"short.toml": qualified.SHORT, "ramp.toml": ramp(),
                       "warm_up.toml": SCENARIO}.items():
        (folder / name).write_text(text)
    shutil.copy(SCENARIOS / "devices/nominal.toml", folder / "device.toml")
    return {"device": bg.Device(folder / "device.toml"),
            "qualification": folder / "short.toml"}


def test_a_model_is_trained_and_judged_on_a_simulated_device(tmp_path):
    on = short_qualification(tmp_path)
    device = on["device"]
    limits = {"limits": {"residual_rms_deg_per_s":
                         {"max": 0.1, "source": "a test"}}, "name": "own"}
    shares = []
    result = bg.validate(CUBIC, spec=limits, progress=shares.append, **on)
    assert "residual_rms_deg_per_s" in result.metrics
    assert all(0 <= share <= 1 for share in shares)
    (tmp_path / "old.json").write_text(result.to_json())
    result.trained.save(tmp_path / "own.json")
    again = bg.validate(result.trained, device=device, spec=limits,
                        qualification=tmp_path / "short.toml",
                        against=tmp_path / "own.json",
                        baseline_result=tmp_path / "old.json")
    assert again.metrics == result.metrics and again.trained is None
    assert again.to_junit().startswith("<?xml")
    assert "do not tell" in again.data["against"]["sentence"]
    assert again.data["baseline"]["worse"] is False
    with pytest.raises(ValueError, match="one of"):
        bg.validate(CUBIC, "a.h5", device=device)


def test_the_runs_of_a_device_are_drawn_from_a_seed(tmp_path):
    on = short_qualification(tmp_path)
    drawn = bg.validate(CUBIC, seed="random", **on).data
    seed = drawn["provenance"]["seed"]
    assert bg.validate(CUBIC, seed=np.int64(seed), **on).data == drawn
    assert bg.validate(CUBIC, **on).data["runs"] != drawn["runs"]
    over = bg.validate(CUBIC, seed=seed, seeds=3, **on).data["seeds"]
    assert [one["seed"] for one in over["verdicts"]] == [seed, seed + 1,
                                                         seed + 2]


def test_runs_in_memory_that_were_fitted_are_no_unseen_runs(sweeps):
    trained = bg.train(CUBIC, sweeps[0])
    result = bg.validate(trained, sweeps[0], full_scale=150)
    assert result.verdict == "fail"
    assert result.checks["hold_out"]["passed"] is False


@pytest.mark.parametrize("sigma", [-1.0, 0.0, np.nan, np.inf])
def test_a_sigma_is_above_0(sweeps, sigma):
    def stating(signals):
        return signals.rate.values, np.full(signals.sizes["time"], sigma)
    with pytest.raises(ValueError, match="stating: gave a sigma of"):
        bg.compensate(stating, sweeps[0])
