#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A network of torch, trained on a generated set and validated.

torch_network.py CAMPAIGN.toml DIRECTORY [DEVICES]

No signal tells a network the zero of a unit that it has not seen. The
campaign should not draw readout.offset_trim_deg_per_s: its units are then those
whose zero has been measured and set.
"""

from __future__ import annotations

import sys

import numpy as np
import torch

import beamgyro as bg

INPUTS = ["temperature", "temperature_lowpass(100)", "since_power_on(300)",
          "quadrature", "drive_frequency"]


class BiasNetwork(torch.nn.Module):
    """Two layers between scaled features and the bias [degree/s]."""

    beamgyro_inputs = INPUTS

    def __init__(self, rows: np.ndarray, labels: np.ndarray) -> None:  # type: ignore[type-arg]
        super().__init__()
        self.middle = torch.tensor(rows.mean(axis=0))
        self.width = torch.tensor(rows.std(axis=0))
        self.scale = float(labels.std())
        self.layers = torch.nn.Sequential(
            torch.nn.Linear(len(INPUTS), 12, dtype=torch.float64),
            torch.nn.Tanh(),
            torch.nn.Linear(12, 1, dtype=torch.float64))

    def forward(self, rows: torch.Tensor) -> torch.Tensor:
        """Return the bias of each row of features."""
        scaled = (rows - self.middle) / self.width
        bias: torch.Tensor = self.scale * self.layers(scaled)
        return bias


def trained(made: bg.Set) -> BiasNetwork:
    """Fit a network to the training devices of a set."""
    torch.manual_seed(1)
    rows, labels = bg.training_rows(made, INPUTS, every_s=10)
    network = BiasNetwork(rows, labels)
    wanted = torch.from_numpy(labels)[:, None]
    optimiser = torch.optim.LBFGS(network.parameters(), max_iter=200,
                                  line_search_fn="strong_wolfe")

    def loss() -> float:
        optimiser.zero_grad()
        error = torch.mean((network(torch.from_numpy(rows)) - wanted) ** 2)
        error.backward()  # type: ignore[no-untyped-call]
        return float(error)

    optimiser.step(loss)
    return network


def main(campaign: str, directory: str, devices: int = 20) -> None:
    """Generate, train, validate on the test devices."""
    made = bg.generate(campaign, directory, devices=devices)
    network = trained(made)
    device = made.devices_of("test")[0]
    recording = made.recording(made.runs[0], device)
    answer = bg.compensate(network, recording)
    before = ((recording.rate - recording.true_rate) ** 2).mean() ** 0.5
    after = ((answer.compensated_rate - answer.true_rate) ** 2).mean() ** 0.5
    print(f"device {device}: rms {float(before):.3f} deg/s before, "
          f"{float(after):.3f} deg/s after")
    result = bg.validate(network, set=made)
    print(f"test devices: {result.verdict}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], *map(int, sys.argv[3:4]))
