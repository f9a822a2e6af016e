# SPDX-License-Identifier: MIT
"""Functions, estimators and networks as compensators.

None of them is given more than the measured signals of one powered stretch,
from a power-on to the next loss of power.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Optional

import numpy as np

from beamgyro import _core, _lazy
from beamgyro._dataset import dataset_of

_Answer = tuple["np.ndarray[Any, Any]", Optional["np.ndarray[Any, Any]"]]
Answering = Callable[[_core.Recording], _Answer]

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
    if inputs is not None:
        return list(inputs)
    for name in ("beamgyro_inputs", "feature_names_in_"):
        told = getattr(thing, name, None)
        if told is not None:
            return [str(one) for one in told]
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
    if hasattr(values, "detach"):  # of torch
        values = values.detach().cpu().numpy()
    numbers = np.asarray(values, dtype=float)
    if numbers.ndim == 2 and numbers.shape[1] == 1:
        numbers = numbers[:, 0]
    if numbers.ndim != 1:
        raise ValueError(
            f"{what} gave an array of the shape {numbers.shape}; expected one "
            "number for each sample")
    return numbers


def _split(answer: Any, what: str) -> _Answer:
    if isinstance(answer, tuple):
        if len(answer) != 2:
            raise ValueError(
                f"{what} gave a tuple of {len(answer)}; expected rates, or "
                "(rates, sigmas)")
        return _numbers(answer[0], what), _numbers(answer[1], what)
    return _numbers(answer, what), None


def answering_function(function: Callable[[Any], Any], arrays: bool,
                       name: str) -> Answering:
    """Return how a function of the signals answers with rates."""
    def answer(recording: _core.Recording) -> _Answer:
        signals = (recording.arrays() if arrays else dataset_of(recording))
        return _split(function(signals), name)
    return answer


def _rate_less(recording: _core.Recording,
               bias: np.ndarray[Any, Any], name: str) -> _Answer:
    rate = recording.arrays()["rate"]
    if bias.shape != rate.shape:
        raise ValueError(
            f"{name} gave {bias.size} biases; expected {rate.size}, one for "
            "each sample")
    return rate - bias, None


def answering_estimator(estimator: Any, inputs: Sequence[str],
                        name: str) -> Answering:
    """Return how an estimator, which predicts the bias, answers."""
    names = getattr(estimator, "feature_names_in_", None)

    def answer(recording: _core.Recording) -> _Answer:
        rows: Any = _core.features(inputs, recording)
        if names is not None:  # fitted to a table with names
            rows = _lazy.module("pandas").DataFrame(rows, columns=list(names))
        return _rate_less(recording,
                          _numbers(estimator.predict(rows), name), name)
    return answer


def answering_network(network: Any, inputs: Sequence[str],
                      name: str) -> Answering:
    """Return how a torch module, whose output is the bias, answers."""
    def answer(recording: _core.Recording) -> _Answer:
        torch = _lazy.module("torch")
        rows = torch.from_numpy(_core.features(inputs, recording))
        parameter = next(iter(network.parameters()), None)
        if parameter is None:
            rows = rows.to(torch.get_default_dtype())
        else:
            rows = rows.to(parameter.dtype).to(parameter.device)
        was_training = network.training
        network.eval()
        try:
            with torch.no_grad():
                bias = _numbers(network(rows), name)
        finally:
            network.train(was_training)
        return _rate_less(recording, bias, name)
    return answer
