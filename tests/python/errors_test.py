# SPDX-License-Identifier: MIT
"""Wrong arguments are ValueErrors that name the argument and what is right."""

import os
import re

import numpy as np
import pytest

import beamgyro as bg
from program import SCENARIOS

WARM_UP = SCENARIOS / "warm_up.toml"
NOMINAL = SCENARIOS / "devices/nominal.toml"
SMALL = SCENARIOS / "campaigns/small.toml"
CUBIC = SCENARIOS / "models/cubic.toml"

# Words of pybind11, of NumPy and of Python that say nothing to a user, and of
# the command line.
FOREIGN = re.compile(
    r"incompatible function|C\+\+ type|has no attribute|not iterable|/tmp/|"
    r"--[a-z]|\n|\bos\.PathLike|not subscriptable|could not convert")


@pytest.fixture(scope="module")
def given(sweeps, tmp_path_factory):
    """What calls are made with: files of all kinds, and what they hold."""
    folder = tmp_path_factory.mktemp("errors")
    before = os.getcwd()
    os.chdir(folder)  # names of files in messages are short
    run = bg.run(WARM_UP, set={"duration_s": 60})
    bg.save_recording(run, "run.h5")
    cubic = bg.train(CUBIC, sweeps[0])
    cubic.save("cubic.json")
    made = bg.generate(SMALL, "set", devices=4, progress=False)
    os.mkdir("folder")

    class Given:
        """Names that the calls below use."""

    Given.run, Given.sweep = run, sweeps[0]
    Given.cubic, Given.set = cubic, made
    Given.arrays = {name: run[name].values for name in run.variables}
    yield Given
    os.chdir(before)


def rates(signals):
    """A compensator that changes nothing."""
    return signals.rate


