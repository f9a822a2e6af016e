// SPDX-License-Identifier: MIT
#include "tests/compensation/sample_compensators.h"

#include "random/random_stream.h"
#include "tests/compensation/bias_curve.h"

namespace beamgyro::internal {
namespace {

BiasModel baseline() {
  return {{{5.0, 45.0}}, {}, Polynomial{{1.0 / 3.0, 2e-300, -0.1}}};
}

Provenance some_provenance() {
  Provenance p;
  p.method = "BP network 6-4";
  p.training = {{"a \"b\".h5", std::string(64, 'a')}};
  p.held_out = {{"held.h5", std::string(64, 'b'), "", {}, 0}};
  p.model_text = "# model\nkind = \"bp\"\n";
  p.seed = 18446744073709551615u;
  p.stop_reason = "the gradient vanished";
  p.choices = {"weight decay 1e-06: held-out rms 0.1 deg/s"};
  p.warnings = {"the temperature spans 8.0 K in training"};
  p.cross_validated = CrossValidated{
      "leg", 2, 0.125, 1.0 / 9.0, 2.0, {0.1, 1.0 / 7.0}, {2.0, 1.9}};
  p.in_sample_rms = 1.0 / 7.0;
  p.held_out_rms = 2.0 / 7.0;
  p.baseline_in_sample_rms = 0.4;
  p.constant_in_sample_rms = 1.5;
  return p;
}

FittedCompensator of_temperature(const BiasModel& bias) {
  FittedCompensator c;
  c.inputs = {parse_input("temperature")};
  c.bias = bias;
  c.baseline = baseline();
  c.temperature_range = {-40.0, 50.0};
  c.provenance = some_provenance();
  return c;
}

FittedCompensator with_inputs(const std::vector<std::string>& names,
                              const std::vector<Scale>& scales) {
  FittedCompensator c = of_temperature({scales, {0.1, 2.3}, NoBias{}});
  c.inputs.clear();
  for (const std::string& name : names) c.inputs.push_back(parse_input(name));
  return c;
}

FittedCompensator every_input() {
  FittedCompensator c = with_inputs(
      {"temperature", "temperature_lowpass(100)", "temperature_rate(60)",
       "temperature_play(2)", "since_power_on(300)", "drive_frequency",
       "drive_voltage", "quadrature", "quadrature_lowpass(20)",
       "drive_voltage_lowpass(20)", "rate"},
      {{5.0, 45.0},
       {5.0, 45.0},
       {0.0, 0.05},
       {5.0, 45.0},
       {0.5, 0.5},
       {9156.0, 12.0},
       {1.5, 0.7},
       {40.0, 25.0},
       {40.0, 25.0},
       {1.5, 0.7},
       {0.0, 150.0}});
  c.bias.function = random_network({11, 5, 1});
  c.scale_factor = LookupTable{Eigen::ArrayXd::LinSpaced(7, -35.0, 45.0),
                               Eigen::ArrayXd::LinSpaced(7, 0.98, 1.03)};
  return c;
}

}  // namespace

BpNetwork random_network(const std::vector<int>& layers, std::uint64_t seed,
                         std::uint32_t run) {
  RandomStream random(seed, 0, run, kInitialWeightsStream);
  BpNetwork network(layers);
  network.randomise(random);
  return network;
}

Eigen::ArrayXXd wavy_inputs(Eigen::Index rows, Eigen::Index inputs) {
  return Eigen::ArrayXXd::NullaryExpr(rows, inputs, [](auto i, auto j) {
    return std::sin(1.0 + 3.0 * double(i) + double(j));
  });
}

FittedCompensator network_compensator() {
  FittedCompensator c = with_inputs(
      {"temperature", "temperature_lowpass(0.1)", "since_power_on(300)"},
      {{20.1, 3.3}, {20.2, 3.7}, {0.5, 0.5}});
  c.bias.function = random_network({3, 6, 4, 1});
  c.temperature_range = {1.0 / 3.0, 50.7};
  return c;
}

FittedCompensator spline_compensator() {
  const Eigen::ArrayXd knots = grid(-40.0, 50.0, 90.0 / 13.0);
  return of_temperature({{Scale{}},
                         {},
                         fit_cubic_spline(knots, bias_curve(knots), knots,
                                          SplineEnd::kNotAKnot)});
}

FittedCompensator with_sigma(FittedCompensator c) {
  const auto [lowest, highest] = c.temperature_range;
  BiasSigma& sigma = c.sigma.emplace();
  sigma.curve = {Eigen::ArrayXd::LinSpaced(4, lowest, highest),
                 Eigen::ArrayXd{{0.1, 1.0 / 3.0, 0.05, 0.2}}};
  sigma.growth = {0.02, 0.07};
  sigma.power_on = SigmaTerm{0.31, 120.0};
  sigma.temperature_rate = SigmaTerm{7.7, 250.0};
  sigma.factor = 1.1;
  sigma.source = SigmaSource::kPosterior;
  sigma.calibration = {"in words", "device", 92, 0.9, 1.52};
  return c;
}

std::vector<NamedCompensator> one_of_each_kind() {
  const Eigen::ArrayXd T = grid(-40.0, 50.0, 5.0), b = bias_curve(T);
  FittedCompensator slopes = with_inputs(
      {"temperature", "temperature_rate(60)"}, {{5, 45}, {0, 0.03}});
  slopes.bias.function = Polynomial{{0.3, -0.2, 0.1, 1.7}, {0.25}};
  FittedCompensator fuzzy =
      with_inputs({"temperature", "quadrature"}, {{5, 45}, {40, 25}});
  TakagiSugeno rules{Eigen::ArrayXd::LinSpaced(5, -1.0, 1.0), 0.25,
                     Eigen::MatrixXd(5, 3)};
  for (Eigen::Index k = 0; k < rules.consequents.size(); ++k)
    rules.consequents.reshaped()(k) = 0.37 * static_cast<double>(k % 7) - 1.0;
  fuzzy.bias.function = rules;
  FittedCompensator bells =
      with_inputs({"temperature", "quadrature"}, {{5, 45}, {40, 25}});
  RadialBasis basis{Eigen::MatrixXd(3, 2), 0.6, Eigen::Vector3d(0.2, -0.4, 0.1),
                    Eigen::Vector3d(1.5, -0.7, 0.3)};
  basis.centres << -0.8, 0.1, 0.0, 0.9, 0.7, -0.5;
  bells.bias.function = basis;
  FittedCompensator resonances = with_inputs(
      {"temperature", "temperature_lowpass(100)", "quadrature_lowpass(10)"},
      {{5, 45}, {5, 45}, {40, 25}});
  resonances.bias.bias_scale = {};
  resonances.bias.function =
      ResonanceCurve{Eigen::Vector2d(0.25, 0.75),
                     Eigen::Vector4d(0.1, -0.4, 0.2, 0.1),
                     Eigen::Vector2d(-0.3, 0.5),
                     Eigen::Vector2d(0.2, 0.4),
                     Eigen::Vector2d(0.07, -0.03),
                     Eigen::Vector2d(0.5, 0.3),
                     {Eigen::ArrayXd::LinSpaced(4, -1.0, 1.0),
                      Eigen::ArrayXd{{0.1, 1.0 / 3.0, -0.2, 0.4}}},
                     0.1,
                     0.05};
  return {
      {"none", of_temperature({{Scale{}}, {}, NoBias{}})},
      {"constant", of_temperature({{Scale{}}, {}, ConstantBias{1.0 / 3.0}})},
      {"polynomial",
       of_temperature(
           {{{5.0, 45.0}}, {}, Polynomial{{0.1, -0.7, 1e-17, 3.0}}})},
      {"polynomial_with_slopes", slopes},
      {"table", of_temperature({{Scale{}}, {}, fit_lookup_table(T, b, 5.0)})},
      {"spline", spline_compensator()},
      {"thermistor",
       of_temperature({{Scale{}}, {}, fit_thermistor_network(T, b, 3950.0)})},
      {"fuzzy", fuzzy},
      {"radial_basis", bells},
      {"resonances", resonances},
      {"bp", network_compensator()},
      {"spline_with_sigma", with_sigma(spline_compensator())},
      {"bp_with_sigma", with_sigma(network_compensator())},
      {"every_input_with_sigma", with_sigma(every_input())},
      {"bp_with_every_input", every_input()},
  };
}

}  // namespace beamgyro::internal
