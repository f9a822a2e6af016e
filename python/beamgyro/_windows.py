# SPDX-License-Identifier: MIT
"""Windows of the runs of a set, for networks, and their rows as tables."""

from __future__ import annotations

import collections
import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from beamgyro import _arguments, _checks, _core

if TYPE_CHECKING:
    from beamgyro._set import Set as _Set

Array = np.ndarray[Any, Any]

BIAS = "bias"  # the measured rate less the true rate [degree/s]
_NO_SAMPLE = 1 | 2 | 4  # without power, saturated, not locked
_KEPT_ROWS = 32  # runs of a device that are kept decoded in each process


class Columns:
    """What is taken from a recording: features, and a target.

    Inputs are measured variables, or features as model files name them.
    """

    def __init__(self, inputs: Sequence[str], target: str) -> None:
        self.inputs = _checks.some_texts(inputs, "inputs")
        self.target = _checks.text(target, "target")
        self._read: Optional[list[str]] = None  # variables; none: all

    def look_at(self, recording: _core.Recording) -> None:
        """Checks the names against a recording with all its variables.

        Raises:
            ValueError: there is no such variable or feature, or an input is
                no measured one.
        """
        about = recording.variable_attributes()
        for name in self.inputs:
            if name in about and about[name]["role"] != "measured":
                raise ValueError(f"inputs: {name}: is not measured, and no "
                                 "gyro knows it; expected measured variables")
        for name in self._wanted():
            if name not in about:
                raise ValueError(
                    f"target {_checks.shown(self.target)}: the runs have no "
                    f"{name} at the rate of their samples; expected \"{BIAS}\""
                    f" or one of {', '.join(about)}")
        features = [name for name in self.inputs if name not in about]
        if features:
            _core.features(features, recording)  # refuses what is none
        else:
            self._read = sorted({*self.inputs, *self._wanted()} - {"status"})

    def _wanted(self) -> list[str]:
        return ["rate", "true_rate"] if self.target == BIAS else [self.target]

    @property
    def variables(self) -> list[str]:
        """What has to be read of a recording; nothing: all of it."""
        return self._read or []

    def of(self, recording: _core.Recording) -> tuple[Array, Array, Array]:
        """Return inputs (sample, input), targets, and whether both count."""
        arrays = recording.arrays()
        features = [name for name in self.inputs if name not in arrays]
        found = dict(arrays)
        if features:
            found.update(zip(features,
                             _core.features(features, recording).T))
        target = (arrays["rate"] - arrays["true_rate"]
                  if self.target == BIAS else arrays[self.target])
        return (np.stack([found[name] for name in self.inputs], axis=-1),
                target, (arrays["status"] & _NO_SAMPLE) == 0)


