// SPDX-License-Identifier: MIT
#include "compensation/methods/thermistor_method.h"

#include "compensation/methods/fit.h"
#include "compensation/methods/input_scales.h"

namespace beamgyro::internal {

ThermistorSpec ThermistorSpec::read(MethodSource& source) {
  return {source.table(kName).number_or("b_K", 3950.0, positive())};
}

std::string ThermistorSpec::method_name() const { return "thermistor network"; }

Fit ThermistorSpec::fit(const FitTask& task) const {
  return BiasModel{
      unscaled(task),
      {},
      fit_thermistor_network(first_input(task), task.rows.bias, b_K)};
}

}  // namespace beamgyro::internal
