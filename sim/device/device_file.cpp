// SPDX-License-Identifier: MIT
#include "sim/device/device_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>

#include "config/table.h"
#include "config/units.h"
#include "sim/device/spurious_mode_file.h"
#include "sim/memory/memory_parameters.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {
namespace {

constexpr double kHour = 3600;  // [s]

RelaxationParameters read_relaxation(const ConfigTable& table) {
  return {
      .activation =
          table.number_or("activation_J_per_mol", 6e5, between(1e4, 3e6)),
      .nonlinearity = table.number_or("nonlinearity", 0.4, between(0, 1)),
      .modulus_per_K =
          table.number_or("modulus_per_K", 2e-3, between(-5e-3, 5e-3)),
      .initial_offset =
          table.optional_number("initial_offset_K", between(-40, 40)),
  };
}

// `otherwise` is what there is without the key.
template <std::size_t kCount>
std::array<double, kCount> array_or(const ConfigTable& table,
                                    std::string_view key,
                                    std::array<double, kCount> otherwise,
                                    const Range& range) {
  if (table.has(key))
    std::ranges::copy(table.numbers(key, kCount, range), otherwise.begin());
  return otherwise;
}

HysteresisParameters read_hysteresis(const ConfigTable& table) {
  HysteresisParameters parameters{
      .half_width = array_or<kPlayOperators>(
          table, "half_width_K", {0.5, 1.5, 4, 10}, between(1e-3, 200)),
      .weight = array_or<kPlayOperators>(table, "weight", {0.2, 0.3, 0.3, 0.2},
                                         non_negative()),
      .stiffness = table.number_or("stiffness", 4e-7, between(-1e-4, 1e-4)),
      .loss = table.number_or("loss", 5e-8, between(-1e-4, 1e-4)),
      .mount_axis =
          table.number_or("mount_axis_deg", 0.01, between(-10, 10)) * kDegree,
  };
  const double sum =
      std::reduce(parameters.weight.begin(), parameters.weight.end());
  if (!(sum > 0))
    table.fail("weight", "every weight is 0; expected one above 0");
  for (double& w : parameters.weight) w /= sum;
  return parameters;
}

AgeingParameters read_ageing(const ConfigTable& table) {
  const auto per_decade = [&](std::string_view key, double otherwise) {
    return table.number_or(key, otherwise, between(-0.1, 0.1));
  };
  return {
      .activation =
          table.number_or("activation_J_per_mol", 5e4, between(0, 2e5)),
      .start =
          table.number_or("start_hours", 24, {0, 1e5, true, false}) * kHour,
      .trim_age =
          table.number_or("trim_age_hours", 2000, {0, 1e6, false, false}) *
          kHour,
      .patch_modulus = per_decade("patch_modulus_per_decade", 2e-3),
      .d31 = per_decade("d31_per_decade", -5e-3),
      .permittivity = per_decade("permittivity_per_decade", -1e-2),
      .mechanical_loss = per_decade("mechanical_loss_per_decade", -5e-2),
      .bond_modulus = per_decade("bond_modulus_per_decade", 3e-3),
      .mount_share = per_decade("mount_share_per_decade", 1e-2),
  };
}

/// Reads `[memory]` of a device file: the tables relaxation, hysteresis and
/// ageing, of which each is optional and switches its effect on. Their keys
/// have the defaults of docs/reference/device_file.md.
MemoryParameters read_memory(const ConfigTable& memory) {
  MemoryParameters parameters;
  if (const auto table = memory.optional_table("relaxation"))
    parameters.relaxation = read_relaxation(*table);
  if (const auto table = memory.optional_table("hysteresis"))
    parameters.hysteresis = read_hysteresis(*table);
  if (const auto table = memory.optional_table("ageing"))
    parameters.ageing = read_ageing(*table);
  return parameters;
}

constexpr Range kCelsius{-kZeroCelsius, 1000, true, false};
constexpr Range kExponent{0, 1, true, false};

// What no material or part of a gyro goes beyond: mm, GPa or g/cm3 typed for SI
// do. docs/reference/device_file.md lists them.
constexpr Range kBeamLength{1e-4, 0.5};         // [m]
constexpr Range kBeamSide{1e-5, 0.1};           // [m]
constexpr Range kModulus{1e7, 1.5e12};          // [Pa], rubber .. diamond
constexpr Range kShearModulus{1e4, 1e12};       // [Pa], gel .. diamond
constexpr Range kDensity{100, 25e3};            // [kg/m3], foam .. osmium
constexpr Range kConductivity{1e-3, 1e4};       // [W/mK]
constexpr Range kSpecificHeat{10, 2e4};         // [J/kgK]
constexpr Range kPermittivity{1, 1e6};          // [-]
constexpr Range kActivation{1e3, 1e7};          // [J/mol]
constexpr Range kCapacitance{1e-15, 1e-3};      // [F]
constexpr Range kVoltage{0, 1e4, true, false};  // [V]
constexpr Range kTime{0, 1e9, true, false};     // [s]

constexpr double kPpm = 1e-6;

double kelvin(const ConfigTable& table, std::string_view key) {
  return table.number(key, kCelsius) + kZeroCelsius;
}

PerPatch<double> per_patch(const ConfigTable& table, std::string_view key,
                           const Range& range) {
  PerPatch<double> result{};
  std::ranges::copy(table.numbers(key, kPatchCount, range), result.begin());
  return result;
}

BeamParameters read_beam(const ConfigTable& beam) {
  return {
      .length = beam.number("length_m", kBeamLength),
      .side = beam.number("side_m", kBeamSide),
      .side_difference = beam.number("side_difference", between(-0.5, 0.5)),
      .youngs_modulus = beam.number("youngs_modulus_Pa", kModulus),
      .density = beam.number("density_kg_per_m3", kDensity),
      .poisson_ratio = beam.number("poisson_ratio", {-1, 0.5, true, false}),
      .modulus_tc1 = beam.number("modulus_tc1_per_K", between(-0.01, 0.01)),
      .modulus_tc2 = beam.number("modulus_tc2_per_K2", between(-1e-4, 1e-4)),
      .thermal_expansion =
          beam.number("thermal_expansion_per_K", between(-1e-3, 1e-3)),
      .loss_factor = beam.number("loss_factor", {0, 1, false, true}),
      .thermal_conductivity =
          beam.number("thermal_conductivity_W_per_mK", kConductivity),
      .specific_heat = beam.number("specific_heat_J_per_kgK", kSpecificHeat),
      .angular_gain = beam.optional_number("angular_gain", {0, 1, true, false}),
  };
}

PatchParameters read_patches(const ConfigTable& patches,
                             const BeamParameters& beam) {
  const double half = beam.side / 2;
  const double length = patches.number("length_m", {0, 0.5, true, false});
  if (!(length < beam.length))
    patches.fail("length_m", fmt::format("{:g}; expected less than "
                                         "beam.length_m, which is {:g}",
                                         length, beam.length));
  return {
      .length = length,
      .width = patches.number("width_m", {0, beam.side, true, false}),
      .thickness = patches.number("thickness_m", {0, beam.side, true, false}),
      .youngs_modulus = patches.number("youngs_modulus_Pa", kModulus),
      .density = patches.number("density_kg_per_m3", kDensity),
      .d31 = patches.number("d31_C_per_N", {-1e-8, 0, false, true}),
      .relative_permittivity =
          patches.number("relative_permittivity", kPermittivity),
      .loss_tangent = patches.number("loss_tangent", {0, 1, false, true}),
      .mechanical_loss_factor =
          patches.number("mechanical_loss_factor", {0, 1, false, true}),
      .modulus_tc = patches.number("modulus_tc_per_K", between(-0.01, 0.01)),
      .d31_tc = patches.number("d31_tc_per_K", between(-0.01, 0.01)),
      .permittivity_tc =
          patches.number("permittivity_tc_per_K", between(-0.01, 0.01)),
      .mechanical_loss_tc =
          patches.number("mechanical_loss_tc_per_K", between(-0.01, 0.01)),
      .offset = per_patch(patches, "offset_m", between(-half, half)),
  };
}

/// Reads a step of the modulus [Pa], which is 0 or one that softens the bond.
/// Above 0 only what is typed in another unit is below `kLeastStep`.
double read_step(const ConfigTable& bond, std::string_view key, double most) {
  constexpr double kLeastStep = 1e4;  // [Pa]
  if (bond.holds_number(key) && bond.number(key) == 0) return 0;
  return bond.number(key, {kLeastStep, most, false, true});
}

BondParameters read_bond(const ConfigTable& bond) {
  const double G = bond.number("shear_modulus_Pa", kShearModulus);
  const double beta = read_step(bond, "beta_step_Pa", G);
  return {
      .thickness = per_patch(bond, "thickness_m", {0, 1e-3, true, false}),
      .shear_modulus = G,
      .beta_step = beta,
      .beta_exponent = bond.number("beta_exponent", kExponent),
      .beta_activation = bond.number("beta_activation_J_per_mol", kActivation),
      .beta_temperature = kelvin(bond, "beta_1Hz_degC"),
      .alpha_step = read_step(bond, "alpha_step_Pa", G - beta),
      .alpha_exponent = bond.number("alpha_exponent", kExponent),
      .glass_transition = kelvin(bond, "glass_transition_degC"),
      .alpha_low_activation =
          bond.number("alpha_low_activation_J_per_mol", kActivation),
  };
}

std::array<double, 3> read_g_sensitivity(const ConfigTable& mount) {
  std::array<double, 3> result =
      array_or<3>(mount, "g_sensitivity_deg_per_s_per_g", {0.02, 0.02, 0.005},
                  between(-10, 10));
  for (double& value : result) value *= kDegree / kStandardGravity;
  return result;
}

MountParameters read_mount(const ConfigTable& mount) {
  return {
      .glassy_stiffness_share =
          mount.number("glassy_stiffness_share", {0, 0.1, false, false}),
      .rubber_glass_ratio =
          mount.number("rubber_glass_ratio", {0, 1, true, false}),
      .exponent = mount.number("exponent", kExponent),
      .glass_transition = kelvin(mount, "glass_transition_degC"),
      .anisotropy = mount.number("anisotropy", between(0, 10)),
      .axis_angle =
          mount.number("axis_angle_deg", between(-180, 180)) * kDegree,
      .low_activation = mount.number("low_activation_J_per_mol", kActivation),
      .pin_stiffness = mount.number("pin_stiffness_N_per_m", non_negative()),
      .g_sensitivity = read_g_sensitivity(mount),
      .rectification = mount.number_or("rectification_deg_per_s_per_g2", 0.002,
                                       between(-10, 10)) *
                       kDegree / (kStandardGravity * kStandardGravity),
  };
}

DriveParameters read_drive(const ConfigTable& drive) {
  const auto corner = [&](std::string_view key, double otherwise) {
    return 2 * std::numbers::pi *
           drive.number_or(key, otherwise, {0, 1e3, true, false});
  };
  return {
      .amplitude = drive.number("amplitude_m", {0, 1e-4, true, false}),
      .pll_phase = drive.number("pll_phase_rad", between(-1, 1)),
      .voltage_limit = drive.number("voltage_limit_V", kVoltage),
      .demodulator_corner = corner("demodulator_corner_Hz", 300),
      .pll_bandwidth = corner("pll_bandwidth_Hz", 30),
      .pll_integral_corner = corner("pll_integral_corner_Hz", 10),
      .agc_bandwidth = corner("agc_bandwidth_Hz", 20),
      .agc_integral_corner = corner("agc_integral_corner_Hz", 3),
  };
}

ReadoutParameters read_readout(const ConfigTable& readout) {
  const bool rebalance =
      readout.choice("mode", {"open_loop", "force_rebalance"}) ==
      "force_rebalance";
  const auto rate = [&](std::string_view key) {
    return readout.number(key, between(-1e4, 1e4)) * kDegree;
  };
  const auto resolution = [&](std::string_view key, double otherwise) {
    return readout.number_or(key, otherwise, non_negative());
  };
  return {
      .mode = rebalance ? ReadoutMode::kForceRebalance : ReadoutMode::kOpenLoop,
      .feedback_capacitance =
          readout.number("feedback_capacitance_F", kCapacitance),
      .feedthrough = readout.number("feedthrough_F", between(-1e-9, 1e-9)),
      .rebalance_bandwidth = 2 * std::numbers::pi *
                             readout.number_or("rebalance_bandwidth_Hz", 20,
                                               {0, 100, true, false}),
      .amplifier_noise = readout.number_or("amplifier_noise_V_per_sqrt_Hz",
                                           5e-9, non_negative()),
      .input_capacitance =
          readout.number_or("input_capacitance_F", 50e-12, non_negative()),
      .quadrature_trim = rate("quadrature_trim_deg_per_s"),
      .offset_trim = rate("offset_trim_deg_per_s"),
      .scale_factor =
          readout.number("scale_factor_V_per_deg_per_s", positive()) / kDegree,
      .scale_factor_error =
          readout.number_or("scale_factor_error", 0, {-0.5, 0.5, true, true}),
      .offset = readout.number("offset_V"),
      .full_scale =
          readout.number("full_scale_deg_per_s", {0, 1e4, true, false}) *
          kDegree,
      .phase_tc = readout.number("phase_tc_rad_per_K", between(-0.1, 0.1)),
      .phase_tc2 = readout.number("phase_tc2_rad_per_K2", between(-0.1, 0.1)),
      .offset_tc = rate("offset_tc_deg_per_s_per_K"),
      .offset_tc2 = rate("offset_tc2_deg_per_s_per_K2"),
      .corner_frequency = 2 * std::numbers::pi *
                          readout.number("bandwidth_Hz", {0, 1e6, true, false}),
      .adc_bits = static_cast<int>(readout.integer("adc_bits", 1, 32)),
      .drive_frequency_resolution =
          resolution("drive_frequency_resolution_Hz", 1e-3),
      .drive_voltage_resolution =
          resolution("drive_voltage_resolution_V", 1e-4),
      .quadrature_resolution =
          resolution("quadrature_resolution_deg_per_s", 0.01) * kDegree,
  };
}

NoiseParameters read_noise(const ConfigTable& noise) {
  const auto rate = [&](std::string_view key) {
    return noise.number(key, non_negative()) * kDegree;
  };
  return {
      .angle_random_walk = rate("angle_random_walk_deg_per_sqrt_s"),
      .bias_instability = rate("bias_instability_deg_per_s"),
      .rate_random_walk = rate("rate_random_walk_deg_per_s_per_sqrt_s"),
      .turn_on = rate("turn_on_deg_per_s"),
      .turn_on_transient =
          noise.number_or("turn_on_transient_deg_per_s", 0, non_negative()) *
          kDegree,
      .turn_on_settling = noise.number_or("turn_on_settling_s", 200, kTime),
      .turn_on_recovery = noise.number_or("turn_on_recovery_s", 3600, kTime),
      .walk_correlation =
          noise.number_or("random_walk_correlation_h", 100, between(1, 1e6)) *
          kHour,
  };
}

std::optional<LoopChannelParameters> read_loop_channels(
    const std::optional<ConfigTable>& channels) {
  if (!channels) return std::nullopt;
  const auto number = [&](std::string_view key, double most, double unit) {
    return channels->number_or(key, 0, between(-most, most)) * unit;
  };
  return LoopChannelParameters{
      .noise = channels->flag_or("noise", false),
      .clock_offset = number("clock_offset_ppm", 1e4, kPpm),
      .clock_tc2 = number("clock_tc2_ppm_per_K2", 10, kPpm),
      .clock_ageing = number("clock_ageing_ppm_per_year", 1e3, kPpm),
      .voltage_gain_error = number("drive_voltage_gain_error", 0.5, 1),
      .voltage_gain_tc = number("drive_voltage_gain_tc_per_K", 0.01, 1),
      .quadrature_offset = number("quadrature_offset_deg_per_s", 1e4, kDegree),
      .quadrature_offset_tc =
          number("quadrature_offset_tc_deg_per_s_per_K", 1e3, kDegree),
      .quadrature_offset_tc2 =
          number("quadrature_offset_tc2_deg_per_s_per_K2", 1e3, kDegree),
  };
}

}  // namespace

DeviceParameters read_device(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  const ConfigTable sensor = root.table("temperature_sensor");
  const BeamParameters beam = read_beam(root.table("beam"));
  const MemoryParameters memory = read_memory(root.table_or_empty("memory"));
  return {
      .beam = beam,
      .patches = read_patches(root.table("patches"), beam),
      .bond = read_bond(root.table("bond")),
      .mount = read_mount(root.table("mount")),
      .air_inverse_Q =
          root.table("air").number("inverse_Q", {0, 1, false, true}),
      .drive = read_drive(root.table("drive")),
      .readout = read_readout(root.table("readout")),
      .thermal = read_thermal(root.table("thermal")),
      .noise = read_noise(root.table("noise")),
      .temperature_sensor =
          {
              .noise = sensor.number("noise_K", non_negative()),
              .resolution = sensor.number("resolution_K", non_negative()),
              .offset = sensor.number("offset_K", between(-100, 100)),
          },
      .loop_channels = read_loop_channels(root.optional_table("loop_channels")),
      .memory = memory,
      .spurious_modes = read_spurious_modes(root, memory),
  };
}

}  // namespace beamgyro::internal