class Windows:
    """Windows of a set: a map-style dataset of torch, which it does not need.

    An item is (inputs, target): arrays of float32 with the shapes (window,
    inputs) and (window,). Samples without power, without lock or beyond the
    full scale are in none. It may be pickled, and used by workers of any
    start method: each process opens the set for itself.

    Decoding a run is what costs. `batches` therefore shuffles within blocks
    of runs, and gives each worker its own; windows at random decode a run for
    each.
    """

    def __init__(self, source: _Set, rows: Sequence[tuple[str, int]],
                 columns: Columns, window: int, step: int) -> None:
        if not rows:
            raise ValueError("part: has no run with values; expected at least "
                             "one")
        self.window = window
        self.inputs, self.target = columns.inputs, columns.target
        self._columns = columns
        self._rows = list(rows)
        self._set = source
        columns.look_at(source._native.recording(*self._rows[0]))
        starts = [self._starts_of(row, step) for row in self._rows]
        self._ends = np.cumsum([len(one) for one in starts])
        self._starts = np.concatenate(starts)
        if not len(self):
            raise ValueError(
                f"window {window}: no run has so many samples in turn with "
                "power, lock and within the full scale; expected fewer")
        self._begin()

    def _begin(self) -> None:
        self._process = os.getpid()
        self._decoded: collections.OrderedDict[int, tuple[Array, Array]] = (
            collections.OrderedDict())

    def _starts_of(self, row: tuple[str, int], step: int) -> Array:
        status = self._set._native.recording(
            *row, variables=["rate"]).arrays()["status"]
        bad = np.concatenate([[0], np.cumsum((status & _NO_SAMPLE) != 0)])
        starts = np.arange(0, status.size - self.window + 1, step,
                           dtype=np.int32)
        good: Array = starts[bad[starts] == bad[starts + self.window]]
        return good

    def __len__(self) -> int:
        return len(self._starts)

    def __getitem__(self, index: int) -> tuple[Array, Array]:
        row, start = self.place(index)
        inputs, target = self._row(row)
        end = start + self.window
        return inputs[start:end], target[start:end]

    def __getitems__(self, indices: Sequence[int]
                     ) -> list[tuple[Array, Array]]:
        return [self[index] for index in indices]

    def place(self, index: int) -> tuple[int, int]:
        """Return the number of the run and the first sample of a window."""
        number = index.__index__()
        if number < 0:
            number += len(self)
        if not 0 <= number < len(self):
            raise IndexError(f"window {index}: there are {len(self)}")
        return (int(np.searchsorted(self._ends, number, side="right")),
                int(self._starts[number]))

    @property
    def runs(self) -> list[tuple[str, int]]:
        """The runs (run, device) that the windows are of, by their number."""
        return list(self._rows)

    def windows_of(self, row: int) -> Array:
        """Return the numbers of the windows of a run."""
        first = self._ends[row - 1] if row else 0
        return np.arange(first, self._ends[row])

    def _row(self, row: int) -> tuple[Array, Array]:
        if self._process != os.getpid():  # forked: no handle of the parent's
            self._set = type(self._set)(self._set.directory)
            self._begin()
        found = self._decoded.get(row)
        if found is not None:
            self._decoded.move_to_end(row)
            return found
        recording = self._set._native.recording(
            *self._rows[row], variables=self._columns.variables)
        inputs, target, _ = self._columns.of(recording)
        made = inputs.astype(np.float32), target.astype(np.float32)
        self._decoded[row] = made
        if len(self._decoded) > _KEPT_ROWS:
            self._decoded.popitem(last=False)
        return made

    def batches(self, size: int, *, workers: int = 1, seed: int = 0,
                block: int = 16) -> WindowBatches:
        """Return the numbers of windows in shuffled batches.

        >>> DataLoader(windows, num_workers=2,
        ...            batch_sampler=windows.batches(64, workers=2))

        Args:
            size: windows in a batch; the last ones may have fewer.
            workers: the `num_workers` of the loader, each of which then
                decodes runs of its own.
            seed: of the order, which differs in each epoch.
            block: runs whose windows are shuffled with each other.
        """
        return WindowBatches(
            self, _arguments.count(size, "size"),
            max(1, _arguments.whole(workers, "workers")),
            _arguments.seed(seed),
            min(_arguments.count(block, "block"), _KEPT_ROWS))

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in self.__dict__.items()
                if name not in ("_decoded", "_process")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._begin()

    def __repr__(self) -> str:
        return (f"<beamgyro.Windows of {self._set.directory}: {len(self)} of "
                f"{self.window} samples, {', '.join(self.inputs)} to "
                f"{self.target}>")


class WindowBatches:
    """Batches of windows, shuffled within blocks of runs.

    A batch sampler of torch. Each iteration is an epoch with an order of its
    own; `set_epoch` says which comes next.
    """

    def __init__(self, windows: Windows, size: int, workers: int, seed: int,
                 block: int) -> None:
        self._windows = windows
        self._size = size
        self._workers = workers
        self._seed = seed
        self._block = block
        self._epoch = 0

    def set_epoch(self, epoch: int) -> None:
        """Say which epoch the next iteration is, counted from 0."""
        self._epoch = _arguments.whole(epoch, "epoch")

    def _streams(self, epoch: int) -> list[Array]:
        """The windows of each worker, in their order."""
        random = np.random.default_rng([self._seed, epoch])
        rows = random.permutation(len(self._windows.runs))
        blocks = [random.permutation(np.concatenate(
            [self._windows.windows_of(int(row)) for row in
             rows[first:first + self._block]]))
            for first in range(0, len(rows), self._block)]
        return [np.concatenate(blocks[worker::self._workers])
                for worker in range(min(self._workers, len(blocks)))]

    def __iter__(self) -> Iterator[list[int]]:
        streams = self._streams(self._epoch)
        self._epoch += 1
        longest = max(map(len, streams))
        for first in range(0, longest, self._size):
            for stream in streams:  # as a loader deals batches to workers
                batch = stream[first:first + self._size]
                if batch.size:
                    yield batch.tolist()

    def __len__(self) -> int:
        return sum(-(-len(stream) // self._size)
                   for stream in self._streams(self._epoch))