ARGUMENTS = [
    # Numbers
    (lambda g: bg.sensitivity(SMALL, samples=-1), "samples -1", "from 1"),
    (lambda g: bg.sensitivity(SMALL, samples=64.5), "samples 64.5", "whole"),
    (lambda g: bg.sensitivity(SMALL, seed=-1), "seed -1", "from 0"),
    (lambda g: bg.sensitivity(SMALL, jobs=-1), "jobs -1", "from 0"),
    (lambda g: bg.sensitivity(SMALL, range_degC=(1,)), "range_degC (1,)",
     "two numbers"),
    (lambda g: bg.sensitivity(SMALL, range_degC="ab"), "range_degC 'ab'",
     "two numbers"),
    (lambda g: bg.sensitivity(SMALL, range_degC=(1, 2, 3)),
     "range_degC (1, 2, 3)", "two numbers"),
    (lambda g: bg.sensitivity(SMALL, limits=5), "limits 5", "mapping"),
    (lambda g: bg.sensitivity(SMALL, limits={"bias_pp_deg_per_s": "1"}),
     "limits: bias_pp_deg_per_s '1'", "number"),
    (lambda g: bg.sensitivity(SMALL, linear="no"), "linear 'no'", "True"),
    (lambda g: bg.generate(SMALL, "new", devices=-1), "devices -1", "whole"),
    (lambda g: bg.generate(SMALL, "new", devices=1.5), "devices 1.5",
     "whole"),
    (lambda g: bg.generate(SMALL, "new", devices="2"), "devices '2'",
     "whole"),
    (lambda g: bg.generate(SMALL, "new", jobs=-1), "jobs -1", "whole"),
    (lambda g: bg.generate(SMALL, "new", jobs=10 ** 12), "jobs 1000000000000",
     "to 4096"),
    (lambda g: bg.generate(SMALL, "new", resume="no"), "resume 'no'", "True"),
    (lambda g: bg.Campaign(SMALL).device("a"), "device 'a'", "whole"),
    (lambda g: bg.run(WARM_UP, seed=-1), "seed -1", "from 0"),
    (lambda g: bg.run(WARM_UP, seed="a"), "seed 'a'", "whole"),
    (lambda g: bg.run(WARM_UP, stop_on_unlock="x"), "stop_on_unlock 'x'",
     "True or False"),
    (lambda g: bg.train(CUBIC, g.sweep, seed=1.5), "seed 1.5", "whole"),
    (lambda g: bg.train(CUBIC, g.sweep, cross_validation=3),
     "cross_validation 3", "text"),
    (lambda g: bg.train(CUBIC, g.set, devices=[-1]), "devices -1", "whole"),
    (lambda g: bg.train(CUBIC, g.set, set_runs=[1]), "set_runs [1]", "text"),
    (lambda g: bg.validate(g.cubic, g.sweep, jobs=1.5), "jobs 1.5", "whole"),
    (lambda g: bg.validate(g.cubic, g.sweep, full_scale="x"),
     "full_scale 'x'", "number"),
    (lambda g: bg.validate(g.cubic, g.sweep, require_provenance="no"),
     "require_provenance 'no'", "True or False"),
    (lambda g: bg.validate(g.cubic, set=g.set, set_devices=["a"]),
     "set_devices 'a'", "whole"),
    *[(lambda g, seed=seed: bg.validate(g.cubic, device=NOMINAL, seed=seed),
       f"seed {seed!r}", "whole") for seed in (-1, 1.5, "rnd", 2 ** 53)],
    (lambda g: bg.validate(g.cubic, device=NOMINAL, seeds=0), "seeds 0",
     "whole"),
    (lambda g: bg.allan(g.run, taus=[1, 2]), "taus [1, 2]", "octave"),
    (lambda g: bg.allan(g.run, kinds=[1]), "kinds [1]", "text"),
    (lambda g: bg.allan(g.run, column=3), "column 3", "text"),
    (lambda g: bg.allan(g.run, from_s="a"), "from_s 'a'", "number"),
    (lambda g: bg.allan([1.0] * 99, rate_Hz="a"), "rate_Hz 'a'", "number"),
    (lambda g: bg.allan(["a", "b"], rate_Hz=1), "data", "numbers"),
    (lambda g: bg.allan(None, rate_Hz=1), "data", "numbers"),
    (lambda g: bg.allan(g.cubic), "data: holds a Compensator", "numbers"),
    (lambda g: bg.allan(g.set), "data", "numbers"),
    (lambda g: bg.plan(g.cubic, NOMINAL, soaks=1.5), "soaks 1.5", "whole"),
    (lambda g: bg.plan(g.cubic, NOMINAL, hours="a"), "hours 'a'", "number"),
    (lambda g: bg.plan(g.cubic, NOMINAL, candidates=[1, 2]),
     "candidates", "one dimension"),
    (lambda g: bg.plan(g.cubic, NOMINAL, candidates=[["a"]]),
     "candidates", "numbers"),
    (lambda g: bg.export(g.cubic, "c", name=3), "name 3", "text"),
    (lambda g: bg.export(g.cubic, "c", force="x"), "force 'x'", "True"),
    (lambda g: bg.export(g.cubic, "px4", instance="a"), "instance 'a'",
     "whole"),
    (lambda g: bg.export(g.cubic, 3), "format 3", "text"),
    (lambda g: bg.characterise(NOMINAL, "a"), "beam_temperature", "numbers"),
    (lambda g: bg.characterise(NOMINAL, [[1, 2]]), "beam_temperature",
     "one dimension"),
    (lambda g: bg.characterise(NOMINAL, slice("a", 1, 1)),
     "beam_temperature 'a'", "number"),
    (lambda g: bg.Compensator("cmd:cat", stall_s="a"), "stall_s 'a'",
     "number"),
    (lambda g: bg.Compensator(rates, name=3), "name 3", "text"),
    (lambda g: bg.Compensator(rates, inputs=3), "inputs 3", "sequence"),
    (lambda g: bg.features(g.run, [3]), "inputs [3]", "text"),
    (lambda g: bg.training_rows(g.sweep, every_s="a"), "every_s 'a'",
     "number"),
    (lambda g: g.set.part("a"), "device 'a'", "whole"),
    (lambda g: g.set.recording(3, 0), "run 3", "text"),
    (lambda g: g.set.recording("warm_up", -1), "device -1", "whole"),
    # Names of files, and texts
    (lambda g: bg.open_recording("a\0b.h5"), r"'a\x00b.h5'", "NUL"),
    (lambda g: bg.save_recording(g.run, "a\0b.h5"), "path", "NUL"),
    (lambda g: bg.Device("\ud800.toml"), r"'\ud800.toml'", "surrogate"),
    (lambda g: bg.Device("\udcff.toml"), r"\xff.toml", "cannot read"),
    (lambda g: bg.Device.parse("\udcff"), "text", "surrogate"),
    (lambda g: bg.Device({"name": "\udcff"}), "name", "surrogate"),
    (lambda g: bg.Device(NOMINAL, {"name": "\udcff"}), "name", "surrogate"),
    (lambda g: bg.Device.parse("name = 1", name=3), "name 3", "text"),
    (lambda g: bg.Compensator.parse(3), "text 3", "text"),
    (lambda g: bg.open_recording(3), "path 3", "a recording"),
    (lambda g: bg.run(None), "scenario None", "mapping"),
    (lambda g: bg.Device(3), "device 3", "mapping"),
    (lambda g: bg.train(3, g.sweep), "model 3", "mapping"),
    (lambda g: g.cubic.save(3), "path 3", "file"),
    (lambda g: bg.open_recording(""), "path ''", "a recording"),
    (lambda g: bg.run(""), "scenario ''", "a scenario"),
    (lambda g: bg.open_set(""), "set ''", "the directory of a set"),
    (lambda g: bg.export(g.cubic, "c", ""), "directory ''", "directory"),
    (lambda g: bg.Compensator("cmd:a\0b"), "cmd:a", "PROGRAM"),
    (lambda g: bg.save_recording(g.run.assign_attrs(title="\udcff"), "a.h5"),
     "title", "surrogate"),
    (lambda g: bg.save_recording(g.run.rename(quadrature="\udcff"), "a.h5"),
     "variable", "surrogate"),
    (lambda g: bg.compensate(g.cubic, g.run.assign(
        rate=g.run.rate.assign_attrs(
        comment="\udcff"))), "comment", "surrogate"),
    (lambda g: bg.Device({"name": b"x"}), "name: b'x'", "text"),
    # Keys
    (lambda g: bg.run(WARM_UP, set="duration_s=5"), "set 'duration_s=5'",
     "mapping"),
    (lambda g: bg.Device(NOMINAL, ["a=b"]), "set ['a=b']", "mapping"),
    (lambda g: bg.Device(NOMINAL).with_("a"), "keys 'a'", "mapping"),
    (lambda g: bg.Scenario(WARM_UP).with_(3), "keys 3", "mapping"),
    # Things of another type
    (lambda g: bg.compensate(g.cubic, g.run.rate), "xarray.DataArray",
     "dataset"),
    (lambda g: bg.compensate(g.cubic, g.arrays), "recording {", "dataset"),
    (lambda g: bg.compensate(g.cubic, g.run.to_dataframe()),
     "pandas.DataFrame", "dataset"),
    (lambda g: bg.compensate(g.run, g.cubic), "compensator <xarray.Dataset>",
     "estimator"),
    (lambda g: bg.train(g.sweep, CUBIC), "model <xarray.Dataset>",
     "a model file"),
    (lambda g: bg.train(CUBIC, g.sweep.rate), "runs <xarray.DataArray",
     "recordings"),
    (lambda g: bg.train(CUBIC, 3), "runs 3", "recordings"),
    (lambda g: bg.train(CUBIC, [3]), "run 1 3", "dataset"),
    (lambda g: bg.train(CUBIC, g.arrays), "time <numpy.ndarray", "dataset"),
    (lambda g: bg.validate(g.cubic, g.set), "runs <beamgyro.Set>", "set="),
    (lambda g: bg.validate(g.sweep, g.cubic), "runs <beamgyro.Compensator>",
     "recordings"),
    (lambda g: bg.validate(g.cubic, {"../x": g.sweep}), "runs '../x'", "/"),
    (lambda g: bg.Scenario(g.run), "scenario <xarray.Dataset>", "mapping"),
    (lambda g: bg.save_recording(g.run.rate, "a.h5"),
     "dataset <xarray.DataArray", "run()"),
    (lambda g: bg.save_recording("a.h5", g.run), "dataset 'a.h5'", "run()"),
    (lambda g: bg.Compensator(dict), "class builtins.dict", "dict()"),
    # Work that cannot begin
    (lambda g: bg.run("absent.toml", device=NOMINAL), "absent.toml",
     "No such file"),
    (lambda g: bg.run("folder", device=NOMINAL), "folder", "directory"),
    (lambda g: bg.export(g.cubic, "c", "cubic.json"), "cubic.json",
     "directory"),
    # Words of the command line and names of temporary files
    (lambda g: bg.validate(g.cubic, g.sweep, spec={"name": 3}), "spec.toml:1",
     "text"),
    (lambda g: bg.validate(g.cubic, g.sweep.drop_vars("true_rate")), "run 1",
     "true_rate"),
    (lambda g: bg.plan(g.cubic, NOMINAL), "0 goals", "soaks=N"),
    (lambda g: bg.allan(g.run, from_s=5, to_s=1), "from_s=5 to_s=1", "below"),
    (lambda g: bg.export(g.cubic, "c", device_id=3), "device_id", "px4"),
    (lambda g: bg.run(WARM_UP, seed=2 ** 63), "seed 9223372036854775808",
     "to 9223372036854775807"),
    (lambda g: bg.run(WARM_UP, set={"duration_s": 5, "seed = 7 #": 5}),
     "key 'seed = 7 #'", "dotted"),
    *[(lambda g, name=name: bg.save_recording(g.run, name),
       f"path '{name}'", ".h5 or .csv")
      for name in ("a.CSV", "a.txt", "a", ".csv")],
    (lambda g: bg.run_to_file(WARM_UP, "a.txt"), "path 'a.txt'",
     ".h5 or .csv"),
    # Options that do not apply
    (lambda g: bg.validate(g.cubic, g.sweep, set_devices=[1]),
     "set_devices", "for a set"),
    (lambda g: bg.validate(g.cubic, g.sweep, set_runs=["warm_up"]),
     "set_runs", "for a set"),
    (lambda g: bg.validate(g.cubic, g.sweep, qualification="absent.toml"),
     "qualification", "for a simulated device"),
    (lambda g: bg.validate(g.cubic, g.sweep, seed="random"), "seed",
     "for a simulated device"),
    (lambda g: bg.validate(g.cubic, device=NOMINAL, seeds=10_001),
     "seeds=10001", "10000"),
    (lambda g: bg.train(CUBIC, g.sweep, devices=[3]), "devices [3]",
     "for a set"),
    (lambda g: bg.train(CUBIC, g.sweep, set_runs=["x"]), "set_runs ['x']",
     "for a set"),
    (lambda g: bg.training_rows(g.sweep, part="test"), "part 'test'",
     "for a set"),
    (lambda g: bg.Compensator(g.cubic, name="mine"), "name 'mine'",
     "for a function"),
    (lambda g: bg.Compensator("cubic.json", inputs=["rate"]),
     "inputs ['rate']", "for a function"),
    (lambda g: bg.generate(SMALL, "set", progress=False), "set:", "resume"),
    (lambda g: bg.validate(CUBIC, g.sweep), "cubic.toml", "device"),
    (lambda g: bg.run(WARM_UP, set={"duration_s": -1}), "set duration_s=-1",
     "-1"),
]


