// SPDX-License-Identifier: MIT
// What bench/scipy_dynamics.py compares with, as JSON on standard output:
//   beamgyro_model RUN.h5
// the right-hand sides' parameters for the device of a recording, one
// evaluation of each, outputs at a tight tolerance, and what ours took.
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "dataset/netcdf/recording_reader.h"
#include "sim/device/device_file.h"
#include "sim/dynamics/carrier.h"
#include "sim/numerics/ode.h"
#include "sim/scenario/envelope_run.h"

namespace beamgyro::internal {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kT0 = kCalibrationTemperature;

std::vector<double> list(const Eigen::Ref<const Eigen::VectorXd>& v) {
  return {v.begin(), v.end()};
}

json pair(std::complex<double> z) { return {z.real(), z.imag()}; }

DeviceParameters device_of(const Recording& recording) {
  std::vector<std::string> sets;
  std::istringstream lines(recording.overrides_text);
  for (std::string line; std::getline(lines, line);) sets.push_back(line);
  Overrides overrides(sets);
  return read_device(
      ConfigDocument::parse(recording.device_text, "device", overrides));
}

double seconds(int repetitions, const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> took =
        std::chrono::steady_clock::now() - start;
    least = std::min(least, took.count());
  }
  return least;
}

json parameters(const TrimmedGyro& gyro) {
  const LoopElectronics loops = loop_electronics(gyro);
  const ThermalParameters& t = gyro.device.thermal;
  const DriveHeating heating = drive_heating(gyro);
  ModalTable table(gyro);
  json grid = json::array();
  constexpr double kFirst = 288.15, kLast = 318.15, kStep = 0.25;  // [K]
  for (double T = kFirst; T <= kLast + 1e-9; T += kStep)
    grid.push_back(list(table.at(T).value.matrix()));
  json directions = json::array();
  for (const Eigen::Vector2d& d : table.direction())
    directions.push_back({d(0), d(1)});
  // The network is linear but for the housing's losses.
  const ThermalNetwork network(t);
  json conductance = json::array();
  const NodeVector base = NodeVector::Constant(kT0);
  const ThermalSurroundings still{kT0, false};
  for (int i = 0; i < kThermalNodeCount; ++i) {
    NodeVector one = base;
    one(i) += 1;
    NodeVector power = NodeVector::Zero();
    if (i == kHousing)
      power(kHousing) = network.heat_loss(kT0 + 1, still).total();
    conductance.push_back(list(network.heating_rate(one, power, still)));
  }
  return {
      {"first_K", kFirst},
      {"step_K", kStep},
      {"modal", grid},
      {"directions", directions},
      {"angular_gain", gyro.beam.angular_gain},
      {"mass", gyro.beam.mass},
      {"amplitude", gyro.device.drive.amplitude},
      {"phase_tc", gyro.device.readout.phase_tc},
      {"phase_tc2", gyro.device.readout.phase_tc2},
      {"loops",
       {{"w_nom", loops.nominal_frequency},
        {"V_0", loops.nominal_voltage},
        {"V_max", loops.voltage_limit},
        {"feedback_scale", loops.feedback_scale},
        {"w_f", loops.demodulator_corner},
        {"w_o", loops.output_corner},
        {"phase", loops.pll_phase},
        {"K_p", loops.pll_proportional},
        {"K_i", loops.pll_integral},
        {"K_pA", loops.agc_proportional},
        {"K_iA", loops.agc_integral},
        {"charge_axis", pair(loops.charge_axis)},
        {"feedthrough", loops.feedthrough}}},
      {"thermal",
       {{"exchange", conductance},  // row i: dT/dt by 1 K of node i
        {"housing_capacity", t.housing_heat_capacity},
        {"natural", t.natural_convection_coefficient * t.housing_area /
                        std::sqrt(std::sqrt(t.housing_height))},
        {"radiation", t.housing_emissivity * 5.670374419e-8 * t.housing_area},
        {"fixture", t.housing_fixture_conductance},
        {"powered",
         list((network.powered_heating(heating.mechanical, heating.dielectric)
                   .array() /
               network.heat_capacity().array())
                  .matrix())}}}};
}

// Any state near the settled one, the same on both sides.
Eigen::VectorXd probe(Eigen::Index size) {
  Eigen::VectorXd y(size);
  for (Eigen::Index i = 0; i < size; ++i)
    y(i) = 0.5 + 0.1 * std::sin(3.0 * static_cast<double>(i));
  return y;
}

