// SPDX-License-Identifier: MIT
#include "planning/chamber.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "planning/schedule_file.h"
#include "planning/soak_length.h"
#include "sim/thermal/thermal_parameters.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::chamber_test {
namespace {

TEST(ChamberTime, WayStartsAtTheNearerEnd) {
  EXPECT_EQ(in_visiting_order({-40, 50, 5}, 25),
            (std::vector<double>{50, 5, -40}));
  EXPECT_EQ(in_visiting_order({-35, -9, -23}, 25),
            (std::vector<double>{-9, -23, -35}));
  EXPECT_EQ(in_visiting_order({30, 40}, 25), (std::vector<double>{30, 40}));
  EXPECT_EQ(shortest_way({-40, 50, 5}, 25), 25 + 90);
  EXPECT_EQ(shortest_way({-35, -9}, 25), 60);
  EXPECT_EQ(shortest_way({}, 25), 0);
}

TEST(ChamberTime, HoursAreThoseOfTheVisits) {
  const ChamberTime time{25, 2, 1800};
  const std::vector<double> soaks = {-40, 50, 5};
  // 115 K at 2 K/min and three half hours.
  EXPECT_DOUBLE_EQ(chamber_hours(soaks, time), 115.0 / 2 / 60 + 1.5);
  const std::vector<Visit> stops = visits(soaks, time);
  ASSERT_EQ(stops.size(), 3U);
  EXPECT_DOUBLE_EQ(stops[0].begin, 750);
  EXPECT_DOUBLE_EQ(stops[1].begin, 750 + 1800 + 45 * 30);
  EXPECT_DOUBLE_EQ(stops[2].end, 3600 * chamber_hours(soaks, time));
}

TEST(ChamberView, InverseReturnsTheChamber) {
  const ChamberView view({});
  const double sensor = view.sensor_temperature(-40);
  EXPECT_GT(sensor, -40);  // the electronics heat it
  EXPECT_NEAR(view.chamber_temperature(sensor), -40, 1e-6);
}

TEST(ChamberView, RefusesAnOven) {
  ThermalParameters heated;
  heated.oven.emplace();
  EXPECT_THROW(ChamberView{heated}, std::invalid_argument);
}

TEST(SoakLength, LagFollowsTheSlowestMassAndSoak) {
  const ThermalParameters nominal;
  ThermalParameters slow;
  slow.beam_heat_capacity *= 2;
  const ChamberTime time{25, 2, 0};
  const auto usual = slowest_rows(nominal, -40, time, {});
  const auto late = slowest_rows(slow, -40, time, {});
  EXPECT_GT(late[59].mean_lag, 1.5 * usual[59].mean_lag);
  EXPECT_LT(usual[119].mean_lag, usual[59].mean_lag);
  // Slower than the parameters say, and than a soak that is nearer.
  EXPECT_GT(usual[59].mean_lag,
            rows_over_time(nominal, 25, -40, 2, {})[59].mean_lag);
  EXPECT_GT(usual[59].mean_lag,
            slowest_rows(nominal, 20, time, {})[59].mean_lag);
}

TEST(SoakLength, LagOfAShortRampIsThatOfALongOneLessAnEarlierOne) {
  // A lag of 4 K that decays with a time constant of 10 min, rows from 8 min
  // on.
  std::vector<SoakRows> rows;
  double sum = 0.0;
  for (int minute = 1; minute <= 200; ++minute) {
    if (minute > 8) sum += 4.0 * std::exp(-minute / 10.0);
    const int count = std::max(minute - 8, 0);
    rows.push_back({count, count > 0 ? sum / count : 0.0});
  }
  // Of a ramp of 5 min: 1 - exp(-5 / 10) of a long one.
  const auto lag = [&](std::size_t ramp) {
    return mean_after_ramp(rows, 30, ramp, &SoakRows::mean_lag);
  };
  EXPECT_NEAR(lag(5) / rows[29].mean_lag, 1 - std::exp(-0.5), 1e-9);
  EXPECT_NEAR(lag(1000), rows[29].mean_lag, 1e-6);
  EXPECT_EQ(lag(0), 0.0);
}

TEST(SoakLength, RowsRestWhereTheBeamIsAndNotYetWhereItSettles) {
  // After a ramp down the rows without the lag are warmer than they will be.
  const double lag = lag_minutes({}, 25, 2, kSteady);
  const auto rows = rows_over_time({}, 25, -40, 2, {kSteady, lag});
  ASSERT_GE(rows[19].rows, kLeastSteadyRows);
  EXPECT_GT(rows[19].mean_rest, 0.3);
  EXPECT_LT(rows[119].mean_rest, 0.5 * rows[19].mean_rest);
  // After a ramp up they are colder.
  EXPECT_LT(rows_over_time({}, 25, 50, 2, {kSteady, lag})[19].mean_rest, -0.3);
}

TEST(SoakLength, ARoundedTemperatureIsWorseReadWithALag) {
  EXPECT_NEAR(temperature_noise(0.12, {kSteady, 0.0}), 0.12 / std::sqrt(12.0),
              1e-12);
  // 8 min times a rate over 2 min, of two rounded temperatures.
  EXPECT_NEAR(temperature_noise(0.12, {kSteady, 8.0}),
              0.12 / std::sqrt(12.0) * std::sqrt(1.0 + 2.0 * 16.0), 1e-12);
}

TEST(SoakLength, RowsReadWithTheLagOfTheDeviceNeedNotBeSettled) {
  const double lag = lag_minutes({}, 25, 2, kSteady);
  ThermalParameters slow;
  slow.beam_heat_capacity *= 2;
  EXPECT_GT(lag_minutes(slow, 25, 2, kSteady), lag + 2);
  for (const double soak : {-40.0, 10.0, 50.0}) {
    const auto as_read = rows_over_time({}, 25, soak, 2, {kSteady, 0.0});
    const auto rows = rows_over_time({}, 25, soak, 2, {kSteady, lag});
    ASSERT_GE(rows[19].rows, kLeastSteadyRows);
    EXPECT_LT(std::abs(rows[19].mean_lag),
              0.35 * std::abs(as_read[19].mean_lag))
        << soak;
  }
}

TEST(StartRow, IsWhereHeatOfTheElectronicsAndRampAreInBalance) {
  const RowRule rule = {kSteady, lag_minutes({}, 25, 2, kSteady)};
  const auto row = start_row({}, -40, {25, 2, 0}, rule);
  ASSERT_TRUE(row);
  // The beam is at 25 degC then, 2 to 3 K above the chamber once it is settled.
  const ChamberView view({});
  const double settled = view.sensor_temperature(row->temperature) +
                         view.beam_excess(row->temperature) + row->lag;
  EXPECT_NEAR(settled, 25, 0.3);
  EXPECT_LT(std::abs(row->lag), 1.0);
  EXPECT_TRUE(has_start_row({-20, 0}, 25, *row));
  EXPECT_FALSE(has_start_row({-20, 50}, 25, *row));  // first up
  EXPECT_FALSE(has_start_row({24}, 25, *row));       // there before
  // No ramp down, and one that is all steady.
  EXPECT_FALSE(start_row({}, 30, {25, 2, 0}, rule));
  EXPECT_FALSE(start_row({}, -40, {25, 0.1, 0}, rule));
}

TEST(SoakLength, LagDecaysToTheSettledBeam) {
  const auto rows = rows_over_time({}, 25, -40, 2, {});
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(kLongestSoak));
  EXPECT_EQ(rows.front().rows, 0);        // the sensor still follows the ramp
  EXPECT_GT(rows.back().rows, 300);       // steady for most of six hours
  EXPECT_LT(rows.back().mean_lag, 0.02);  // the first rows weigh little
}

TEST(ScheduleText, NamesTheDeviceInTomlAndEndsWithTheLastSoak) {
  const std::string text =
      schedule_text({-9, -23}, {25, 2, 1800}, {0.2, 7.5}, "a \"b\"\\c.toml");
  EXPECT_TRUE(holds(text, "device = \"a \\\"b\\\"\\\\c.toml\"\n"));
  EXPECT_TRUE(holds(text, "duration_s = 5040\n"));  // 48 K and an hour
  EXPECT_TRUE(holds(text, "#    0:17 to  0:47  hold -9 degC\n"));
}

}  // namespace
}  // namespace beamgyro::internal::chamber_test