@pytest.mark.parametrize("call, met, right", ARGUMENTS)
def test_an_argument_that_is_wrong_is_named(call, met, right, given):
    with pytest.raises(ValueError) as raised:
        call(given)
    message = str(raised.value)
    assert met in message
    assert right in message
    assert len(message) < 450
    assert not FOREIGN.search(message.replace(str(SCENARIOS), "")), message


KINDS = [
    (lambda: bg.Compensator("run.h5"), "a recording", "a compensator"),
    (lambda: bg.Compensator(CUBIC), "a model file", "a compensator"),
    (lambda: bg.Compensator(NOMINAL), "a device file", "a compensator"),
    (lambda: bg.validate("run.h5", "run.h5"), "a recording", "a compensator"),
    (lambda: bg.plan("run.h5", NOMINAL, soaks=3), "a recording",
     "a compensator"),
    (lambda: bg.export("run.h5", "c"), "a recording", "a compensator"),
    (lambda: bg.open_recording("cubic.json"), "a compensator", "a recording"),
    (lambda: bg.open_recording("set"), "the directory of a set",
     "a recording"),
    (lambda: bg.Device("run.h5"), "a recording", "a device file"),
    (lambda: bg.Device(WARM_UP), "a scenario", "a device file"),
    (lambda: bg.Scenario(NOMINAL), "a device file", "a scenario"),
    (lambda: bg.Scenario("run.h5", device=NOMINAL), "a recording",
     "a scenario"),
    (lambda: bg.Campaign(NOMINAL), "a device file", "a campaign"),
    (lambda: bg.train(NOMINAL, "run.h5"), "a device file", "a model file"),
    (lambda: bg.train("run.h5", CUBIC), "a recording", "a model file"),
    (lambda: bg.train(CUBIC, "cubic.json"), "a compensator", "a recording"),
    (lambda: bg.open_set("run.h5"), "a recording", "the directory of a set"),
    (lambda: bg.validate("cubic.json", "run.h5", spec=NOMINAL),
     "a device file", "a specification"),
    (lambda: bg.validate("cubic.json", "run.h5", workbench="run.h5"),
     "a recording", "a compensator"),
    (lambda: bg.validate("cubic.json", device=NOMINAL, qualification=WARM_UP),
     "a scenario", "a qualification"),
    (lambda: bg.allan("cubic.json"), "a compensator", "a recording"),
    (lambda: bg.sensitivity(NOMINAL), "a device file", "a campaign"),
]


