// SPDX-License-Identifier: MIT
#include "sim/device/modal_model.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {
namespace {

using Eigen::Matrix2cd;
using Eigen::Matrix2d;
using Eigen::Vector2cd;
using Eigen::Vector2d;

constexpr double kAluminiumExpansion = 23e-6;  // housing [1/K]

bool on_x_face(Patch patch) { return patch == kDrive || patch == kFeedback; }

// r r^T + second moments of the patch's own section [m2].
Matrix2d patch_second_moment(const DeviceParameters& device, Patch patch) {
  const Vector2d r = patch_position(device, patch);
  Vector2d own(device.patches.thickness * device.patches.thickness / 12,
               device.patches.width * device.patches.width / 12);
  if (!on_x_face(patch)) own.reverseInPlace();
  return r * r.transpose() + Matrix2d(own.asDiagonal());
}

// Of ceramic and bond at one temperature.
struct PatchMaterials {
  Complex E_p;
  PerPatch<Complex> S;  // shear_lag()
};

Complex bond_at(const DeviceParameters& device, double T, double omega,
                const MemoryState& memory) {
  if (!device.memory.relaxation || memory.glass_offset == 0)
    return bond_modulus(device.bond, T, omega);
  return bond_modulus(device.bond, *device.memory.relaxation,
                      memory.glass_offset, T, omega);
}

PatchMaterials patch_materials(const DeviceParameters& device, double T,
                               double omega, const MemoryState& memory) {
  PatchMaterials materials{patch_modulus(device.patches, T), {}};
  const Complex G_b = bond_at(device, T, omega, memory);
  for (std::size_t p = 0; p < kPatchCount; ++p) {
    const double thickness = device.bond.thickness[p];
    materials.S[p] =
        p > 0 && thickness == device.bond.thickness[p - 1]
            ? materials.S[p - 1]
            : shear_lag(device.patches, thickness, G_b, materials.E_p);
  }
  return materials;
}

std::string memory_text(const MemoryState& memory) {
  if (memory == MemoryState{}) return "";
  return fmt::format(
      " with the bond {:.1f} K off its reference glass, hysteresis at {:.2f} "
      "of its largest and {:.1f} decades after the trim",
      memory.glass_offset, memory.hysteresis, memory.decades);
}

// The device with every property that ages at its value after `decades`.
DeviceParameters aged(const DeviceParameters& device, double decades) {
  DeviceParameters old = device;
  const AgeingParameters& per_decade = *device.memory.ageing;
  old.patches.youngs_modulus *= 1 + per_decade.patch_modulus * decades;
  old.patches.d31 *= 1 + per_decade.d31 * decades;
  old.patches.relative_permittivity *= 1 + per_decade.permittivity * decades;
  old.patches.mechanical_loss_factor *=
      1 + per_decade.mechanical_loss * decades;
  old.bond.shear_modulus *= 1 + per_decade.bond_modulus * decades;
  old.mount.glassy_stiffness_share *= 1 + per_decade.mount_share * decades;
  old.memory.ageing.reset();
  return old;
}

Matrix2cd stiffness_of(const DeviceParameters& device,
                       const ProjectedBeam& beam,
                       const PatchMaterials& materials, double T,
                       const MemoryState& memory) {
  const double omega = beam.timoshenko_frequency;
  const double ax = device.beam.side * (1 + device.beam.side_difference / 2);
  const double ay = device.beam.side * (1 - device.beam.side_difference / 2);
  const Complex E_b = beam_modulus(device.beam, T, omega);

  Matrix2cd K = Matrix2cd::Zero();
  const Complex metal = E_b * beam.curvature_squared / 12.0;
  K(0, 0) = metal * (ax * ax * ax * ay);
  K(1, 1) = metal * (ay * ay * ay * ax);
  const double weight = device.patches.width * device.patches.thickness *
                        beam.patch_curvature_squared;
  for (int i = 0; i < kPatchCount; ++i) {
    const Complex S = materials.S[static_cast<std::size_t>(i)];
    K += (materials.E_p * S * weight) *
         patch_second_moment(device, static_cast<Patch>(i));
  }
  K *= beam.stiffness_scale;

  const double K0 = 0.5 * K.trace().real();
  double axis = device.mount.axis_angle;
  if (device.memory.hysteresis) {
    const HysteresisParameters& hysteresis = *device.memory.hysteresis;
    axis += hysteresis.mount_axis * memory.hysteresis;
    const Complex cross =
        K0 * memory.hysteresis * Complex(hysteresis.stiffness, hysteresis.loss);
    K(0, 1) += cross;
    K(1, 0) += cross;
  }
  const double c = std::cos(axis), s = std::sin(axis);
  Matrix2d R;
  R << c, -s, s, c;
  K += (K0 * mount_share(device.mount, T, omega)) *
       (R * Vector2d(1, device.mount.anisotropy).asDiagonal() * R.transpose());
  K += Complex(0, K0 * device.air_inverse_Q) * Matrix2cd::Identity();

  const Matrix2d loss = K.imag();
  const double determinant = loss(0, 0) * loss(1, 1) - loss(1, 0) * loss(0, 1);
  if (!(loss(0, 0) > 0 && determinant > 0)) {
    throw SimulationFailure(fmt::format(
        "complex stiffness at {:.2f} degC{}: its loss part is not positive "
        "definite; {} creates energy",
        T - kZeroCelsius, memory_text(memory),
        memory == MemoryState{} ? "a material or mount parameter"
                                : "a parameter of [memory]"));
  }
  return K;
}

Vector2cd coupling_of(const DeviceParameters& device, const ProjectedBeam& beam,
                      const PatchMaterials& materials, Patch patch, double T) {
  return (piezo_stress_constant(device.patches, T) * device.patches.width *
          materials.S[static_cast<std::size_t>(patch)] * beam.patch_curvature) *
         patch_position(device, patch);
}

}  // namespace

