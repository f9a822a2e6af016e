# SPDX-License-Identifier: MIT
"""The bias that a compensator takes away at a steady temperature.

The equations are those of compensation/models; a test compares them with what
`beamgyro compensate` writes.
"""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

from .documents import (COUNT, NUMBER, POSITIVE, both, either, record,
                        require_count, rising, rows, wrong)

Values = npt.NDArray[np.float64]
ZERO_CELSIUS, NOMINAL = 273.15, 298.15  # [K]


def other_inputs(compensator: Mapping[str, Any]) -> list[str]:
    """The inputs that a steady temperature does not tell."""
    return [name for name in compensator["inputs"]
            if not name.startswith(("temperature", "since_power_on"))]


def steady_inputs(compensator: Mapping[str, Any], temperature: Values
                  ) -> Values:
    """Inputs long after power-on, one column each."""
    columns = [np.zeros_like(temperature)
               if name.startswith(("temperature_rate", "since_power_on"))
               else temperature for name in compensator["inputs"]]
    return np.column_stack(columns) if columns else \
        np.empty((len(temperature), 0))


def bias(model: Mapping[str, Any], inputs: Values) -> Values:
    """What a model of bias answers to inputs in the units of recordings."""
    scales = model["input_scales"]
    x = (inputs - np.array([scale["centre"] for scale in scales])) / \
        np.array([scale["half_width"] for scale in scales]) \
        if scales else inputs
    scale = model["bias_scale"]
    shape = _FUNCTIONS[model["kind"]](
        {name: np.asarray(values) for name, values in
         model["parameters"].items()}, x)
    return float(scale["half_width"]) * shape + float(scale["centre"])


Parameters = Mapping[str, Values]


def _none(_: Parameters, x: Values) -> Values:
    return np.zeros(len(x))


def _constant(p: Parameters, x: Values) -> Values:
    return np.full(len(x), float(p["value_deg_per_s"]))


def _polynomial(p: Parameters, x: Values) -> Values:
    values: Values = np.polyval(p["coefficients"][::-1], x[:, 0]) \
        + x[:, 1:] @ p["slopes"]
    return values


def _table(p: Parameters, x: Values) -> Values:
    return np.interp(x[:, 0], p["temperatures_degC"], p["values_deg_per_s"])


SPLINE = ("knots_degC", "values_deg_per_s",
          "second_derivatives_deg_per_s_per_K2")


def spline(knots: Values, values: Values, curvature: Values, x: Values
           ) -> Values:
    k = np.clip(np.searchsorted(knots, x, "right") - 1, 0, len(knots) - 2)
    h = knots[k + 1] - knots[k]
    a, b = (knots[k + 1] - x) / h, (x - knots[k]) / h
    curve: Values = a * values[k] + b * values[k + 1] + h * h / 6 * (
        (a**3 - a) * curvature[k] + (b**3 - b) * curvature[k + 1])
    return curve


def _spline(p: Parameters, x: Values) -> Values:
    knots, values, curvature = (p[name] for name in SPLINE)
    return spline(knots, values, curvature, x[:, 0])


def _thermistor(p: Parameters, x: Values) -> Values:
    n = np.exp(p["b_K"] * (1 / (x[:, 0] + ZERO_CELSIUS) - 1 / NOMINAL))
    both = n * p["parallel"] / (n + p["parallel"])
    return p["offset_deg_per_s"] + p["gain_deg_per_s"] * p["divider"] / (
        p["divider"] + p["series"] + both)


def _fuzzy(p: Parameters, x: Values) -> Values:
    exponent = -0.5 * ((x[:, :1] - p["centres"]) / p["width"])**2
    weight = np.exp(exponent - exponent.max(axis=1, keepdims=True))
    weight /= weight.sum(axis=1, keepdims=True)
    lines = p["consequents"][:, 0] + x @ p["consequents"][:, 1:].T
    values: Values = (weight * lines).sum(axis=1)
    return values


def _radial_basis(p: Parameters, x: Values) -> Values:
    centres = p["centres"].reshape(len(p["weights"]), x.shape[1])
    square = ((x[:, None, :] - centres) ** 2).sum(axis=2)
    values: Values = p["plane"][0] + x @ p["plane"][1:] \
        + np.exp(-square / (2 * p["width"]**2)) @ p["weights"]
    return values