@pytest.mark.parametrize("call, met, right", KINDS)
def test_a_file_of_another_kind_is_called_by_its_kind(call, met, right,
                                                      given):
    with pytest.raises(ValueError,
                       match=f": is {met}; expected {right}"):
        call()


ONE_ALONE = [
    (lambda g: bg.allan(g.run, kinds="adev"), "kinds 'adev'"),
    (lambda g: bg.features(g.run, "temperature"), "inputs 'temperature'"),
    (lambda g: bg.training_rows(g.sweep, "temperature"),
     "inputs 'temperature'"),
    (lambda g: bg.Compensator(rates, inputs="rate"), "inputs 'rate'"),
    (lambda g: bg.train(CUBIC, g.set, set_runs="warm_up"),
     "set_runs 'warm_up'"),
    (lambda g: bg.train(CUBIC, g.set, devices=1), "devices 1"),
    (lambda g: bg.validate(g.cubic, set=g.set, set_runs="warm_up"),
     "set_runs 'warm_up'"),
    (lambda g: bg.validate(g.cubic, set=g.set, set_devices=3),
     "set_devices 3"),
    (lambda g: bg.sensitivity(SMALL, figures="bias_pp_deg_per_s"),
     "figures 'bias_pp_deg_per_s'"),
    (lambda g: bg.export(g.cubic, "px4", axes="x"), "axes 'x'"),
    (lambda g: bg.plan(g.cubic, NOMINAL, candidates="ab"),
     "candidates 'ab'"),
]


