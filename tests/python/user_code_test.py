# SPDX-License-Identifier: MIT
"""Functions, estimators and networks of users that answer oddly."""

import threading
import time

import numpy as np
import pytest

import beamgyro as bg
from program import SCENARIOS


@pytest.fixture(scope="module", name="run")
def make_run():
    """Two powered stretches of 20 s and 30 s, ten samples a second."""
    return bg.run(SCENARIOS / "warm_up.toml", set={
        "duration_s": 60, "power.on_s": [0.0, 30.0], "power.off_s": [20.0]})


def compensated(function, run, **options):
    return bg.compensate(bg.Compensator(function, **options),
                         run).compensated_rate.values


@pytest.mark.parametrize("answer", [
    lambda rate: rate.values.tolist(),
    lambda rate: rate.to_series(),
    lambda rate: rate.to_series().reset_index().rate,
    lambda rate: rate.to_series().set_axis(range(rate.size, 0, -1)),
    lambda rate: rate.to_series().set_axis(2 * list(range(rate.size // 2))),
    lambda rate: rate.to_series().astype("Float64"),
    lambda rate: rate.values[:, None],
    lambda rate: np.repeat(rate.values, 2)[::2],
    lambda rate: np.broadcast_to(rate.values, (1, rate.size))[0],
    lambda rate: rate.values.astype(">f8"),
    lambda rate: (rate.values, None),
])
def test_every_array_of_the_rates_is_the_same_answer(run, answer):
    found = compensated(lambda signals: answer(signals.rate), run)
    np.testing.assert_array_equal(found, run.rate)


def test_whole_numbers_are_rates(run):
    found = compensated(lambda signals: np.ones(signals.rate.size, int), run)
    np.testing.assert_array_equal(np.unique(found[~np.isnan(found)]), 1.0)


@pytest.mark.parametrize("answer, words", [
    (lambda rate: rate.values * 1j, "complex"),
    (lambda rate: rate.values > 0, "true and false"),
    (lambda rate: rate.values.astype(str), "texts"),
    (lambda rate: rate.values.astype(object), "object"),
    (lambda rate: (one for one in rate.values), "generator"),
    (lambda rate: None, "NoneType"),
    (lambda rate: 0.0, "one dimension"),
    (lambda rate: rate.values[None, :], "shape"),
    (lambda rate: np.column_stack([rate, rate]), "shape"),
    (lambda rate: [rate.values, rate.values], "shape"),
    (lambda rate: [[1.0], [1.0, 2.0]], "object"),
    (lambda rate: np.ma.masked_less(rate.values, np.inf), "masked"),
    (lambda rate: (rate, rate, rate), "tuple of 3"),
    (lambda rate: (rate, 1.0), "one dimension"),
    (lambda rate: rate[::-1], "times"),
    (lambda rate: rate.to_series()[::-1], "times"),
    (lambda rate: rate.to_series().reset_index().rate[::-1], "the index"),
    (lambda rate: rate.to_series().astype("Float64").mask(rate.values > 0),
     "missing"),
])
def test_what_is_no_rate_of_each_sample_is_refused(run, answer, words):
    def odd(signals):
        return answer(signals.rate)

    with pytest.raises(ValueError, match=f"answer of odd.*{words}"):
        bg.compensate(odd, run)


@pytest.mark.parametrize("answer", [
    lambda rate: rate * np.nan,
    lambda rate: rate * np.inf,
    lambda rate: rate * 1e300,
    lambda rate: rate[:-1],
    lambda rate: np.r_[rate.values, 0.0],
])
def test_answers_that_are_no_numbers_or_of_another_length_fail(run, answer):
    with pytest.raises(RuntimeError, match="answer|finite|1e[+]12"):
        compensated(lambda signals: answer(signals.rate), run)


@pytest.mark.parametrize("arrays", [False, True])
def test_a_function_may_write_into_what_it_is_given(run, arrays):
    before = run.copy(deep=True)

    def spoil(signals):
        rate = np.array(signals["rate"])
        for name in ("rate", "temperature", "status"):
            np.asarray(signals[name])[:] = 0
        return rate

    np.testing.assert_array_equal(
        compensated(spoil, run, arrays=arrays, name="spoil"), run.rate)
    assert run.identical(before)
    kept = bg.validate(lambda signals: signals.rate, run)
    spoilt = bg.validate(bg.Compensator(spoil, arrays=arrays, name="spoil"),
                         run)
    assert spoilt.metrics == kept.metrics


def test_an_estimator_may_write_into_its_rows(run):
    class Spoiler:
        def predict(self, rows):
            answer = rows[:, 0] * 0.5
            rows[:] = 0
            return answer

    answer = bg.compensate(Spoiler(), run)
    np.testing.assert_array_equal(
        answer.compensated_rate, run.rate - 0.5 * run.temperature)


def test_a_network_keeps_which_modules_are_trained(run):
    torch = pytest.importorskip("torch")
    network = torch.nn.Sequential(
        torch.nn.Linear(1, 4), torch.nn.Dropout(0.5),
        torch.nn.BatchNorm1d(4), torch.nn.Linear(4, 1))
    network.train()
    network[2].eval()  # frozen, as transfer learning does
    before = [module.training for module in network.modules()]
    statistics = network[2].running_mean.clone()
    first, second = compensated(network, run), compensated(network, run)
    np.testing.assert_array_equal(first, second)  # no dropout
    assert [module.training for module in network.modules()] == before
    assert torch.equal(network[2].running_mean, statistics)

    class Broken(torch.nn.Module):
        def __init__(self):
            super().__init__()
            self.inner = network

        def forward(self, rows):
            raise OSError("no answer")

    broken = Broken()
    broken.inner.train()
    broken.inner[2].eval()
    before = [module.training for module in broken.modules()]
    with pytest.raises(OSError, match="no answer"):
        compensated(broken, run)
    assert [module.training for module in broken.modules()] == before


def test_a_tensor_that_requires_a_gradient_is_an_answer(run):
    torch = pytest.importorskip("torch")
    found = compensated(lambda signals: torch.tensor(
        signals.rate.values, requires_grad=True), run)
    np.testing.assert_array_equal(found, run.rate)
    with pytest.raises(ValueError, match="torch.sparse"):
        bg.compensate(lambda signals: torch.zeros(
            signals.rate.size).to_sparse(), run)


@pytest.mark.parametrize("options, words", [
    ({"inputs": [1]}, r"inputs \[1\]"),
    ({"stall_s": -1}, "stall_s -1"),
    ({"stall_s": float("nan")}, "stall_s nan"),
])
def test_what_a_compensator_is_made_with_is_checked(options, words):
    with pytest.raises(ValueError, match=words):
        bg.Compensator(lambda signals: signals.rate, **options)


@pytest.mark.parametrize("inputs, is_right", [
    (["temperature", "since_power_on(5)"], True),
    (["since_power_on(5)", "temperature"], False),
    (["rate", "temperature"], False),
    (["temperature"], False),
])
def test_inputs_are_those_that_an_estimator_was_fitted_to(run, inputs,
                                                          is_right):
    class Fitted:
        feature_names_in_ = np.array(["temperature", "since_power_on(5)"],
                                     dtype=object)

        def predict(self, rows):
            return rows["temperature"].to_numpy() * 0.5

    if not is_right:
        with pytest.raises(ValueError, match="Fitted was fitted to"):
            bg.Compensator(Fitted(), inputs=inputs)
        return
    np.testing.assert_array_equal(
        compensated(Fitted(), run, inputs=inputs),
        run.rate - 0.5 * run.temperature)


def test_names_that_are_no_inputs_are_told_by_their_order(run):
    class Fitted:
        feature_names_in_ = ["T", "age"]

        def predict(self, rows):
            return rows["T"].to_numpy() * 0.5

    np.testing.assert_array_equal(
        compensated(Fitted(), run,
                    inputs=["temperature", "since_power_on(5)"]),
        run.rate - 0.5 * run.temperature)


def test_an_estimator_names_its_features_in_a_sequence():
    class Named:
        beamgyro_inputs = "temperature"

        def predict(self, rows):
            return rows[:, 0]

    with pytest.raises(ValueError, match="beamgyro_inputs 'temperature'"):
        bg.Compensator(Named())
    with pytest.raises(ValueError, match="inputs: is empty"):
        bg.Compensator(Named(), inputs=[])


def several(run):
    """Runs that differ, which several threads answer at once."""
    return {f"run {k}": run.assign(rate=run.rate + k).assign_attrs(seed=k)
            for k in range(4)}


def test_a_function_is_called_by_one_thread_at_a_time(run):
    inside, most, threads = [], [], set()

    def slow(signals):
        inside.append(1)
        most.append(len(inside))
        threads.add(threading.get_ident())
        time.sleep(0.01)
        inside.pop()
        return signals.rate

    bg.validate(slow, several(run), jobs=4)
    assert len(threads) > 1
    assert max(most) == 1


def test_threads_change_nothing_of_a_network(run):
    torch = pytest.importorskip("torch")
    torch.manual_seed(1)
    network = torch.nn.Sequential(
        torch.nn.Linear(1, 4), torch.nn.Dropout(0.5), torch.nn.Linear(4, 1))
    network.train()  # as training leaves it
    first, second = (bg.validate(network, several(run), jobs=jobs).to_json()
                     for jobs in (1, 4))
    assert first == second
    assert all(module.training for module in network.modules())


def test_a_compensator_may_not_ask_for_its_own_answer(run):
    def again(signals):
        return bg.compensate(itself, run).compensated_rate.values

    itself = bg.Compensator(again)
    with pytest.raises(ValueError, match="again: its answer asks for its own"):
        bg.compensate(itself, run)

    def anew(signals):
        return bg.compensate(anew, run).compensated_rate.values

    with pytest.raises(ValueError, match="anew: 16 compensators wait"):
        bg.compensate(anew, run)


def test_compensators_may_ask_each_other(run):
    half = bg.Compensator(lambda signals: 0.5 * signals.rate)
    found = compensated(
        lambda signals: bg.compensate(half, run).compensated_rate.sel(
            time=signals.time), run)
    np.testing.assert_array_equal(found, 0.5 * run.rate)
