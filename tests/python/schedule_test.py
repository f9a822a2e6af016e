# SPDX-License-Identifier: MIT
"""Plans of soaks, by the package and by the command."""

import pytest

import beamgyro as bg
from plan_test_population import population_of
from program import PROGRAM, SCENARIOS, said


@pytest.fixture(scope="module", name="population")
def make_population(tmp_path_factory):
    return population_of(tmp_path_factory.mktemp("a population"))


@pytest.fixture(scope="module", name="planned")
def make_plan(population):
    return bg.plan(population, SCENARIOS / "devices/nominal.toml", soaks=4,
                   candidates=[[-30, 0, 20, 45]])


def test_a_plan_is_that_of_the_command(population, planned, tmp_path):
    told = said(PROGRAM, "plan", population, "--soaks", 4, "--candidates",
                "-30,0,20,45", "--json", "plan.json", cwd=tmp_path)
    assert planned.to_json() == (tmp_path / "plan.json").read_text()
    assert str(planned) == told


def test_a_schedule_is_a_scenario_that_runs(planned):
    recording = bg.run(planned.schedule, set={"output_rate_Hz": 0.1})
    assert recording.sizes["time"] == pytest.approx(
        planned.data["schedule"]["hours"] * 360, rel=0.2)
    for temperature in planned.temperatures_degC:
        # The board heats the sensor above the chamber.
        assert (abs(recording.true_ambient_temperature - temperature)
                < 0.01).any()


def test_a_goal_is_needed(population):
    device = SCENARIOS / "devices/nominal.toml"
    with pytest.raises(ValueError, match="soaks"):
        bg.plan(population, device)
    with pytest.raises(ValueError, match="degC"):
        bg.plan(population, device, soaks=3, range_degC=(50, -40))
