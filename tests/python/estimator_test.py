# SPDX-License-Identifier: MIT
"""The program's methods as estimators of scikit-learn."""

import numpy as np
import pytest

import beamgyro as bg

from program import SCENARIOS

CUBIC = SCENARIOS / "models/cubic.toml"


def samples(runs):
    """Time and temperature of runs, and their biases, every minute."""
    parts = [run.isel(time=slice(None, None, 60)) for run in runs]
    return (np.concatenate([np.c_[part.time, part.temperature]
                            for part in parts]),
            np.concatenate([part.rate - part.true_rate for part in parts]))


def test_it_predicts_what_the_compensator_takes_away(sweeps):
    X, y = samples(sweeps[:1])
    model = bg.Estimator(CUBIC).fit(X, y)
    answer = bg.compensate(model.compensator_, sweeps[1])
    taken = (answer.rate - answer.compensated_rate).values
    X_test = np.c_[sweeps[1].time, sweeps[1].temperature]
    np.testing.assert_allclose(model.predict(X_test), taken, atol=1e-12)
    # A cubic of least squares, of the same samples.
    expected = np.polynomial.Polynomial.fit(X[:, 1], y, 3)(X[:, 1])
    np.testing.assert_allclose(model.predict(X), expected, atol=1e-9)
    assert model.score(X, y) == pytest.approx(
        1 - np.var(y - expected) / np.var(y), abs=1e-9)


def test_a_shipped_model_is_called_by_its_name(sweeps):
    X, y = samples(sweeps[:2])
    by_name = bg.Estimator("cubic", seed=3).fit(X, y)
    by_file = bg.Estimator(CUBIC, seed=3).fit(X, y)
    np.testing.assert_array_equal(by_name.predict(X), by_file.predict(X))
    assert by_name.compensator_.text == by_file.compensator_.text
    with pytest.raises(ValueError, match="models/quintic.toml"):
        bg.Estimator("quintic").fit(X, y)


def test_scikit_learn_copies_searches_and_holds_out_runs(sweeps):
    pytest.importorskip("sklearn")
    from sklearn.base import clone
    from sklearn.model_selection import GridSearchCV, cross_val_score
    from sklearn.pipeline import make_pipeline
    X, y = samples(sweeps)
    model = clone(make_pipeline(bg.Estimator("cubic")))
    scores = cross_val_score(model, X, y, cv=bg.RunSplit())
    assert len(scores) == len(sweeps) and min(scores) > 0.5
    search = GridSearchCV(bg.Estimator(), {"model": ["constant", "cubic"]},
                          cv=bg.RunSplit()).fit(X, y)
    assert search.best_params_ == {"model": "cubic"}


def test_runs_are_split_where_the_time_does_not_increase(sweeps):
    X, _ = samples(sweeps)
    size = len(X) // len(sweeps)
    splitter = bg.RunSplit()
    assert splitter.get_n_splits(X) == len(sweeps)
    for number, (fitted, held_out) in enumerate(splitter.split(X)):
        assert held_out.tolist() == list(range(number * size,
                                               (number + 1) * size))
        assert sorted([*fitted, *held_out]) == list(range(len(X)))
    with pytest.raises(ValueError, match="X: holds one run"):
        list(splitter.split(X[:size]))


def test_columns_of_a_table_have_their_names(sweeps):
    pandas = pytest.importorskip("pandas")
    X, y = samples(sweeps[:1])
    table = pandas.DataFrame(X, columns=["time", "temperature"])
    by_name = bg.Estimator(CUBIC).fit(table[["temperature", "time"]], y)
    np.testing.assert_array_equal(by_name.predict(table),
                                  bg.Estimator(CUBIC).fit(X, y).predict(X))


@pytest.mark.parametrize("call, words", [
    (lambda X, y: bg.Estimator(CUBIC).predict(X), "is not fitted"),
    (lambda X, y: bg.Estimator(CUBIC).fit(X, y[:5]), "y: holds 5 biases"),
    (lambda X, y: bg.Estimator(CUBIC).fit(X[:, :1], y), "X: has the shape"),
    (lambda X, y: bg.Estimator(CUBIC, columns=["time", "pressure"]).fit(X, y),
     "columns .*: expected temperature, and others of time"),
    (lambda X, y: bg.Estimator().set_params(degree=3), "degree: is no param"),
    (lambda X, y: bg.Estimator({"kind": "x"}).fit(X, y), "kind")])
def test_what_is_wrong_is_named(sweeps, call, words):
    X, y = samples(sweeps[:1])
    with pytest.raises(ValueError, match=words):
        call(X, y)


def test_legs_are_held_out_as_training_counts_them():
    up = np.concatenate([np.linspace(0, 10, 50), np.linspace(10, 0, 30)])
    time = np.arange(80.0)
    X = np.c_[np.concatenate([time, time[:50]]),
              np.concatenate([up, up[:50]])]
    parts = [held_out for _, held_out in bg.LegSplit().split(X)]
    assert bg.LegSplit().get_n_splits(X) == 3
    # the turn belongs to the first leg, the second run is a leg of its own
    assert [(part[0], part[-1]) for part in parts] == [
        (0, 50), (51, 79), (80, 129)]
    for fitted, held_out in bg.LegSplit().split(X):
        assert sorted([*fitted, *held_out]) == list(range(130))
    swapped = bg.LegSplit(time=1, temperature=0).split(X[:, ::-1])
    assert [held_out.tolist() for _, held_out in swapped] == [
        part.tolist() for part in parts]
    with pytest.raises(ValueError, match="holds one leg"):
        list(bg.LegSplit().split(X[:50]))