@pytest.mark.parametrize("call, met", ONE_ALONE)
def test_one_value_is_no_sequence_of_them(call, met, given):
    value = met.partition(" ")[2]
    with pytest.raises(ValueError) as raised:
        call(given)
    assert str(raised.value).startswith(met)
    assert f"a sequence, such as [{value}]" in str(raised.value)


def test_a_lone_sample_is_compensated_and_judged(given):
    lone = given.sweep.isel(time=[0])
    answer = bg.compensate(given.cubic, lone)
    first = bg.compensate(given.cubic, given.sweep).compensated_rate[0]
    assert float(answer.compensated_rate[0]) == float(first)
    check = bg.validate(given.cubic, lone).checks["real_time"]
    assert check["passed"] is not False, check


@pytest.mark.parametrize("key", [
    "warm_up", 0, None, ("warm_up",), ("warm_up", 0, 1), ("warm_up", 99),
    ("warm_up", -1), ("warm_up", "a"), ("absent", 0), ("warm_up", True),
    (["warm_up"], 0)])
def test_a_set_is_a_mapping_of_run_and_device(key, given):
    assert key not in given.set
    assert given.set.get(key) is None
    with pytest.raises(KeyError, match="expected \\(run, device\\)"):
        given.set[key]
    assert ("warm_up", 0) in given.set
    assert ("warm_up", np.int64(0)) in given.set


