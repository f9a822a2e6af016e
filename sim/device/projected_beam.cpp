// SPDX-License-Identifier: MIT
#include "sim/device/projected_beam.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamgyro::internal {

// Distance of a patch centre from the beam axis along its face normal [m].
double lever_arm(const DeviceParameters& device, double bond_thickness) {
  return 0.5 * device.beam.side + bond_thickness +
         0.5 * device.patches.thickness;
}

namespace {

struct Stretch {
  double start, end;  // [m]
  bool under_patches;
};

// Element boundaries fall on patch edges and supports.
std::vector<Stretch> stretches(const DeviceParameters& device) {
  const double L = device.beam.length;
  const double edge = 0.5 * (L - device.patches.length);
  const double pin = kSupportPosition * L;
  std::vector<double> cuts = {0, pin, edge, L - edge, L - pin, L};
  std::sort(cuts.begin(), cuts.end());
  std::vector<Stretch> parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i + 1] - cuts[i] < 1e-9 * L) continue;
    const double centre = 0.5 * (cuts[i] + cuts[i + 1]);
    parts.push_back({cuts[i], cuts[i + 1], centre > edge && centre < L - edge});
  }
  return parts;
}

// int rho A phi^2 dz and int rho I phi'^2 [kg].
struct Masses {
  double translation = 0, rotation = 0;
};

Masses modal_masses(const std::vector<BeamElement>& elements,
                    const Eigen::VectorXd& shape) {
  std::vector<BeamElement> translating = elements;
  for (BeamElement& e : translating) e.rotary_inertia = 0;
  Masses masses;
  masses.translation = shape.dot(assemble_beam(translating).mass * shape);
  for (std::size_t k = 0; k < elements.size(); ++k) {
    masses.rotation +=
        elements[k].rotary_inertia *
        shape_integrals(shape, static_cast<int>(k), elements[k].length)
            .slope_squared;
  }
  return masses;
}

}  // namespace

CompositeBeam composite_beam(const DeviceParameters& device, int count) {
  const BeamParameters& beam = device.beam;
  const PatchParameters& patches = device.patches;
  const double a2 = beam.side * beam.side;
  double mean_bond = 0;
  for (const double t : device.bond.thickness) mean_bond += 0.25 * t;
  const double h = lever_arm(device, mean_bond);
  const double A = patches.width * patches.thickness;
  const double nu = beam.poisson_ratio;
  const double kappa = 10 * (1 + nu) / (12 + 11 * nu);  // Cowper, square
  const double second_moments =
      2 * h * h +
      (patches.thickness * patches.thickness + patches.width * patches.width) /
          6;

  BeamElement metal{};
  metal.bending_stiffness = beam.youngs_modulus * a2 * a2 / 12;
  metal.shear_stiffness = kappa * beam.youngs_modulus / (2 * (1 + nu)) * a2;
  metal.line_density = beam.density * a2;
  metal.rotary_inertia = beam.density * a2 * a2 / 12;
  BeamElement composite = metal;
  composite.bending_stiffness += patches.youngs_modulus * A * second_moments;
  composite.line_density += 4.0 * patches.density * A;
  composite.rotary_inertia += patches.density * 2 * A * h * h;

  CompositeBeam mesh;
  for (const Stretch& part : stretches(device)) {
    const double length = part.end - part.start;
    const int n = std::max(
        1, static_cast<int>(std::lround(count * length / beam.length)));
    BeamElement element = part.under_patches ? composite : metal;
    element.length = length / n;
    const double centre = 0.5 * (part.start + part.end) / beam.length;
    mesh.elements.insert(mesh.elements.end(), static_cast<std::size_t>(n),
                         element);
    mesh.under_patches.insert(mesh.under_patches.end(),
                              static_cast<std::size_t>(n), part.under_patches);
    mesh.between_pins.insert(
        mesh.between_pins.end(), static_cast<std::size_t>(n),
        centre > kSupportPosition && centre < 1 - kSupportPosition);
  }
  return mesh;
}

ProjectedBeam project_beam(const DeviceParameters& device, int elements) {
  const CompositeBeam mesh = composite_beam(device, elements);
  std::vector<BeamElement> euler = mesh.elements;
  for (BeamElement& e : euler) {
    e.shear_stiffness = std::numeric_limits<double>::infinity();
    e.rotary_inertia = 0;
  }
  const BendingMode mode = first_bending_mode(euler);
  const BendingMode timoshenko = first_bending_mode(mesh.elements);
  const Masses masses = modal_masses(mesh.elements, mode.shape);

  ProjectedBeam beam{};
  beam.euler_frequency = mode.angular_frequency;
  beam.timoshenko_frequency = timoshenko.angular_frequency;
  beam.mass = masses.translation;
  const double ratio = beam.timoshenko_frequency / beam.euler_frequency;
  beam.stiffness_scale = ratio * ratio;
  beam.angular_gain = device.beam.angular_gain.value_or(
      masses.translation / (masses.translation + masses.rotation));
  for (std::size_t k = 0; k < euler.size(); ++k) {
    const ShapeIntegrals part =
        shape_integrals(mode.shape, static_cast<int>(k), euler[k].length);
    beam.curvature_squared += part.curvature_squared;
    if (mesh.between_pins[k])
      beam.slope_squared_between_pins += part.slope_squared;
    if (!mesh.under_patches[k]) continue;
    beam.patch_curvature_squared += part.curvature_squared;
    beam.patch_curvature += part.curvature;
  }
  beam.mid_deflection =
      deflection(mesh.elements, mode.shape, 0.5 * device.beam.length);
  return beam;
}

}  // namespace beamgyro::internal
