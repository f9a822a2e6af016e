# SPDX-License-Identifier: MIT
"""Functions, estimators and networks as compensators.

None of them is given more than the measured signals of one powered stretch,
from a power-on to the next loss of power.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Optional

import numpy as np

from beamgyro import _arguments, _checks, _core, _lazy
from beamgyro._dataset import dataset_of
from beamgyro._warnings import warn

_Answer = tuple["np.ndarray[Any, Any]", Optional["np.ndarray[Any, Any]"]]
Answering = Callable[[_core.Recording, str], _Answer]

DEFAULT_INPUTS = ("temperature",)


def _classes(thing: object) -> set[str]:
    return {f"{one.__module__.partition('.')[0]}.{one.__name__}"
            for one in type(thing).__mro__}


def is_torch_module(thing: object) -> bool:
    """Return whether something is a torch.nn.Module; torch is not imported."""
    return "torch.Module" in _classes(thing)


def is_estimator(thing: object) -> bool:
    """Return whether something predicts as estimators of scikit-learn do."""
    return callable(getattr(thing, "predict", None))


def inputs_of(thing: object,
              inputs: Optional[Sequence[str]]) -> list[str]:
    """Return the features that an estimator or a network is given."""
    names = {"inputs": inputs}
    for name in ("beamgyro_inputs", "feature_names_in_"):
        names[name] = getattr(thing, name, None)
    for name, given in names.items():
        if given is not None:
            return _checks.some_texts(given, name)
    if is_estimator(thing) or is_torch_module(thing):
        warn([f"{type(thing).__name__}: states no inputs, so it is given the "
              "temperature; expected inputs=[\"temperature\"]"])
    return list(DEFAULT_INPUTS)


def measured_columns(features: Sequence[str]) -> list[str]:
    """Return the measured variables that features are computed from."""
    columns = {"rate"}
    for feature in features:
        if feature.startswith("temperature"):
            columns.add("temperature")
        elif not feature.startswith("since_power_on"):
            columns.add(feature)
    return sorted(columns)


def _numbers(values: Any, what: str) -> np.ndarray[Any, Any]:
    shape: tuple[int, ...] = getattr(values, "shape", ())
    if len(shape) == 2 and shape[1] == 1:
        values = values.reshape(-1) if hasattr(values, "reshape") else (
            np.asarray(values)[:, 0])
    _arguments.require_unit(values, f"the answer of {what}", "degree/s")
    return _arguments.numbers(values, f"the answer of {what}")


def _split(answer: Any, what: str, time: np.ndarray[Any, Any]) -> _Answer:
    if not isinstance(answer, tuple):
        answer = (answer, None)
    if len(answer) != 2:
        raise ValueError(
            f"the answer of {what}: is a tuple of {len(answer)}; expected "
            "rates, or (rates, sigmas)")
    rates, sigmas = answer
    for one in answer:
        if hasattr(one, "data_vars"):
            raise ValueError(
                f"the answer of {what}: is a dataset; expected an array of "
                "rates, such as dataset[\"rate\"]")
        _require_times(one, what, time)
    return (_numbers(rates, what),
            None if sigmas is None else _numbers(sigmas, what))


def _require_times(values: Any, what: str,
                   time: np.ndarray[Any, Any]) -> None:
    """Refuse an array of xarray, or a series of pandas, in another order."""
    stated = _arguments.stated_times(values)
    if stated is None:
        _require_no_other_order(getattr(values, "index", None), what)
        return
    own = np.asarray(stated)
    if own.shape == time.shape and not np.array_equal(own, time):
        raise ValueError(
            f"the answer of {what}: has other times than the signals; "
            "expected a rate for each sample in the order of these")


def _require_no_other_order(index: Any, what: str) -> None:
    """Refuse the index of a series that was sorted by something else."""
    if not hasattr(index, "dtype") or index.dtype.kind not in "iu":
        return
    places, order = np.asarray(index), np.arange(len(index))
    if not np.array_equal(places, order) and np.array_equal(
            np.sort(places), order):
        raise ValueError(
            f"the answer of {what}: is a series with the index "
            f"{', '.join(map(str, places[:3]))}, ...; expected a rate for each "
            "sample in the order of the signals: 0, 1, ...")


@contextlib.contextmanager
def _asking(name: str, recording: _core.Recording,
            run: str) -> Iterator[str]:
    """Tell, in an error of the user's code, which compensator was asked what.

    The error stays what it is; the words are a note below it. Yields the same
    words for errors of the answer.
    """
    time = recording.arrays()["time"]
    what = (f"{name} to the {time.size} samples from {time[0]:g} s"
            + (f" of {run}" if run else ""))
    try:
        yield what
    except Exception as error:
        error.add_note(f"while beamgyro asked for the answer of {what}")
        raise


def answering_function(function: Callable[[Any], Any], arrays: bool,
                       name: str) -> Answering:
    """Return how a function of the signals answers with rates."""
    def answer(recording: _core.Recording, run: str) -> _Answer:
        signals = (recording.arrays() if arrays else dataset_of(recording))
        time = recording.arrays()["time"].copy()
        with _asking(name, recording, run) as what:
            answered = function(signals)
        return _split(answered, what, time)
    return answer


def _rate_less(recording: _core.Recording,
               bias: np.ndarray[Any, Any], what: str) -> _Answer:
    rate = recording.arrays()["rate"]
    if bias.shape != rate.shape:
        raise ValueError(
            f"the answer of {what}: holds {bias.size} biases; expected one "
            "for each sample")
    return rate - bias, None


def _require_order(fitted: Sequence[str], inputs: Sequence[str],
                   name: str) -> None:
    """Refuse inputs that are fitted names in other places.

    Names that are no inputs, such as "T", are given the inputs in their order.
    """
    moved = any(one in inputs and list(inputs).index(one) != place
                for place, one in enumerate(fitted))
    if moved or len(fitted) != len(inputs):
        raise ValueError(
            f"inputs {list(inputs)!r}: {name} was fitted to {fitted!r}; "
            "expected an input for each of these, in their order")


def answering_estimator(estimator: Any, inputs: Sequence[str],
                        name: str) -> Answering:
    """Return how an estimator, which predicts the bias, answers."""
    names = getattr(estimator, "feature_names_in_", None)
    if names is not None:
        _require_order(list(names), inputs, name)

    def answer(recording: _core.Recording, run: str) -> _Answer:
        rows: Any = _core.features(inputs, recording)
        if names is not None:  # fitted to a table with names
            rows = _lazy.module("pandas").DataFrame(rows, columns=list(names))
        with _asking(name, recording, run) as what:
            bias = estimator.predict(rows)
        return _rate_less(recording, _numbers(bias, what), what)
    return answer


def answering_network(network: Any, inputs: Sequence[str],
                      name: str) -> Answering:
    """Return how a torch module, whose output is the bias, answers."""
    def answer(recording: _core.Recording, run: str) -> _Answer:
        torch = _lazy.module("torch")
        rows = torch.from_numpy(_core.features(inputs, recording))
        parameter = next(iter(network.parameters()), None)
        if parameter is None:
            rows = rows.to(torch.get_default_dtype())
        else:
            rows = rows.to(parameter.dtype).to(parameter.device)
        # eval() and train() set all modules; the user may have frozen some.
        was_training = [(module, module.training)
                        for module in network.modules()]
        network.eval()
        try:
            with torch.no_grad(), _asking(name, recording, run) as what:
                bias = network(rows)
        finally:
            for module, flag in was_training:
                module.training = flag
        return _rate_less(recording, _numbers(bias, what), what)
    return answer