def absent_key(signals):
    """A compensator with an error of its own."""
    return {}[signals.rate.size]


WHERE = [
    (lambda g, f: bg.compensate(f, g.run), "the 600 samples from 0 s$"),
    (lambda g, f: bg.validate(f, "run.h5"), "from 0 s of run.h5$"),
    (lambda g, f: bg.validate(f, {"mine": g.run}), "from 0 s of mine.h5$"),
    (lambda g, f: bg.validate(f, device=NOMINAL), "from 0 s of soaks$"),
    (lambda g, f: bg.validate(f, set=g.set), "of warm_up of device [0-3]$"),
]


@pytest.mark.parametrize("call, where", WHERE)
def test_errors_of_a_function_stay_and_tell_where(call, where, given):
    with pytest.raises(KeyError) as raised:
        call(given, absent_key)
    note, = raised.value.__notes__
    assert "the answer of absent_key to the" in note
    assert re.search(where, note)
    assert raised.traceback[-1].name == "absent_key"


@pytest.mark.parametrize("call, where", WHERE)
def test_a_wrong_answer_is_told_with_its_run(call, where, given):
    def single_sigma(signals):
        return signals.rate, 1.0

    with pytest.raises(ValueError) as raised:
        call(given, single_sigma)
    asked, _, wrong = str(raised.value).rpartition(": has the shape ()")
    assert asked.startswith("the answer of single_sigma to the")
    assert re.search(where, asked)
    assert "expected one dimension" in wrong


def test_a_sigma_below_zero_is_told_with_its_run(given):
    def odd(signals):
        return signals.rate, -abs(signals.rate)

    with pytest.raises(ValueError, match="odd.*0 s. of mine.h5"):
        bg.validate(odd, {"mine": given.run})


def test_an_interrupt_in_a_function_of_the_user_stays(given):
    def interrupted(signals):
        raise KeyboardInterrupt

    for call, _ in WHERE:
        with pytest.raises(KeyboardInterrupt):
            call(given, interrupted)


def test_a_refused_set_leaves_no_directory(given):
    with pytest.raises(ValueError):
        bg.generate(SMALL, "refused", jobs=-1)
    with pytest.raises(ValueError):
        bg.generate(WARM_UP, "refused")
    assert not os.path.exists("refused")


PICTURES = [
    (lambda g: bg.plots.plot({"rate": np.ones(3)}), "^recording: no variable"),
    (lambda g: g.run.drop_vars("time").beamgyro.plot(),
     "^recording: no variable time"),
    (lambda g: bg.plots.plot(3), "^int: has no picture; expected the name"),
    (lambda g: bg.plots.plot([None]), "^NoneType: has no picture"),
    (lambda g: bg.plots.plot("a\0b"), "NUL"),
    (lambda g: bg.plots.plot(["run.h5", "run.h5"]), "compare=True"),
    (lambda g: bg.plots.plot(["run.h5"], compare=True), "compare=True"),
]


@pytest.mark.parametrize("call, words", PICTURES)
def test_what_has_no_picture_is_named(call, words, given):
    pytest.importorskip("matplotlib")
    with pytest.raises(ValueError, match=words):
        call(given)


@pytest.mark.parametrize("name", [
    "my run --limit 3.h5", "run --rate-Hz 5.h5", "cold --force.h5",
    "--" + "a" * 200])
def test_names_of_the_user_are_repeated_as_they_are(name):
    with pytest.raises(ValueError) as raised:
        bg.open_recording(name)
    assert name in str(raised.value)


def test_a_long_word_in_a_message_is_no_harm(given):
    command = "cmd:sh -c 'echo --" + "a" * 60000 + "'"
    with pytest.raises(RuntimeError, match="--aaa"):
        bg.compensate(command, given.run)
