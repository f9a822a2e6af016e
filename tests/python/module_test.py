# SPDX-License-Identifier: MIT
"""The objects of the package: errors, copies, arrays, memory, interrupts."""

import copy
import faulthandler
import os
import pickle
import signal
import sys
import threading
import time

import numpy as np
import pytest

import beamgyro as bg
from program import PATIENCE, SCENARIOS, said

WARM_UP = SCENARIOS / "warm_up.toml"
NOMINAL = SCENARIOS / "devices/nominal.toml"


def test_import_loads_nothing_large():
    code = ("import beamgyro, sys; print([m for m in ('xarray', 'pandas', "
            "'matplotlib', 'torch', 'sklearn', 'h5py') if m in sys.modules])")
    assert said(sys.executable, "-c", code) == "[]\n"


@pytest.mark.parametrize("make, place", [
    (lambda folder: bg.Scenario(folder / "absent.toml"), "absent.toml"),
    (lambda folder: bg.run(WARM_UP, set={"beam.lenght_m": 1}),
     "beam.lenght_m"),
    (lambda folder: bg.run(WARM_UP, fidelity="exact"), "fidelity"),
    (lambda folder: bg.run(WARM_UP, output="frame"), "output"),
    (lambda folder: bg.Device({"beam": {"length_m": "long"}}), "device:1:1"),
    (lambda folder: bg.Device(NOMINAL, {"beam.length_m": "long"}),
     "beam.length_m"),
    (lambda folder: bg.Device({"beam": {"length_m": object()}}),
     "beam.length_m"),
    (lambda folder: bg.Scenario({"duration_s": 5}), "device"),
    (lambda folder: bg.Compensator.parse("{", "own.json"), "own.json"),
    (lambda folder: bg.Compensator(3), "no compensator"),
    (lambda folder: bg.open_recording(NOMINAL), "nominal.toml"),
    (lambda folder: bg.open_set(folder), "holds no set"),
    (lambda folder: bg.characterise(NOMINAL, 1000), "1000 degC"),
    (lambda folder: bg.allan([1.0, 2.0]), "rate_Hz"),
])
def test_wrong_input_is_a_value_error_that_names_it(make, place, tmp_path):
    with pytest.raises(ValueError) as raised:
        make(tmp_path)
    assert place in str(raised.value)


def test_failed_work_is_a_runtime_error(tmp_path):
    recording = bg.run(WARM_UP, set={"duration_s": 5})
    with pytest.raises((RuntimeError, ValueError), match="absent"):
        bg.save_recording(recording, tmp_path / "absent" / "a.h5")
    assert not list(tmp_path.iterdir())


def test_scenarios_of_files_and_mappings_are_the_same_physics(sweep_keys):
    made = bg.Scenario(sweep_keys, set={"duration_s": 60})
    again = bg.Scenario.parse(made.text, NOMINAL).with_(duration_s=60)
    first, second = bg.run(made), bg.run(again)
    assert first.rate.values.tobytes() == second.rate.values.tobytes()


def test_with_replaces_keys_of_scenario_and_device():
    scenario = bg.Scenario(WARM_UP)
    other = scenario.with_({"beam.length_m": 0.041}, duration_s=60, seed=5)
    assert (other.duration_s, other.seed) == (60, 5)
    assert other != scenario
    assert scenario.duration_s == 3600
    by_device = scenario.with_(
        duration_s=60, seed=5,
        device=bg.Device(NOMINAL).with_(beam={"length_m": 0.041}))
    np.testing.assert_array_equal(bg.run(by_device).rate,
                                  bg.run(other).rate)


@pytest.mark.parametrize("make", [
    lambda: bg.Device(NOMINAL).with_({"beam.length_m": 0.041}),
    lambda: bg.Scenario(WARM_UP, set={"duration_s": 60}),
    lambda: bg.Campaign(SCENARIOS / "campaigns/small.toml", devices=3),
])
def test_objects_pickle_and_copy_by_their_text(make):
    made = make()
    for twin in (pickle.loads(pickle.dumps(made)), copy.copy(made),
                 copy.deepcopy(made)):
        assert twin == made
        assert hash(twin) == hash(made)
        assert twin.text == made.text
    assert made.name in repr(made)