Vector2d patch_position(const DeviceParameters& device, Patch patch) {
  const auto p = static_cast<std::size_t>(patch);
  const double h = lever_arm(device, device.bond.thickness[p]);
  const double delta = device.patches.offset[p];
  switch (patch) {
    case kDrive:
      return {h, delta};
    case kFeedback:
      return {-h, delta};
    case kReadout:
      return {delta, h};
    default:
      return {delta, -h};
  }
}

Vector2cd patch_coupling(const DeviceParameters& device,
                         const ProjectedBeam& beam, Patch patch, double T) {
  return coupling_of(device, beam,
                     patch_materials(device, T, beam.timoshenko_frequency, {}),
                     patch, T);
}

std::vector<double> modal_kinks(const DeviceParameters& device) {
  return {device.bond.glass_transition, device.mount.glass_transition,
          kColdestCeramic, kHottestCeramic};
}

double patch_capacitance(const PatchParameters& patches, double T) {
  return clamped_permittivity(patches, T) * patches.length * patches.width /
         patches.thickness;
}

ModalParameters modal_parameters(const DeviceParameters& device,
                                 const ProjectedBeam& beam, double T,
                                 double stiffness_trim,
                                 const MemoryState& memory) {
  if (device.memory.ageing && memory.decades != 0)
    return modal_parameters(aged(device, memory.decades), beam, T,
                            stiffness_trim, memory);
  const PatchMaterials materials =
      patch_materials(device, T, beam.timoshenko_frequency, memory);
  const Matrix2cd K = stiffness_of(device, beam, materials, T, memory);
  ModalParameters modal;
  modal.temperature = T;
  modal.mass = beam.mass;
  modal.coriolis_mass = beam.angular_gain * beam.mass;
  modal.stiffness = K.real();
  modal.stiffness(0, 1) += stiffness_trim;
  modal.stiffness(1, 0) += stiffness_trim;
  modal.damping = K.imag() / beam.timoshenko_frequency;

  // Axial clamping by the pins against the housing, common to both modes.
  const double dT = T - kCalibrationTemperature;
  const double L = device.beam.length;
  const double tension = device.mount.pin_stiffness *
                         (kAluminiumExpansion - device.beam.thermal_expansion) *
                         dT * (1 - 2 * kSupportPosition) * L;
  modal.stiffness.diagonal().array() +=
      beam.slope_squared_between_pins * tension;

  for (int i = 0; i < kPatchCount; ++i) {
    modal.coupling[static_cast<std::size_t>(i)] =
        coupling_of(device, beam, materials, static_cast<Patch>(i), T);
  }
  return modal;
}

void require_passive_memory(const DeviceParameters& device,
                            const ProjectedBeam& beam) {
  // The loss part is linear in the hysteresis but for the mount's axis, and
  // each ageing property is linear in the decades: their extremes are the
  // worst. A quench leaves the bond less than 10 K above its reference, and
  // decades of storage or a fast rise at most 40 K below.
  constexpr std::array<double, 3> kGlassOffsets = {0, -40, 10};  // [K]
  constexpr double kOldest = 6;  // decades: 57 years at 150 degC
  constexpr double kStep = 10;   // [K]
  const MemoryParameters& memory = device.memory;
  if (!memory.any()) return;
  std::vector<double> decades = {0};
  if (memory.ageing)
    decades = {std::log10(memory.ageing->start /
                          (memory.ageing->start + memory.ageing->trim_age)),
               kOldest};
  const double turned = memory.hysteresis ? 1 : 0;
  for (double T = kMaterialTemperatures.low; T <= kMaterialTemperatures.high;
       T += kStep) {
    for (const double glass : kGlassOffsets) {
      for (const double h : {-turned, turned}) {
        for (const double a : decades)
          modal_parameters(device, beam, T + kZeroCelsius, 0, {glass, h, a});
      }
      if (!memory.relaxation) break;
    }
  }
}

}  // namespace beamgyro::internal
