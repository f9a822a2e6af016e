// SPDX-License-Identifier: MIT
#include "include/beamgyro/curves.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::curves_api_test {
namespace {

const std::filesystem::path kScenarios = BEAMGYRO_SCENARIOS;

beamgyro::Campaign small(std::uint32_t devices) {
  return beamgyro::Campaign::read(kScenarios / "campaigns/small.toml", devices);
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST(PublicCurves, AreThoseOfEachDeviceWithAnyNumberOfThreads) {
  const beamgyro::Campaign campaign = small(5);
  const std::vector<double> grid = even_temperatures(-20, 50, 10);
  const CampaignCurves curves = characterise(campaign, grid, {.jobs = 1});
  EXPECT_EQ(characterise(campaign, grid, {.jobs = 3}).csv, curves.csv);
  ASSERT_EQ(curves.devices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  const Characteristic third = characterise(campaign.device(3), grid);
  for (std::size_t i = 0; i < third.columns.size(); ++i) {
    EXPECT_EQ(curves.columns[i].name, third.columns[i].name);
    const auto begin = curves.columns[i].values.begin() + 3 * 8;
    EXPECT_EQ(std::vector<double>(begin, begin + 8), third.columns[i].values);
  }
}

TEST(PublicCurves, StopWhenTheProgressSaysSo) {
  const std::vector<double> grid = {25};
  EXPECT_THROW(
      characterise(small(5), grid, {.progress = [](double) { return false; }}),
      Cancelled);
}

TEST(PublicCurves, OfNoAndOfTooManyTemperaturesAreRefused) {
  EXPECT_THROW(characterise(small(2), {}), std::invalid_argument);
  EXPECT_THROW(characterise(small(2), std::array{160.0}),
               std::invalid_argument);
  const std::vector<double> many(4000000, 25.0);
  EXPECT_THROW(characterise(small(3), many), std::invalid_argument);
}

TEST(PublicCurves, AreWrittenWholeTheSameAgainAndNowhereElse) {
  const TestDirectory folder;
  const beamgyro::Campaign campaign = small(3);
  const CampaignCurves curves = characterise(campaign, std::array{0.0, 25.0});
  for (const char* name : {"a.h5", "b.h5", "c.csv"})
    write_curves(curves, campaign, folder.directory / name);
  EXPECT_EQ(bytes_of(folder.directory / "c.csv"), curves.csv);
  EXPECT_EQ(bytes_of(folder.directory / "a.h5"),
            bytes_of(folder.directory / "b.h5"));
  EXPECT_THROW(
      write_curves(curves, campaign, folder.directory / "nowhere/a.h5"),
      std::invalid_argument);
  EXPECT_EQ(folder.names(), (std::set<std::string>{"a.h5", "b.h5", "c.csv"}));
}

TEST(PublicCurveFigures, OfValuesThatDoNotFitAreRefused) {
  const std::vector<double> grid = even_temperatures(0, 9, 1);
  const std::vector<std::uint32_t> unit = {0};
  std::vector<double> curve(10, 1.0);
  EXPECT_NO_THROW(curve_figures(grid, curve, unit));
  EXPECT_THROW(curve_figures(grid, {}, {}), std::invalid_argument);
  EXPECT_THROW(curve_figures(grid, curve, std::vector<std::uint32_t>{0, 1}),
               std::invalid_argument);
  EXPECT_THROW(curve_figures(grid, curve, unit, {.lowest_degC = 3.0}),
               std::invalid_argument);
  EXPECT_THROW(curve_figures(grid, curve, unit, {.lowest_degC = NAN}),
               std::invalid_argument);
  EXPECT_THROW(curve_figures(grid, curve, unit, {.zero_at_degC = NAN}),
               std::invalid_argument);
  EXPECT_THROW(curve_figures(grid, curve, unit, {.round_deg_per_s = -1.0}),
               std::invalid_argument);
  curve[4] = INFINITY;
  EXPECT_THROW(curve_figures(grid, curve, unit), std::invalid_argument);
}

}  // namespace beamgyro::internal::curves_api_test