def _bp(p: Parameters, x: Values) -> Values:
    sizes, weights, at = p["layer_sizes"], p["weights"], 0
    for layer, (inside, outside) in enumerate(zip(sizes, sizes[1:])):
        W = weights[at:at + inside * outside].reshape(inside, outside)
        at += inside * outside
        x = x @ W + weights[at:at + outside]
        at += outside
        if layer + 2 < len(sizes):
            x = np.tanh(x)
    return x[:, 0]


_FUNCTIONS = {"none": _none, "constant": _constant, "polynomial": _polynomial,
              "table": _table, "spline": _spline, "thermistor": _thermistor,
              "fuzzy": _fuzzy, "radial_basis": _radial_basis, "bp": _bp}
KINDS = tuple(_FUNCTIONS)

# --- what a model has to be ---

_SOME = rows(NUMBER, 1)
_PARAMETERS = {
    "none": record({}),
    "constant": record({"value_deg_per_s": NUMBER}),
    "polynomial": record({"coefficients": _SOME, "slopes": rows(NUMBER)}),
    "table": record({"temperatures_degC": rising(_SOME),
                     "values_deg_per_s": _SOME},
                    alike=("temperatures_degC", "values_deg_per_s")),
    "spline": record({**dict.fromkeys(SPLINE, rows(NUMBER, 2)),
                      SPLINE[0]: rising(rows(NUMBER, 2))}, alike=SPLINE),
    "thermistor": record({**dict.fromkeys(
        ("b_K", "offset_deg_per_s", "gain_deg_per_s"), NUMBER),
        **dict.fromkeys(("series", "parallel", "divider"), POSITIVE)}),
    "fuzzy": record({"centres": _SOME, "width": POSITIVE,
                     "consequents": rows(_SOME)},
                    alike=("centres", "consequents")),
    "radial_basis": record({"centres": rows(_SOME), "width": POSITIVE,
                            "plane": _SOME, "weights": _SOME},
                           alike=("centres", "weights")),
    "bp": record({"layer_sizes": rows(COUNT, 2), "weights": _SOME}),
}


def _lists(kind: str, p: Mapping[str, Any], inputs: int
           ) -> list[tuple[str, Any, int]]:
    """Lists whose length follows from the number of inputs, and that."""
    if kind == "polynomial":
        return [("slopes", p["slopes"], max(0, inputs - 1))]
    if kind == "fuzzy":
        return [(f"consequents[{k}]", rule, inputs + 1)
                for k, rule in enumerate(p["consequents"])]
    if kind == "radial_basis":
        return [("plane", p["plane"], inputs + 1),
                *((f"centres[{k}]", centre, inputs)
                  for k, centre in enumerate(p["centres"]))]
    if kind == "bp":
        sizes = p["layer_sizes"]
        return [("weights", p["weights"], sum(
            (a + 1) * b for a, b in zip(sizes, sizes[1:])))]
    return []


def _parameters_fit(model: Mapping[str, Any], key: str) -> None:
    kind, p = model["kind"], model["parameters"]
    place = f"{key}.parameters" if key else "parameters"
    _PARAMETERS[kind].check(p, place)
    inputs = len(model.get("inputs", model["input_scales"]))
    if "inputs" in model:
        require_count(model["input_scales"], "input_scales", inputs,
                      "one for each of the inputs")
    if kind not in ("none", "constant") and not inputs:
        raise wrong("inputs", "none", "one or more")
    for name, values, count in _lists(kind, p, inputs):
        require_count(values, f"{place}.{name}", count,
                      f"with {inputs} inputs")
    if kind == "bp" and [p["layer_sizes"][0], p["layer_sizes"][-1]] != \
            [inputs, 1]:
        raise wrong(f"{place}.layer_sizes", str(p["layer_sizes"]),
                    f"{inputs} first and 1 last")


_SCALE = record({"centre": NUMBER, "half_width": POSITIVE})
MODEL = both(record({"kind": either(*KINDS), "input_scales": rows(_SCALE),
                     "bias_scale": _SCALE, "parameters": record({})}),
             _parameters_fit)


def sigma(stated: Mapping[str, Any], temperature: Values) -> Values:
    """The stated 1-sigma long after power-on at a steady temperature."""
    T = np.asarray(stated["temperature_degC"])
    growth = stated["growth_deg_per_s_per_K"]
    beyond = growth[0] * np.clip(T[0] - temperature, 0, None) \
        + growth[1] * np.clip(temperature - T[-1], 0, None)
    values: Values = stated["factor"] * np.hypot(
        np.interp(temperature, T, stated["sigma_deg_per_s"]), beyond)
    return values
