# SPDX-License-Identifier: MIT
"""The bias that a compensator takes away at a steady temperature.

The equations are those of compensation/models; a test compares them with what
`beamgyro compensate` writes.
"""

from __future__ import annotations

from typing import Any, Mapping

import numpy as np
import numpy.typing as npt

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


def spline(knots: Values, values: Values, curvature: Values, x: Values
           ) -> Values:
    k = np.clip(np.searchsorted(knots, x, "right") - 1, 0, len(knots) - 2)
    h = knots[k + 1] - knots[k]
    a, b = (knots[k + 1] - x) / h, (x - knots[k]) / h
    curve: Values = a * values[k] + b * values[k + 1] + h * h / 6 * (
        (a**3 - a) * curvature[k] + (b**3 - b) * curvature[k + 1])
    return curve


def _spline(p: Parameters, x: Values) -> Values:
    return spline(p["knots_degC"], p["values_deg_per_s"],
                  p["second_derivatives_deg_per_s_per_K2"], x[:, 0])


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


def sigma(stated: Mapping[str, Any], temperature: Values) -> Values:
    """The stated 1-sigma long after power-on at a steady temperature."""
    T = np.asarray(stated["temperature_degC"])
    growth = stated["growth_deg_per_s_per_K"]
    beyond = growth[0] * np.clip(T[0] - temperature, 0, None) \
        + growth[1] * np.clip(temperature - T[-1], 0, None)
    values: Values = stated["factor"] * np.hypot(
        np.interp(temperature, T, stated["sigma_deg_per_s"]), beyond)
    return values
