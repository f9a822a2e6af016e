// SPDX-License-Identifier: MIT
#include "compensation/bias_model.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <stdexcept>

namespace beamgyro {
namespace {

struct Predict {
  const Eigen::ArrayXXd& x;

  Eigen::ArrayXd operator()(const BpNetwork& network) const {
    return network.predict(x);
  }
  template <class OneInput>
  Eigen::ArrayXd operator()(const OneInput& curve) const {
    return curve.predict(x.col(0));
  }
};

}  // namespace

Scale scale_to_unit(const Eigen::Ref<const Eigen::ArrayXd>& values,
                    const std::string& what) {
  const double low = values.minCoeff(), high = values.maxCoeff();
  if (!(high > low))
    throw std::invalid_argument(
        fmt::format("{} is {} in all {} training rows; the model needs rows "
                    "where it varies",
                    what, low, values.size()));
  return {0.5 * (low + high), 0.5 * (high - low)};
}

Eigen::ArrayXd BiasModel::predict(
    const Eigen::Ref<const Eigen::ArrayXXd>& x) const {
  assert(x.cols() == static_cast<Eigen::Index>(input_scales.size()));
  Eigen::ArrayXXd scaled(x.rows(), x.cols());
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Scale& scale = input_scales[static_cast<std::size_t>(i)];
    scaled.col(i) = (x.col(i) - scale.centre) / scale.half_width;
  }
  return bias_scale.centre +
         bias_scale.half_width * std::visit(Predict{scaled}, function);
}

std::string kind_name(const BiasModel& model) {
  constexpr const char* kNames[] = {"polynomial", "spline", "bp"};
  return kNames[model.function.index()];
}

EquationOne equation_one(const BiasModel& model) {
  const auto* polynomial = std::get_if<Polynomial>(&model.function);
  if (polynomial == nullptr)
    throw std::invalid_argument(fmt::format(
        "equation (1) belongs to a polynomial, not to a model of kind {}",
        kind_name(model)));
  const Scale scale = model.input_scales.at(0);
  // Taylor shift of p from the centre of the scale to T0 by repeated synthetic
  // division, then powers of K instead of half widths.
  std::vector<double> c = polynomial->coefficients;
  const double x0 = (kReferenceTemperature - scale.centre) / scale.half_width;
  for (std::size_t n = 0; n < c.size(); ++n)
    for (std::size_t k = c.size() - 1; k-- > n;) c[k] += x0 * c[k + 1];
  EquationOne result;
  result.bias_at_reference =
      model.bias_scale.centre + model.bias_scale.half_width * c[0];
  for (std::size_t n = 1; n < c.size(); ++n)
    result.coefficients.push_back(model.bias_scale.half_width * c[n] /
                                  std::pow(scale.half_width, n) /
                                  result.bias_at_reference);
  return result;
}

}  // namespace beamgyro
