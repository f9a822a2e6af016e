// SPDX-License-Identifier: MIT
#include "compensation/methods/spline_method.h"

#include "compensation/methods/fit.h"
#include "compensation/methods/input_scales.h"

namespace beamgyro::internal {

SplineSpec SplineSpec::read(MethodSource& source) {
  const ConfigTable table = source.table(kName);
  SplineSpec spec;
  spec.knot_spacing_K =
      table.number_or("knot_spacing_K", spec.knot_spacing_K, positive());
  spec.end = table.choice_or("ends", "not_a_knot", {"not_a_knot", "natural"}) ==
                     "natural"
                 ? SplineEnd::kNatural
                 : SplineEnd::kNotAKnot;
  return spec;
}

std::string SplineSpec::method_name() const { return "cubic spline"; }

Fit SplineSpec::fit(const FitTask& task) const {
  const Eigen::ArrayXd temperature = first_input(task);
  return BiasModel{
      unscaled(task),
      {},
      fit_cubic_spline(temperature, task.rows.bias,
                       spline_knots(temperature, knot_spacing_K), end)};
}

}  // namespace beamgyro::internal
