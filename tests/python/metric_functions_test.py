# SPDX-License-Identifier: MIT
"""Metrics of the user's own, as functions of Python."""

import math

import numpy as np
import pytest

import beamgyro as bg
from compensators_test import short_qualification
from program import SCENARIOS

CUBIC = SCENARIOS / "models/cubic.toml"


def largest(runs):
    """The largest error of the judged rate."""
    return max(np.nanmax(np.abs(run.rate - run.true_rate)) for run in runs)


def spec(name, relative_to=None, **limit):
    limits = {"own": {name: {**limit, "source": "a test"}}}
    return {"name": "own", "not_tested": "does not decide",
            **({"limits": limits} if relative_to is None
               else {"limits_relative_to": {relative_to: limits}})}


@pytest.fixture(scope="module")
def cubic(sweeps):
    return bg.train(CUBIC, sweeps[0])


def test_a_function_is_a_metric_before_and_after(sweeps, cubic):
    test = sweeps[1]
    result = bg.validate(cubic, test, metrics={"worst": (largest, "deg/s"),
                                               "samples": len},
                         spec=spec("worst", max=1e3))
    found = result.metrics["worst"]
    error = np.abs(test.rate - test.true_rate)
    answer = bg.compensate(cubic, test).compensated_rate - test.true_rate
    assert found["unit"] == "deg/s"
    assert found["before"] == {"value": float(error.max()), "interval": None}
    assert found["after"]["value"] == float(np.abs(answer).max())
    assert found["result"] == "pass"
    assert result.metrics["samples"]["after"]["value"] == 1.0
    assert result.data["own_metrics"] == [found, result.metrics["samples"]]
    limit = result.data["limits"][0]
    assert limit["own"] and "it has no interval" in limit["words"]
    assert "own metric" in str(result) and "worst" in result._repr_html_()
    assert '"own_metrics":[{"name":"worst"' in result.to_html()


def test_a_function_sees_the_columns_of_every_run(sweeps, cubic):
    seen = []
    bg.validate(cubic, {"a": sweeps[1], "b": sweeps[2]},
                metrics={"mine": lambda runs: seen.append(runs) or 1})
    assert len(seen) == 2  # the recorded rate, then the compensated one
    for runs in seen:
        assert [run.purpose for run in runs] == ["ramp", "ramp"]
        for run, sweep in zip(runs, sweeps[1:]):
            for name in "time", "temperature", "rate", "true_rate":
                np.testing.assert_array_equal(run[name], sweep[name])
            np.testing.assert_array_equal(run.time, sweep.time)
    before, after = seen
    np.testing.assert_array_equal(before[0].rate, sweeps[1].rate)
    np.testing.assert_array_equal(
        after[1].rate, bg.compensate(cubic, sweeps[2]).compensated_rate)
    with pytest.raises(KeyError, match="temperatur'.*expected one of time"):
        before[0]["temperatur"]


def test_limits_decide_by_the_value_itself(sweeps, cubic):
    def verdict(value, **limit):
        return bg.validate(cubic, sweeps[1], metrics={"mine": value},
                           spec=spec("mine", **limit))

    assert verdict(lambda runs: 2, max=2).passed
    failed = verdict(lambda runs: 2.001, max=2)
    assert failed.verdict == "fail" and "Not met: mine" in str(failed)
    for none in None, math.nan, math.inf, np.float32("nan"):
        open_one = verdict(lambda runs, none=none: none, max=2)
        assert open_one.verdict == "undecided"
        assert "has no finite value" in open_one.data["limits"][0]["words"]
        assert open_one.metrics["mine"]["after"]["value"] is None
    share = bg.validate(cubic, sweeps[1], metrics={"mine": largest},
                        spec=spec("mine", "before", max=0.9))
    assert share.passed


def test_what_is_wrong_is_said(sweeps, cubic):
    def refused(error, says, metrics, **options):
        with pytest.raises(error, match=says):
            bg.validate(cubic, sweeps[1], metrics=metrics, **options)

    refused(ValueError, "metrics.*mapping of names", [largest])
    refused(ValueError, "'mine'.*a function", {"mine": 3})
    refused(ValueError, "no name of a metric", {"my metric": largest})
    refused(ValueError, "name of a metric of the program",
            {"scale_factor": largest})
    refused(ValueError, "unit ''", {"mine": (largest, "")})
    refused(ValueError, "mine returned 'much'; expected a number",
            {"mine": lambda runs: "much"})
    refused(ValueError, "mine returned True", {"mine": lambda runs: True})
    refused(ValueError, "did you mean 'worst'", {"worst": largest},
            spec=spec("wurst", max=1))
    refused(ValueError, "expected one to be given", {}, spec=spec("a", max=1))
    with pytest.raises(ZeroDivisionError) as raised:
        bg.validate(cubic, sweeps[1], metrics={"mine": lambda runs: 1 / 0})
    assert "the metric mine" in "".join(raised.value.__notes__)


def test_functions_are_evaluated_with_every_seed_and_beside_another(tmp_path):
    on = short_qualification(tmp_path)
    names = []

    def mine(runs):
        names.append([run.name for run in runs])
        return largest(runs)

    trained = bg.validate(CUBIC, **on).trained
    trained.save(tmp_path / "same.json")
    result = bg.validate(trained, seeds=3, metrics={"mine": mine},
                         spec=spec("mine", max=1e-6), **on)
    assert len(names) == 6 and {"ramp", "warm_up"} == {*names[0]}
    assert result.data["seeds"]["failed"] == 3
    beside = bg.validate(trained, against=tmp_path / "same.json",
                         metrics={"mine": mine}, spec=spec("mine", max=1e6),
                         **on).data
    assert ([one["compared"] for one in beside["limits"]]
            == [one["compared"] for one in beside["against"]["limits"]])
    with pytest.raises(ValueError, match="metrics.*expected no campaign"):
        bg.validate(trained, campaign=tmp_path / "c.toml",
                    metrics={"mine": mine}, **on)


def test_a_table_is_taken_by_name(sweeps, cubic, tmp_path):
    (tmp_path / "own.csv").write_text(
        "name,unit,before,after,low,high\nclimb,m,9,2,,1\n")
    result = bg.validate(cubic, sweeps[1], own_metrics=tmp_path / "own.csv")
    assert result.verdict == "fail"
    assert result.metrics["climb"]["after"]["value"] == 2
    with pytest.raises(ValueError, match="climb: is the name of two metrics"):
        bg.validate(cubic, sweeps[1], own_metrics=tmp_path / "own.csv",
                    metrics={"climb": largest})
