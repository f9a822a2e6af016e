// SPDX-License-Identifier: MIT
#include "sim/device/projected_beam.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "sim/numerics/simulation_failure.h"

namespace beamgyro::internal {
namespace {

using Eigen::Matrix4d;
using Eigen::RowVector4d;
using Eigen::VectorXd;

struct ShapeFunctions {
  RowVector4d deflection;      // w(xi) per degree of freedom
  RowVector4d rotation;        // theta(xi)
  RowVector4d rotation_slope;  // dtheta/dx
  RowVector4d shear;           // dw/dx - theta
};

// Interpolation that solves the static Timoshenko equations in the element.
ShapeFunctions shape_functions(double xi, double h, double phi) {
  const double s = 1.0 / (1.0 + phi), xi2 = xi * xi, xi3 = xi2 * xi;
  ShapeFunctions N;
  N.deflection << 2 * xi3 - 3 * xi2 - phi * xi + 1 + phi,
      h * (xi3 - (2 + phi / 2) * xi2 + (1 + phi / 2) * xi),
      -2 * xi3 + 3 * xi2 + phi * xi,
      h * (xi3 - (1 - phi / 2) * xi2 - phi / 2 * xi);
  N.rotation << 6 * (xi2 - xi) / h, 3 * xi2 - (4 + phi) * xi + 1 + phi,
      6 * (xi - xi2) / h, 3 * xi2 - (2 - phi) * xi;
  N.rotation_slope << (12 * xi - 6) / (h * h), (6 * xi - 4 - phi) / h,
      (6 - 12 * xi) / (h * h), (6 * xi - 2 + phi) / h;
  N.shear << -phi / h, -phi / 2, phi / h, -phi / 2;
  N.deflection *= s;
  N.rotation *= s;
  N.rotation_slope *= s;
  N.shear *= s;
  return N;
}

struct ElementMatrices {
  Matrix4d stiffness, mass;
};

ElementMatrices element_matrices(const BeamElement& e) {
  // Four Gauss points integrate the sixth-degree mass terms exactly.
  constexpr std::array<double, 2> kPoint = {0.3399810435848563,
                                            0.8611363115940526};
  constexpr std::array<double, 2> kWeight = {0.6521451548625461,
                                             0.3478548451374538};
  const double h = e.length;
  const double phi = 12 * e.bending_stiffness / (e.shear_stiffness * h * h);
  ElementMatrices element{Matrix4d::Zero(), Matrix4d::Zero()};
  for (std::size_t i = 0; i < 2; ++i) {
    for (const double side : {-1.0, 1.0}) {
      const ShapeFunctions N =
          shape_functions(0.5 * (1 + side * kPoint[i]), h, phi);
      const double dx = 0.5 * h * kWeight[i];
      element.stiffness += dx * e.bending_stiffness *
                           N.rotation_slope.transpose() * N.rotation_slope;
      if (phi > 0) {
        element.stiffness +=
            dx * e.shear_stiffness * N.shear.transpose() * N.shear;
      }
      element.mass +=
          dx * (e.line_density * N.deflection.transpose() * N.deflection +
                e.rotary_inertia * N.rotation.transpose() * N.rotation);
    }
  }
  return element;
}

// phi(z) and phi'(z) of the uniform free-free beam at the nodes (1.2).
VectorXd uniform_beam_mode(const std::vector<BeamElement>& elements) {
  double L = 0;
  for (const BeamElement& e : elements) L += e.length;
  const double b = kFreeFreeRoot / L;
  const double s = (std::cosh(kFreeFreeRoot) - std::cos(kFreeFreeRoot)) /
                   (std::sinh(kFreeFreeRoot) - std::sin(kFreeFreeRoot));
  VectorXd shape(2 * static_cast<Eigen::Index>(elements.size()) + 2);
  double z = 0;
  for (Eigen::Index i = 0; i < shape.size(); i += 2) {
    const double x = b * z;
    const double cosh = std::cosh(x), sinh = std::sinh(x);
    const double cos = std::cos(x), sin = std::sin(x);
    shape(i) = 0.5 * (cosh + cos - s * (sinh + sin));
    shape(i + 1) = 0.5 * b * (sinh - sin - s * (cosh + cos));
    const auto element = static_cast<std::size_t>(i / 2);
    if (element < elements.size()) z += elements[element].length;
  }
  return shape;
}

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

BeamMatrices assemble_beam(const std::vector<BeamElement>& elements) {
  const auto size = 2 * static_cast<Eigen::Index>(elements.size()) + 2;
  BeamMatrices beam{SymmetricBand(size), SymmetricBand(size)};
  ElementMatrices element;
  for (std::size_t k = 0; k < elements.size(); ++k) {
    if (k == 0 || elements[k] != elements[k - 1])
      element = element_matrices(elements[k]);
    const auto first = 2 * static_cast<Eigen::Index>(k);
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) {
        beam.stiffness.diagonals(first + j, i - j) += element.stiffness(i, j);
        beam.mass.diagonals(first + j, i - j) += element.mass(i, j);
      }
    }
  }
  return beam;
}

