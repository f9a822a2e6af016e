// SPDX-License-Identifier: MIT
#include "compensation/methods/method_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace beamgyro {
namespace {

struct MethodName {
  std::string operator()(const NoneSpec&) const { return "none"; }
  std::string operator()(const ConstantSpec&) const { return "constant"; }
  std::string operator()(const PolynomialSpec& spec) const {
    const char* suffix = spec.normalised ? "" : ", not normalised";
    if (spec.degree == 1) return fmt::format("straight line{}", suffix);
    if (spec.degree == 3) return fmt::format("cubic{}", suffix);
    return fmt::format("polynomial of degree {}{}", spec.degree, suffix);
  }
  std::string operator()(const TableSpec& spec) const {
    return fmt::format("table of {:g} K bins", spec.bin_width_K);
  }
  std::string operator()(const SplineSpec&) const { return "cubic spline"; }
  std::string operator()(const Px4Spec&) const {
    return "cubic as PX4 fits it";
  }
  std::string operator()(const ArduPilotSpec&) const {
    return "cubic as ArduPilot fits it";
  }
  std::string operator()(const ThermistorSpec&) const {
    return "thermistor network";
  }
  std::string operator()(const FuzzySpec& spec) const {
    return fmt::format("fuzzy model of {} rules", spec.rules);
  }
  std::string operator()(const PopulationSpec&) const {
    return "mean of a population";
  }
  std::string operator()(const AdaptedSpec&) const {
    return "spline adapted from a population";
  }
  std::string operator()(const BpSpec& spec) const {
    return fmt::format("BP network {}", fmt::join(spec.hidden, "-"));
  }
};

}  // namespace

std::string method_name(const FitSpec& kind) {
  return std::visit(MethodName{}, kind);
}

}  // namespace beamgyro