json envelope(const TrimmedGyro& gyro, const RateProfile& rate) {
  ScenarioPlan scenario;
  scenario.duration = 1500;
  scenario.output_rate = 10;
  scenario.powered = {{.on = 0}};
  scenario.motion[kRateZ] = rate;
  const Motion motion(scenario, gyro, {});
  const std::vector<double> times = sample_times(scenario);
  std::vector<double> ours;
  long evaluations = 0;
  const double took = seconds(9, [&] {
    EnvelopeTrajectory run(scenario, gyro, motion, false);
    ours = run.advance(times).output;
    evaluations = run.rhs_evaluations();
  });
  EnvelopeTrajectory tight(scenario, gyro, motion, false, nullptr, 1e-11);
  const RunSamples exact = tight.advance(times);
  std::vector<double> shown;  // without the board's offset
  double error = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    error = std::max(error, std::abs(ours[k] - exact.output[k]));
    shown.push_back(
        (exact.output[k] -
         electronics_at(gyro, exact.temperature[kBoard][k]).offset) /
        kDegree);
  }
  return {{"seconds", took},
          {"rhs", evaluations},
          {"error", error / kDegree},
          {"output", shown}};
}

json carrier(const TrimmedGyro& gyro) {
  constexpr double kEnd = 0.05, kStep = 5e-4;  // [s]
  CarrierOde ode(gyro);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(kCarrierStates);
  weights(0) = weights(2) = weights(9) = weights(20) = 0.3;
  weights(1) = weights(3) = 2e-3;
  weights.segment<4>(kFeedback1).setConstant(0.3);
  weights(kPllIntegral) = 100;
  long evaluations = 0;
  const auto run = [&](double tolerance) {
    ExplicitRkOptions options;
    options.absolute_tolerance = tolerance * weights;
    ExplicitRk rk(
        [&](double t, const auto& y, auto dydt) { ode.rate(t, {}, y, dydt); },
        0, ode.at_rest(), options);
    std::vector<double> output;
    for (int k = 1; k * kStep < kEnd + 1e-9; ++k)
      output.push_back(rk.advance_to(k * kStep)(kOutput2) / kDegree);
    evaluations = rk.rhs_evaluations();
    return output;
  };
  const std::vector<double> exact = run(1e-12);
  std::vector<double> ours;
  const double took = seconds(9, [&] { ours = run(1e-7); });
  double error = 0;
  for (std::size_t k = 0; k < ours.size(); ++k)
    error = std::max(error, std::abs(ours[k] - exact[k]));
  Eigen::VectorXd dydt(kCarrierStates);
  ode.rate(1e-5, {}, probe(kCarrierStates), dydt);
  return {{"seconds", took},          {"rhs", evaluations},
          {"error", error},           {"output", exact},
          {"weights", list(weights)}, {"probe", list(probe(kCarrierStates))},
          {"probe_rate", list(dydt)}};
}

json envelope_probe(const TrimmedGyro& gyro) {
  EnvelopeOde ode(gyro, drive_heating(gyro));
  Eigen::VectorXd y = probe(ode.size());
  y.tail<kThermalNodeCount>() << 299.3, 299.4, 299.8, 301.0, 304.0, 302.0;
  EnvelopeInputs inputs{
      .motion = {}, .surroundings = {.ambient = kT0}, .powered = true};
  inputs.motion.z = 0.1;
  Eigen::VectorXd dydt(y.size());
  Eigen::MatrixXd slope(y.size(), y.size());
  ode.rate(inputs, y, dydt);
  ode.jacobian(inputs, y, slope);
  json rows = json::array();
  for (Eigen::Index i = 0; i < slope.rows(); ++i)
    rows.push_back(list(slope.row(i).transpose()));
  return {{"state", list(y)}, {"rate", list(dydt)}, {"jacobian", rows}};
}

int print_model(const std::string& file) {
  const TrimmedGyro gyro = make_gyro(device_of(read_recording(file)));
  const SineSignal sine{.amplitude = 10 * kDegree, .frequency = 0.05};
  const json all = {
      {"parameters", parameters(gyro)},
      {"envelope_probe", envelope_probe(gyro)},
      {"envelope_at_rest", envelope(gyro, PiecewiseLinear::constant(0))},
      {"envelope_under_sine", envelope(gyro, sine)},
      {"carrier", carrier(gyro)}};
  std::cout << all.dump() << '\n';
  return 0;
}

}  // namespace
}  // namespace beamgyro::internal

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: beamgyro_model RUN.h5\n";
    return 2;
  }
  return beamgyro::internal::print_model(argv[1]);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
