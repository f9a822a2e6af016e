# SPDX-License-Identifier: MIT
"""The compiled part of beamgyro."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final, Optional, Union

import numpy as np
import numpy.typing as npt

_Path = Union[str, os.PathLike[str]]
_Progress = Optional[Callable[[float], object]]
_Array = np.ndarray[Any, Any]
_Report = tuple[str, str, list[str]]
_LongReport = tuple[str, str, list[str], str]
_Verdict = tuple[str, str, list[str], str, str, str]

version: str

def end_running_work() -> None: ...
def kinds_of(path: _Path) -> list[str]: ...
def unit_of(name: str) -> str: ...

class Recording:
    fidelity: str
    title: str
    history: str
    compensator: str
    compensator_sha256: str
    program_version: str
    git_revision: str
    scenario_text: str
    device_text: str
    overrides_text: str
    seed: int
    def add(self, name: str, values: npt.ArrayLike,
            attributes: dict[str, str]) -> None: ...
    def require_sound(self) -> None: ...
    def arrays(self) -> dict[str, _Array]: ...
    def variable_attributes(self) -> dict[str, dict[str, Any]]: ...
    def file_attributes(self) -> dict[str, Any]: ...
    def write(self, path: _Path) -> None: ...

def new_recording(time: npt.ArrayLike, status: npt.ArrayLike) -> Recording: ...
def read_recording(path: _Path) -> tuple[Recording, list[str]]: ...

class Cancelled(RuntimeError): ...

class Device:
    @staticmethod
    def read(file: _Path, overrides: list[str]) -> Device: ...
    @staticmethod
    def parse(text: str, name: str, overrides: list[str]) -> Device: ...
    def with_(self, overrides: list[str]) -> Device: ...
    text: Final[str]
    name: Final[str]
    overrides: Final[list[str]]

def even_temperatures(start: float, stop: float,
                      step: float) -> list[float]: ...
def characterise(device: Device,
                 temperatures_degC: Sequence[float]) -> dict[str, Any]: ...

class Scenario:
    @staticmethod
    def read(file: _Path, overrides: list[str]) -> Scenario: ...
    @staticmethod
    def read_with(file: _Path, device: Device,
                  overrides: list[str]) -> Scenario: ...
    @staticmethod
    def parse(text: str, device: Device, overrides: list[str], name: str,
              profiles: list[tuple[Path, bytes]]) -> Scenario: ...
    def with_(self, overrides: list[str]) -> Scenario: ...
    def with_device(self, device: Device) -> Scenario: ...
    text: Final[str]
    name: Final[str]
    device: Final[Device]
    overrides: Final[list[str]]
    profiles: Final[list[tuple[Path, bytes]]]
    title: Final[str]
    duration: Final[float]
    output_rate: Final[float]
    samples: Final[int]
    fidelity: Final[str]
    seed: Final[int]

def simulate(scenario: Scenario, stop_on_unlock: bool,
             progress: _Progress) -> tuple[Recording, list[str]]: ...
def simulate_to_file(scenario: Scenario, path: _Path, stop_on_unlock: bool,
                     progress: _Progress) -> list[str]: ...

def simulate_variants(scenario: Scenario, axes: list[list[list[str]]],
                      variables: list[str], jobs: int, progress: _Progress
                      ) -> tuple[Recording, list[tuple[str, int]]]: ...

class Campaign:
    @staticmethod
    def read(file: _Path, devices: Optional[int]) -> Campaign: ...
    @staticmethod
    def parse(files: Sequence[tuple[_Path, bytes]],
              devices: Optional[int]) -> Campaign: ...
    name: Final[str]
    text: Final[str]
    files: Final[list[tuple[Path, bytes]]]
    devices: Final[int]
    seed: Final[int]
    runs: Final[list[str]]
    def device(self, number: int) -> Device: ...

def characterise_campaign(campaign: Campaign,
                          temperatures_degC: Sequence[float], jobs: int,
                          progress: _Progress) -> dict[str, Any]: ...

def generate(campaign: Campaign, directory: _Path, jobs: int, resume: bool,
             shard: tuple[int, int],
             progress: _Progress) -> tuple[int, list[str], bool]: ...

class Set:
    @staticmethod
    def open(directory: _Path) -> Set: ...
    directory: Final[Path]
    devices: Final[int]
    runs: Final[list[str]]
    seed: Final[int]
    failures: Final[list[tuple[str, int, str]]]
    def part(self, device: int) -> str: ...
    def recording(self, run: str, device: int,
                  variables: Sequence[str] = ...) -> Recording: ...
    def slow_recording(self, run: str, device: int) -> Recording: ...
    def parameters(self, run: str,
                   device: int) -> list[tuple[str, float, str, str]]: ...
    def verify(self, progress: _Progress) -> list[tuple[str, str]]: ...
    def write_card(self, texts: dict[str, str],
                   progress: _Progress) -> list[str]: ...

class RateCompensator:
    name: Final[str]
    inputs: Final[list[str]]

class Compensator(RateCompensator):
    @staticmethod
    def parse(text: str, name: str) -> Compensator: ...
    def write(self, file: _Path) -> None: ...
    text: Final[str]
    method: Final[str]
    lowest_temperature: Final[float]
    highest_temperature: Final[float]
    warnings: Final[list[str]]
    curve: Final[str]

_Answer = tuple[npt.ArrayLike, Optional[npt.ArrayLike]]

def function_compensator(
    name: str, inputs: Sequence[str],
    function: Callable[[Recording, str], _Answer]) -> RateCompensator: ...
def open_compensator(argument: str, program: _Path, stall_s: float,
                     plugin_files: Sequence[_Path],
                     require_isolation: bool) -> RateCompensator: ...
def compensate(compensator: RateCompensator,
               recording: Recording) -> tuple[Recording, list[str]]: ...
def features(inputs: Sequence[str], recording: Recording) -> _Array: ...
def training_rows(inputs: Sequence[str], name: str, recording: Recording,
                  every_s: float
                  ) -> tuple[_Array, _Array, _Array, _Array]: ...
def import_log(log: _Path, map: _Path, map_text: Optional[str], axis: str,
               join: _Path) -> tuple[Recording, str]: ...

class Model:
    @staticmethod
    def read(file: _Path) -> Model: ...
    @staticmethod
    def parse(text: str, name: str) -> Model: ...
    text: Final[str]
    name: Final[str]

_Trained = tuple[Compensator, list[str]]

def train_files(model: Model, files: Sequence[_Path],
                held_out: Sequence[_Path], seed: int, cross_validation: str,
                progress: _Progress) -> _Trained: ...
def train_recordings(model: Model,
                     recordings: Sequence[tuple[str, Recording]],
                     held_out: Sequence[tuple[str, Recording]], seed: int,
                     cross_validation: str,
                     progress: _Progress) -> _Trained: ...
def train_set(model: Model, set: Set, runs: Sequence[str],
              devices: Sequence[int], seed: int, cross_validation: str,
              progress: _Progress) -> _Trained: ...
def allan_recording(recording: Recording, column: str,
                    options: dict[str, Any]) -> _Report: ...
def allan_samples(samples: npt.ArrayLike, rate_Hz: float, unit: str,
                  options: dict[str, Any]) -> _Report: ...
def allan_file(file: _Path, column: Optional[str], rate_Hz: Optional[float],
               unit: Optional[str], options: dict[str, Any]) -> _Report: ...
def source_kind(argument: str) -> str: ...
def random_seed() -> int: ...
def validation_members() -> list[tuple[str, str, str, str, list[str],
                                       str]]: ...
def validate(compensator: RateCompensator, options: dict[str, Any],
             progress: _Progress) -> _Verdict: ...
def validate_model(model: Model, options: dict[str, Any],
                   progress: _Progress) -> _Verdict: ...
def plan(population: Compensator, device: Device,
         options: dict[str, Any]) -> _LongReport: ...
def sensitivity(campaign: Campaign, options: dict[str, Any],
                progress: _Progress) -> _Report: ...
def curve_figures(temperatures_degC: npt.ArrayLike,
                  curves: npt.ArrayLike, units: Sequence[int],
                  treatment: dict[str, Any], name: str) -> _Report: ...
def area_metric(one: npt.ArrayLike, other: npt.ArrayLike) -> float: ...
def area_metric_of_table(sample: npt.ArrayLike, shares: npt.ArrayLike,
                         values: npt.ArrayLike) -> float: ...
def half_split(sample: npt.ArrayLike, draws: int,
               seed: int) -> tuple[float, float]: ...
def write_texts(directory: _Path,
                texts: Sequence[tuple[str, str]]) -> None: ...
def export_files(compensators: Sequence[Compensator], format: str,
                 options: dict[str, Any]) -> tuple[list[tuple[str, str]],
                                                   list[str]]: ...
def export_for_simulator(devices: Sequence[Device],
                         compensators: Sequence[Compensator], format: str,
                         options: dict[str, Any]
                         ) -> tuple[list[tuple[str, str]], list[str]]: ...
def design_device(base: Device, sheet: dict[str, Any]
                  ) -> tuple[str, list[tuple[str, str, float, float, bool]],
                             list[str]]: ...
