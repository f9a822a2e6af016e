// SPDX-License-Identifier: MIT
#include "compensation/methods/fuzzy_method.h"

#include <fmt/format.h>

#include "compensation/methods/fit.h"
#include "compensation/methods/input_scales.h"

namespace beamgyro::internal {

FuzzySpec FuzzySpec::read(MethodSource& source) {
  return {
      static_cast<int>(source.table(kName).integer_or("rules", 8, 2, 1000))};
}

std::string FuzzySpec::method_name() const {
  return fmt::format("fuzzy model of {} rules", rules);
}

Fit FuzzySpec::fit(const FitTask& task) const {
  const std::vector<Scale> scales = scales_of(task);
  return BiasModel{scales,
                   {},
                   fit_takagi_sugeno(scaled(task.rows.inputs, scales),
                                     task.rows.bias, rules)};
}

}  // namespace beamgyro::internal