def test_arrays_are_those_of_the_dataset_and_outlive_it():
    scenario = bg.Scenario(WARM_UP, set={"duration_s": 60})
    arrays = bg.run(scenario, output="arrays")
    rate = bg.run(scenario).rate.values
    assert list(arrays)[:3] == ["time", "output", "rate"]
    assert arrays["status"].dtype == np.uint8
    assert not rate.flags.owndata  # of the recording, not a copy
    np.testing.assert_array_equal(rate, arrays["rate"])


def test_runs_leave_no_memory_behind():
    scenario = bg.Scenario(WARM_UP, set={"duration_s": 20})

    def runs(count):
        for _ in range(count):
            bg.run(scenario, output="arrays")
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    before = runs(300)
    # A run holds 28 kB of samples: leaking one would show 28 MB.
    assert runs(1000) - before < 4e6


def test_an_interrupt_ends_a_long_call_soon():
    scenario = bg.Scenario(WARM_UP, set={"duration_s": 600},
                           ).with_(fidelity="carrier")
    sent = []

    def interrupt():
        time.sleep(0.5)
        sent.append(time.process_time())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    faulthandler.dump_traceback_later(PATIENCE, exit=True)  # where it hangs
    try:
        with pytest.raises(KeyboardInterrupt):
            bg.run(scenario)
    finally:
        faulthandler.cancel_dump_traceback_later()
    # 0.05 s between two looks at the signals, and 0.1 s of patience, all of
    # which the run may use; the rest is for a slow machine.
    assert time.process_time() - sent[0] < 2


def test_other_threads_go_on_during_a_long_call():
    scenario = bg.Scenario(WARM_UP, set={"duration_s": 20,
                                         "fidelity": "envelope"})
    counted = []
    done = threading.Event()

    def count():
        while not done.is_set():
            counted.append(None)
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        before = len(counted)
        bg.run(scenario)
        assert len(counted) > before
    finally:
        done.set()
        thread.join()


def test_progress_is_told_and_may_stop_the_work():
    class Enough(Exception):
        pass

    def stop(share):
        assert 0 <= share <= 1
        raise Enough

    scenario = bg.Scenario(WARM_UP, set={"duration_s": 600,
                                         "fidelity": "carrier"})
    with pytest.raises(Enough):
        bg.run(scenario, progress=stop)


@pytest.mark.parametrize("least", [0.0, 0.1])
def test_progress_that_returns_false_stops_the_work(least, tmp_path):
    shares = []

    def is_to_go_on(share):
        shares.append(share)
        return share < least

    scenario = bg.Scenario(WARM_UP, set={"duration_s": 20,
                                         "fidelity": "carrier"})
    with pytest.raises(bg.Cancelled, match="cancelled"):
        bg.run_to_file(scenario, tmp_path / "run.h5", progress=is_to_go_on)
    assert least <= shares[-1] < 1
    assert not (tmp_path / "run.h5").exists()
    with pytest.raises(RuntimeError):
        bg.characterise(SCENARIOS / "campaigns/small.toml", [20.0], devices=3,
                        progress=lambda share: False)
    # Nothing is left to stop where the work is done.
    run = bg.run(WARM_UP, set={"duration_s": 1},
                 progress=lambda share: share < 1)
    assert run.sizes["time"] > 0


def test_warnings_are_those_of_the_command():
    with pytest.warns(bg.BeamgyroWarning, match="soaks") as caught:
        bg.run(SCENARIOS / "ramp.toml", set={"duration_s": 60})
    assert caught[0].filename == __file__


def test_progress_is_told_where_work_begins_and_ends():
    shares = []
    bg.run(WARM_UP, set={"duration_s": 1}, progress=shares.append)
    assert (shares[0], shares[-1]) == (0.0, 1.0)
    shares.clear()
    bg.run(WARM_UP, set={"duration_s": 10, "fidelity": "carrier"},
           progress=shares.append)
    assert shares == sorted(shares)
    assert any(0 < share < 1 for share in shares)
    assert shares.count(1.0) == 1


def test_failed_work_is_not_reported_as_done():
    run = bg.run(WARM_UP, set={"duration_s": 60})
    shares = []
    with pytest.raises(KeyError, match="absent"):
        bg.validate(lambda signals: signals["absent"], run,
                    progress=shares.append)
    assert shares and 1.0 not in shares
