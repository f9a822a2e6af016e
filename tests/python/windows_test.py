# SPDX-License-Identifier: MIT
"""Windows of sets for networks, and their samples as tables."""

import multiprocessing
import pickle
import sys
import types

import numpy as np
import pytest

import beamgyro as bg
from beamgyro import _parquet, _windows
from program import SCENARIOS

INPUTS = ["temperature", "quadrature"]


@pytest.fixture(scope="module", name="made")
def make_set(tmp_path_factory):
    """A set that has samples without power, at once and later."""
    folder = tmp_path_factory.mktemp("windows")
    return bg.generate({
        "name": "small", "device": str(SCENARIOS / "devices/nominal.toml"),
        "devices": 10, "devices_per_file": 4, "seed": 3,
        "split": {"train": 0.6, "validation": 0.2, "test": 0.2},
        "tolerances": {"patches.offset_m": {
            "normal": {"mean": 0, "sigma": 1e-5}}},
        "run": [{"name": "on_and_off", "scenario": {
            "name": "on and off", "device": "nominal.toml",
            "fidelity": "quasistatic", "duration_s": 100,
            "output_rate_Hz": 5, "seed": 1, "rate": {"sine": {
                "amplitude_deg_per_s": 2.0, "frequency_Hz": 0.1}},
            "power": {"on_s": [3, 61], "off_s": [51, 100]},
            "ambient": {"constant_degC": 20.0}}}],
    }, folder / "made", progress=False)


def test_each_window_is_a_part_of_its_run(made):
    windows = made.torch(INPUTS, window=20)
    assert len(windows)
    for number in range(len(windows)):
        row, start = windows.place(number)
        run = made[windows.runs[row]].isel(time=slice(start, start + 20))
        inputs, target = windows[number]
        assert (run.status == 0).all()
        assert inputs.dtype == target.dtype == np.float32
        for k, name in enumerate(INPUTS):
            np.testing.assert_array_equal(
                inputs[:, k], run[name].values.astype(np.float32))
        np.testing.assert_array_equal(
            target, (run.rate - run.true_rate).values.astype(np.float32))
    devices = {device for _, device in windows.runs}
    assert devices == {*made.devices_of("train")}


def test_no_window_goes_over_a_loss_of_power(made):
    # 3 to 51 s and 61 to 100 s, at 5 Hz
    windows = made.torch(INPUTS, window=100, step=50)
    starts = [windows.place(number)[1] for number in
              windows.windows_of(0)]
    assert starts == [50, 100, 150, 350, 400]
    with pytest.raises(ValueError, match="window 300: no run has so many"):
        made.torch(INPUTS, window=300)


def test_inputs_may_be_features_and_the_target_a_variable(made):
    windows = made.torch(["temperature", "since_power_on(60)"], "rate",
                         window=10, part=None)
    assert len(windows.runs) == 10
    inputs, target = windows[0]
    row, start = windows.place(0)
    run = made[windows.runs[row]]
    rows = bg.features(run, ["temperature", "since_power_on(60)"])
    np.testing.assert_array_equal(inputs, rows[start:start + 10].astype("f4"))
    np.testing.assert_array_equal(
        target, run.rate.values[start:start + 10].astype("f4"))


@pytest.mark.parametrize("arguments, words", [
    ({"inputs": ["true_rate"]}, "inputs: true_rate: is not measured"),
    ({"inputs": ["heat"]}, "heat"),
    ({"inputs": "rate"}, "is one text"),
    ({"target": "heat"}, "target 'heat': the runs have no heat"),
    ({"runs": ["other"]}, "runs: 'other'"),
    ({"part": "all"}, "part 'all'"),
    ({"window": 0}, "window 0"),
    ({"step": 0}, "step 0"),
])
def test_what_is_wrong_is_said(made, arguments, words):
    with pytest.raises(ValueError, match=words):
        made.torch(**{"inputs": INPUTS, "window": 10, **arguments})
    windows = made.torch(INPUTS, window=10)
    with pytest.raises(IndexError):
        windows[len(windows)]


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_batches_hold_every_window_once(made, workers):
    windows = made.torch(INPUTS, window=20, part=None)
    batches = windows.batches(7, workers=workers, seed=5, block=2)
    first, second = list(batches), list(batches)
    for epoch in (first, second):
        assert sorted(sum(epoch, [])) == list(range(len(windows)))
        assert len(epoch) == len(batches)
    assert first != second
    batches.set_epoch(0)
    assert list(batches) == first
    assert list(windows.batches(7, workers=workers, seed=5,
                                block=2)) == first


