// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "compensation/methods/population.h"
#include "compensation/methods/population_own.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::population_json_test {
namespace {

using Json = nlohmann::ordered_json;

Population with_own_parts() {
  Population p;
  p.channels = {parse_input("quadrature")};
  p.temperatures = Eigen::ArrayXd::LinSpaced(4, -40.0, 50.0);
  p.mean = Eigen::VectorXd::LinSpaced(8, 0.0, 0.7);
  p.modes = Eigen::MatrixXd::Constant(8, 1, 0.5);
  p.devices = 30;
  p.own = {{0.02, 10.0}, {0.5, 20.0}};
  p.point_noise = 0.004;
  p.run_noise = 0.005;
  p.sweeps = {2.0, 870.0};
  return p;
}

Population read(const Json& json) {
  return read_population(JsonNode(json, "mine.json"));
}

TEST(PopulationJson, OwnPartsAndNoiseComeBack) {
  const Population p = with_own_parts();
  const Population back = read(population_json(p));
  EXPECT_EQ(back.point_noise, p.point_noise);
  EXPECT_EQ(back.run_noise, p.run_noise);
  EXPECT_EQ(back.sweeps->of_each_device, 2.0);
  EXPECT_EQ(back.sweeps->seconds_per_K, 870.0);
  EXPECT_EQ(all_modes(back), all_modes(p));
  EXPECT_EQ(all_modes(back).cols(), 1 + 4 + 4);
}

// Files of older programs have neither.
TEST(PopulationJson, WithoutThemDevicesHaveNothingOfTheirOwn) {
  Json json = population_json(with_own_parts());
  json.erase("own");
  json.erase("run_noise_deg_per_s");
  EXPECT_EQ(read(json).run_noise, 0.004);
  json.erase("point_noise_deg_per_s");
  json.erase("sweeps");
  const Population back = read(json);
  EXPECT_TRUE(back.own.empty());
  EXPECT_EQ(back.point_noise, 0.03);
  EXPECT_FALSE(back.sweeps.has_value());
}

TEST(PopulationJson, RefusesOwnPartsThatAreNone) {
  const auto message = [](const std::function<void(Json&)>& damage) {
    Json json = population_json(with_own_parts());
    damage(json);
    return rejection([&] { read(json); });
  };
  EXPECT_TRUE(holds(message([](Json& j) { j["own"].erase(1); }),
                    "mine.json: own: 1 own parts, must be none or 2"));
  EXPECT_TRUE(holds(message([](Json& j) { j["own"][0]["deviation"] = -1; }),
                    "own[0].deviation: -1, must not be negative"));
  EXPECT_TRUE(holds(message([](Json& j) { j["sweeps"]["s_per_K"] = 0; }),
                    "sweeps.s_per_K: 0"));
  EXPECT_TRUE(holds(message([](Json& j) { j["own"][1]["length_K"] = 0; }),
                    "own[1].length_K"));
  EXPECT_TRUE(holds(message([](Json& j) { j["own"][1]["L"] = 1; }), "own[1]"));
  EXPECT_TRUE(holds(message([](Json& j) { j["point_noise_deg_per_s"] = 0; }),
                    "point_noise_deg_per_s"));
  EXPECT_TRUE(holds(message([](Json& j) { j["run_noise_deg_per_s"] = 0; }),
                    "run_noise_deg_per_s"));
}

}  // namespace
}  // namespace beamgyro::internal::population_json_test