BendingMode first_bending_mode(const std::vector<BeamElement>& elements) {
  constexpr int kMaxIterations = 20;
  // A step of the quotient is the square of the previous error of the shape,
  // whose next error is the cube of that: 1e-7 leaves 3e-11.
  constexpr double kTolerance = 1e-7;
  const BeamMatrices beam = assemble_beam(elements);
  VectorXd phi = uniform_beam_mode(elements);

  double eigenvalue = 0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const VectorXd M_phi = beam.mass * phi;
    const double quotient = phi.dot(beam.stiffness * phi) / phi.dot(M_phi);
    if (std::abs(quotient - eigenvalue) <= kTolerance * quotient) {
      if (!(quotient > 0)) break;
      return {std::sqrt(quotient), phi / phi(0)};
    }
    eigenvalue = quotient;
    SymmetricBand shifted = beam.stiffness;
    shifted.diagonals -= quotient * beam.mass.diagonals;
    // At convergence the shifted matrix is singular to roundoff, which is what
    // makes the last solve so accurate in direction.
    std::optional<VectorXd> next = solved(shifted, M_phi);
    if (!next) return {std::sqrt(quotient), phi / phi(0)};
    phi = std::move(*next);
    phi /= phi.cwiseAbs().maxCoeff();
  }
  throw SimulationFailure(
      "beam: the first bending mode did not converge; check the beam and "
      "patch dimensions");
}

ShapeIntegrals shape_integrals(const VectorXd& shape, int element,
                               double length) {
  const double h = length;
  const double w1 = shape(2 * element), t1 = h * shape(2 * element + 1);
  const double w2 = shape(2 * element + 2), t2 = h * shape(2 * element + 3);
  const double start = (6 * (w2 - w1) - 4 * t1 - 2 * t2) / (h * h);
  const double end = (6 * (w1 - w2) + 2 * t1 + 4 * t2) / (h * h);
  // phi' is a parabola: Simpson's rule is exact for it, Boole's for its square.
  const auto slope = [&](double xi) {
    return (6 * (w2 - w1) * (xi - xi * xi) + t1 * (1 - 4 * xi + 3 * xi * xi) +
            t2 * (3 * xi * xi - 2 * xi)) /
           h;
  };
  const auto square = [&](double xi) { return slope(xi) * slope(xi); };
  return {h / 90 *
              (7 * square(0) + 32 * square(0.25) + 12 * square(0.5) +
               32 * square(0.75) + 7 * square(1)),
          (t2 - t1) / h, h / 3 * (start * start + start * end + end * end)};
}

double lever_arm(const DeviceParameters& device, double bond_thickness) {
  return 0.5 * device.beam.side + bond_thickness +
         0.5 * device.patches.thickness;
}

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
  return beam;
}

}  // namespace beamgyro::internal
