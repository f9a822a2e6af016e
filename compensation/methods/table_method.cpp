// SPDX-License-Identifier: MIT
#include "compensation/methods/table_method.h"

#include <fmt/format.h>

#include "compensation/methods/fit.h"
#include "compensation/methods/input_scales.h"

namespace beamgyro::internal {

TableSpec TableSpec::read(MethodSource& source) {
  return {source.table(kName).number_or("bin_width_K", 5.0, positive())};
}

std::string TableSpec::method_name() const {
  return fmt::format("table of {:g} K bins", bin_width_K);
}

Fit TableSpec::fit(const FitTask& task) const {
  return BiasModel{
      unscaled(task),
      {},
      fit_lookup_table(first_input(task), task.rows.bias, bin_width_K)};
}

}  // namespace beamgyro::internal
