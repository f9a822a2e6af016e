# SPDX-License-Identifier: MIT
"""The methods of the program as estimators of scikit-learn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Union

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy, _shipped
from beamgyro._checks import Path
from beamgyro._compensation import Compensator, compensate
from beamgyro._dataset import recording_of
from beamgyro._training import train

Array = np.ndarray[Any, Any]

# Beside temperatures; the columns are measured variables of recordings.
_UNITS = {"time": "s", "temperature": "degC", "drive_frequency": "Hz",
          "quadrature": "degree/s", "drive_voltage": "V"}
_STEP_S = 60.0  # between samples that state no time


class Estimator:
    """A method of the program that predicts the bias, for scikit-learn.

    It has what pipelines, searches and cross-validation ask for, and needs no
    scikit-learn itself. Where the column ``time`` does not increase, another
    run begins.

    >>> model = bg.Estimator("recommended", columns=["time", "temperature"])
    >>> model.fit(X, y).compensator_.save("mine.json")

    Args:
        model: the name of a shipped model, such as "recommended" or "cubic";
            a model file; or its contents as a nested mapping.
        columns: what the columns of X are: "time" [s], "temperature" [degC],
            "drive_frequency" [Hz], "quadrature" [degree/s] or "drive_voltage"
            [V]. Of a table of pandas its names count.
        seed: of the initial weights of a network.

    Attributes:
        compensator_: after `fit`, the trained compensator.
    """

    _estimator_type = "regressor"

    def __init__(self, model: Union[Path, Mapping[str, Any]] = "recommended",
                 columns: Sequence[str] = ("time", "temperature"),
                 seed: int = 0) -> None:
        # As they are: scikit-learn compares them when it copies.
        self.model = model
        self.columns = columns
        self.seed = seed

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """Return the arguments that it was made with."""
        del deep
        return {"model": self.model, "columns": self.columns,
                "seed": self.seed}

    def set_params(self, **parameters: Any) -> Estimator:
        """Replace arguments that it was made with.

        Raises:
            ValueError: there is no such argument.
        """
        for name, value in parameters.items():
            if name not in self.get_params():
                raise ValueError(f"{name}: is no parameter; expected one of "
                                 f"{', '.join(self.get_params())}")
            setattr(self, name, value)
        return self

    def fit(self, X: Any, y: Any) -> Estimator:
        """Train on samples and their biases [degree/s].

        Raises:
            ValueError: something is wrong in the model or the samples, or
                these do not suffice.
        """
        columns = self._columns_of(X)
        _arguments.require_unit(y, "y", "degree/s")
        bias = _arguments.numbers(y, "y")
        if len(bias) != len(columns["time"]):
            raise ValueError(f"y: holds {len(bias)} biases; expected "
                             f"{len(columns['time'])}, one for each row of X")
        runs = {f"run {number}": _recording(columns, part, bias)
                for number, part in enumerate(_runs(columns["time"]), 1)}
        self.compensator_: Compensator = train(
            _model_file(self.model), runs, seed=self.seed)
        self.n_features_in_ = len(columns)
        return self

    def predict(self, X: Any) -> Array:
        """Return the bias of each row [degree/s]."""
        if not hasattr(self, "compensator_"):
            raise ValueError("Estimator: is not fitted; expected fit(X, y) "
                             "before predict(X)")
        columns = self._columns_of(X)
        nothing = np.zeros(len(columns["time"]))
        # Of a rate of 0 the compensator leaves what it takes for the bias.
        return np.concatenate([-compensate(
            self.compensator_, _recording(columns, part, nothing)
        ).compensated_rate.values for part in _runs(columns["time"])])

    def score(self, X: Any, y: Any) -> float:
        """Return the share of the variance of `y` that is predicted, R^2."""
        bias = _arguments.numbers(y, "y")
        left = np.sum((bias - self.predict(X)) ** 2)
        return float(1 - left / np.sum((bias - bias.mean()) ** 2))

    def _columns_of(self, X: Any) -> dict[str, Array]:
        names = _checks.some_texts(
            list(X.columns) if hasattr(X, "columns") else self.columns,
            "columns")
        unknown = [name for name in names if name not in _UNITS]
        if unknown or "temperature" not in names:
            raise ValueError(f"columns {names!r}: expected temperature, and "
                             f"others of {', '.join(_UNITS)}")
        values = np.asarray(X, dtype=np.float64)
        if values.ndim != 2 or values.shape[1] != len(names):
            raise ValueError(f"X: has the shape {values.shape}; expected a "
                             f"column for each of {', '.join(names)}")
        found = dict(zip(names, values.T))
        found.setdefault("time", _STEP_S * np.arange(len(values)))
        return found


class RunSplit:
    """Holds out each run in turn: a splitter for cross-validation.

    >>> cross_val_score(bg.Estimator("cubic"), X, y, cv=bg.RunSplit())

    Samples of one run are alike: a split within runs tests on what training
    has seen.

    Args:
        time: the column of X that is the time, by its number; of a table of
            pandas the column "time" counts. Where it does not increase,
            another run begins.
    """

    _few = ("holds one run, whose time increases throughout; expected two or "
            "more to hold one out")

    def __init__(self, time: int = 0) -> None:
        self.time = time

    def get_n_splits(self, X: Any = None, y: Any = None,
                     groups: Any = None) -> int:
        """Return the number of parts that are held out in turn."""
        return len(self._parts(X))

    def split(self, X: Any, y: Any = None, groups: Any = None
              ) -> Iterator[tuple[Array, Array]]:
        """Give the rows of the other parts and of each part in turn.

        Raises:
            ValueError: there is one part only.
        """
        parts = self._parts(X)
        if len(parts) < 2:
            raise ValueError(f"X: {self._few}")
        rows = np.arange(parts[-1].stop)
        for part in parts:
            yield np.delete(rows, part), rows[part]

    def _parts(self, X: Any) -> list[slice]:
        return _runs(_column(X, "time", self.time))


class LegSplit(RunSplit):
    """Holds out each leg in turn, as ``cross_validation="leg"`` of `train`.

    A leg is a part of a run between two reversals of the temperature by 2 K.
    Where one run is all there is, this tests what a rise says about a fall.

    Args:
        time: the column of X that is the time, as of `RunSplit`.
        temperature: the column that is the temperature [degC]; of a table of
            pandas the column "temperature" counts.
    """

    _few = ("holds one leg: the temperature turns nowhere by 2 K; expected "
            "two or more to hold one out")

    def __init__(self, time: int = 0, temperature: int = 1) -> None:
        super().__init__(time)
        self.temperature = temperature

    def _parts(self, X: Any) -> list[slice]:
        columns = {"time": _column(X, "time", self.time),
                   "temperature": _column(X, "temperature",
                                          self.temperature)}
        parts = []
        for run in super()._parts(X):
            recording = recording_of(
                _recording(columns, run, np.zeros(len(columns["time"]))), "X")
            legs = _core.training_rows(["temperature"], "X", recording, 0)[3]
            begins = run.start + np.flatnonzero(np.diff(legs, prepend=-1))
            parts += [slice(int(first), int(last)) for first, last in
                      zip(begins, [*begins[1:], run.stop])]
        return parts


def _column(X: Any, name: str, number: int) -> Array:
    """A column of a table of pandas by its name, else by its number."""
    values = X[name] if hasattr(X, "columns") else np.asarray(X)[:, number]
    return np.asarray(values, dtype=np.float64)


def _runs(time: Array) -> list[slice]:
    """The rows of each run."""
    begins = np.flatnonzero(np.diff(time, prepend=np.inf) <= 0)
    return [slice(int(first), int(last)) for first, last in
            zip(begins, [*begins[1:], len(time)])]


def _recording(columns: Mapping[str, Array], part: slice, rate: Array) -> Any:
    """The rows of a run as a recording at rest."""
    xarray = _lazy.xarray()
    count = part.stop - part.start
    variables = {name: ("time", values[part], {"units": _UNITS[name]})
                 for name, values in columns.items()}
    units = {"units": "degree/s"}
    return xarray.Dataset({
        **variables, "rate": ("time", rate[part], units),
        "true_rate": ("time", np.zeros(count), units),
        "status": ("time", np.zeros(count, np.uint8))})


def _model_file(model: Union[Path, Mapping[str, Any]]
                ) -> Union[Path, Mapping[str, Any]]:
    """A shipped model by its name, anything else as it is."""
    if isinstance(model, str) and "/" not in model and "." not in model:
        return _shipped.file(f"scenarios/models/{model}.toml")
    return model
