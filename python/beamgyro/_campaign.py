# SPDX-License-Identifier: MIT
"""Populations of gyros."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping
from pathlib import Path as FilePath
from typing import Any, Optional, Union

from beamgyro import _arguments, _checks, _core, _toml
from beamgyro._dataset import Path
from beamgyro._device import Device, Keys
from beamgyro._native import Native, Wrapper
from beamgyro._scenario import Scenario

CampaignLike = Union["Campaign", Path, Keys]


class Campaign(Wrapper):
    """A population of devices and the runs of each of them.

    It does not change. Campaigns are equal when their files are; a campaign
    pickles as the texts of these.

    Args:
        source: a campaign file, or its contents as a nested mapping. There
            files are named from the current directory; ``device`` and the
            ``scenario`` of a run may also be mappings or objects.
        devices: replaces the number of devices in the file.

    Raises:
        ValueError: with file, line and key, what is wrong.
    """

    __slots__ = ()

    _native: _core.Campaign

    def __init__(self, source: CampaignLike,
                 devices: Optional[int] = None) -> None:
        count = (None if devices is None else
                 _arguments.count(devices, "devices"))
        if isinstance(source, Campaign):
            self._native = (source._native if count is None else
                            _core.Campaign.parse(source._native.files, count))
        elif _checks.is_table(source):
            self._native = _campaign_of_keys(source, count)
        else:
            self._native = _core.Campaign.read(
                _checks.file(source, "campaign", "a campaign",
                             _checks.MAPPING), count)

    name = Native(str, "The name in the file.")
    text = Native(str, "The text of the campaign file.")
    devices = Native(int, "The number of devices.")
    seed = Native(int, "The seed of everything random.")
    runs = Native(list[str], "The names of the runs of each device.")

    def device(self, number: int) -> Device:
        """Return a device of the population; numbers start at 0.

        Raises:
            ValueError: there is no such device.
        """
        return Device._of(self._native.device(
            _arguments.whole(number, "device")))

    def _identity(self) -> Any:
        return tuple(self._native.files), self.devices

    def __repr__(self) -> str:
        return (f"<beamgyro.Campaign {self.name}: {self.devices} devices, "
                f"runs {', '.join(self.runs)}>")

    def _rows(self) -> list[tuple[str, str]]:
        return [("name", self.name), ("devices", str(self.devices)),
                ("runs of each", ", ".join(self.runs)),
                ("seed", str(self.seed))]

    def __reduce__(self) -> tuple[Any, ...]:
        return Campaign._parsed, (self._native.files, self.devices)


def _campaign_of_keys(keys: Keys, count: Optional[int]) -> _core.Campaign:
    """The campaign of a mapping, whose parts are written as files to be read
    as those of any campaign; what it keeps of them are texts."""
    with tempfile.TemporaryDirectory() as folder:
        table = dict(keys)
        if "device" in table:
            table["device"] = written_part(table["device"], folder, "device",
                                           "campaign")
        table["run"] = with_written_scenarios(table.get("run", []), folder,
                                              "run", "campaign")
        path = FilePath(folder) / "campaign.toml"
        path.write_text(_toml.text(table), encoding="utf-8")
        try:
            files = _core.Campaign.read(path, count).files
        except ValueError as error:
            raise ValueError(str(error).replace(f"{folder}/", "")) from None
    return _core.Campaign.parse(
        [(_without(place, folder), text) for place, text in files], count)


def written_part(source: Any, folder: str, name: str, whole: str) -> str:
    """Return the path of a file, or of one that is written to `folder`.

    `source` is a file, named from the current directory, or keys or an object
    of beamgyro; `whole` is what it is a part of, for messages.
    """
    if isinstance(source, (str, os.PathLike)):
        return os.path.abspath(os.fspath(source))
    path = FilePath(folder) / f"{name}.toml"
    if isinstance(source, (Device, Scenario)):
        if source.overrides:
            raise ValueError(f"{whole}: {name}: {source!r}: has replaced keys; "
                             "expected a mapping with them, or the file")
        path.write_text(source.text, encoding="utf-8")
    elif _checks.is_table(source):
        table = {key: written_part(part, folder, f"{name}_device", whole)
                 if key == "device" else part for key, part in source.items()}
        path.write_text(_toml.text(table), encoding="utf-8")
    else:
        raise _checks.wrong(source, f"{whole}: {name}",
                            "a file, a mapping or an object of beamgyro")
    return path.name  # as seen from the file that names it


def with_written_scenarios(runs: Any, folder: str, name: str,
                           whole: str) -> list[dict[str, Any]]:
    """Return tables of runs whose scenarios are files; see written_part."""
    if not isinstance(runs, (list, tuple)) or not all(
            isinstance(one, Mapping) for one in runs):
        raise ValueError(f"{whole}: {name}: expected a sequence of mappings "
                         "with name and scenario")
    return [{**run, "scenario": written_part(
        run["scenario"], folder, f"{name}_{number}_scenario", whole)}
            if "scenario" in run else dict(run)
            for number, run in enumerate(runs)]


def _without(place: Any, folder: str) -> FilePath:
    """A place in the folder, as seen from there; another one as it is."""
    path = FilePath(os.fspath(place))
    return path.relative_to(folder) if path.is_relative_to(folder) else path
