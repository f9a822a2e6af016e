// SPDX-License-Identifier: MIT
#include "compensation/methods/constant_method.h"

#include "compensation/methods/fit.h"
#include "compensation/methods/method_inputs.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {

Eigen::ArrayXd NoBias::predict(
    const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  return Eigen::ArrayXd::Zero(x.rows());
}

nlohmann::ordered_json NoBias::parameters() const {
  return nlohmann::ordered_json::object();
}

Eigen::ArrayXd ConstantBias::predict(
    const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  return Eigen::ArrayXd::Constant(x.rows(), value);
}

nlohmann::ordered_json ConstantBias::parameters() const {
  return {{"value_deg_per_s", finite_json(value)}};
}

ConstantBias ConstantBias::read(const JsonNode& node, std::size_t) {
  return {node.at("value_deg_per_s").number()};
}

void ConstantBias::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"constant", "[deg/s]", {single(value)}});
}

NoneSpec NoneSpec::read(MethodSource&) { return {}; }

std::string NoneSpec::method_name() const { return kName; }

Fit NoneSpec::fit(const FitTask& task) const {
  return BiasModel{unscaled(task), {}, NoBias{}};
}

ConstantSpec ConstantSpec::read(MethodSource&) { return {}; }

std::string ConstantSpec::method_name() const { return kName; }

Fit ConstantSpec::fit(const FitTask& task) const {
  return BiasModel{unscaled(task), {}, ConstantBias{task.rows.bias.mean()}};
}

}  // namespace beamgyro::internal
