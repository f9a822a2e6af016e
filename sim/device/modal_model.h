// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/device/device.h"
#include "sim/device/materials.h"
#include "sim/device/projected_beam.h"
#include "sim/device/spurious_mode.h"

namespace beamgyro::internal {

/// The two coupled modes at one temperature:
///   m q'' + C q' + K q = sum_p Theta_p V_p + Coriolis...   (2.1)
/// with the spurious modes that act on them (13.1). K and C are those of the
/// beam and its parts alone.
struct ModalParameters {
  double temperature = kCalibrationTemperature;  // of the beam [K]
  double mass;                                   // m [kg]
  double coriolis_mass;                          // m_g = gamma m [kg]
  Eigen::Matrix2d stiffness;                     // K = Re K* [N/m]
  Eigen::Matrix2d damping;                       // C = Im K* / w [N s/m]
  PerPatch<Eigen::Vector2cd> coupling;           // Theta_p [N/V] = [C/m]
  std::vector<SpuriousResonance> spurious;       // at this temperature
};

/// Centre of patch p in the cross section, r_p [m].
Eigen::Vector2d patch_position(const DeviceParameters& device, Patch patch);

/// Theta_p(T) [N/V], complex transducer coupling (1.1).
Eigen::Vector2cd patch_coupling(const DeviceParameters& device,
                                const ProjectedBeam& beam, Patch patch,
                                double T);

/// C_p(T) [F], clamped capacitance of one patch (1.2).
double patch_capacitance(const PatchParameters& patches, double T);

/// All of (2.1) but spurious modes at beam temperature T [K]; `stiffness_trim`
/// is k_trim of (1.3).
/// `memory` acts on the materials by the effects that the device has: the glass
/// of the bond (12.2), hysteresis of K*_xy and of the mount's axis (12.4), age
/// (12.5). Without it the result is that of the unit at its trim.
/// Throws SimulationFailure when the loss part of K* is not positive definite,
/// which no passive material can do.
ModalParameters modal_parameters(const DeviceParameters& device,
                                 const ProjectedBeam& beam, double T,
                                 double stiffness_trim,
                                 const MemoryState& memory = {});

/// Throws SimulationFailure when a memory effect of the device makes the loss
/// part of K* indefinite at a temperature, a state of the bond, a sign of the
/// hysteresis or an age that a history can bring about.
void require_passive_memory(const DeviceParameters& device,
                            const ProjectedBeam& beam);

/// Beam temperatures [K] where modal_parameters() may have a kink, in no order:
/// glass transitions and the ends of the ceramic's linear range. It is analytic
/// between them.
std::vector<double> modal_kinks(const DeviceParameters& device);

}  // namespace beamgyro::internal