def test_a_worker_decodes_each_run_once(made, monkeypatch):
    decoded = []
    of = _windows.Columns.of
    monkeypatch.setattr(_windows.Columns, "of", lambda self, recording: (
        decoded.append(1), of(self, recording))[1])
    windows = made.torch(INPUTS, window=10, part=None)
    for batch in windows.batches(4, block=3, seed=1):
        windows.__getitems__(batch)
    assert len(decoded) == len(windows.runs)


def items(windows, numbers):
    return [tuple(map(np.ndarray.tobytes, windows[number]))
            for number in numbers]


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_workers_of_any_start_method_give_the_same(made, method):
    windows = made.torch(INPUTS, window=20)
    numbers = list(range(0, len(windows), 3))
    expected = items(windows, numbers)  # the parent has files open
    with multiprocessing.get_context(method).Pool(2) as pool:
        found = pool.starmap(items, [(windows, numbers)] * 4)
    assert found == [expected] * 4
    assert items(pickle.loads(pickle.dumps(windows)), numbers) == expected


def test_a_loader_of_torch_takes_them(made):
    torch = pytest.importorskip("torch")
    windows = made.torch(INPUTS, window=20, part=None)
    loader = torch.utils.data.DataLoader(
        windows, num_workers=2, batch_sampler=windows.batches(8, workers=2))
    seen = 0
    for inputs, target in loader:
        assert inputs.dtype == torch.float32
        assert inputs.shape[1:] == (20, 2) and target.shape[1:] == (20,)
        seen += len(target)
    assert seen == len(windows)


def test_tables_have_the_samples_that_count(made):
    rows = made._chosen(None, ())
    tables = list(_parquet.tables_of(made, rows,
                                     _windows.Columns(INPUTS, "bias")))
    assert len(tables) == 10
    for (run, device), table in zip(rows, tables):
        own = made[run, device]
        own = own.isel(time=own.status.values == 0)
        assert {*table["run"]} == {run} and {*table["device"]} == {device}
        assert {*table["part"]} == {made.part(device)}
        np.testing.assert_array_equal(table["time"], own.time)
        np.testing.assert_array_equal(table["quadrature"], own.quadrature)
        np.testing.assert_array_equal(table["bias"], own.rate - own.true_rate)


def test_parquet_asks_for_pyarrow_where_it_is_missing(made, tmp_path,
                                                      monkeypatch):
    with pytest.raises(ValueError, match="ends in .parquet"):
        made.to_parquet(tmp_path / "a.csv", INPUTS)
    with pytest.raises(ValueError, match="stands twice"):
        made.to_parquet(tmp_path / "a.parquet", ["rate", "rate"])
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ImportError, match="pip install pyarrow"):
        made.to_parquet(tmp_path / "a.parquet", INPUTS)
    assert not list(tmp_path.iterdir())


# Where pyarrow is not to be had: what it is told, by a stand-in. What it makes
# of that is not seen.
def test_parquet_has_a_row_group_for_each_run(made, tmp_path, monkeypatch):
    written = []

    class Writer:
        def __init__(self, name, schema):
            self.file = open(name, "wb")
            assert schema == ["run", "device", "part", "time", *INPUTS, "bias"]

        def write_table(self, table):
            if len(written) == 2 and self.fails:
                raise OSError("full")
            written.append(table)

        def close(self):
            self.file.close()

    class Table(dict):
        schema = property(list)

    arrow = types.ModuleType("pyarrow")
    arrow.table = Table
    arrow.parquet = types.ModuleType("pyarrow.parquet")
    arrow.parquet.ParquetWriter = Writer
    monkeypatch.setitem(sys.modules, "pyarrow", arrow)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", arrow.parquet)
    Writer.fails = True
    with pytest.raises(OSError, match="full"):
        made.to_parquet(tmp_path / "a.parquet", INPUTS)
    assert not list(tmp_path.iterdir())
    Writer.fails = False
    written.clear()
    made.to_parquet(tmp_path / "a.parquet", INPUTS, part="train")
    assert [path.name for path in tmp_path.iterdir()] == ["a.parquet"]
    assert len(written) == len(made.devices_of("train"))


def test_parquet_is_read_by_pyarrow(made, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    made.to_parquet(tmp_path / "a.parquet", INPUTS)
    table = parquet.read_table(tmp_path / "a.parquet").to_pydict()
    first = made[made._chosen(None, ())[0]]
    first = first.isel(time=first.status.values == 0)
    np.testing.assert_array_equal(table["time"][:first.sizes["time"]],
                                  first.time)
