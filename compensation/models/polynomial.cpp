// SPDX-License-Identifier: MIT
#include "compensation/models/polynomial.h"

#include <fmt/format.h>

#include <stdexcept>

#include "compensation/firmware/runtime.h"
#include "compensation/models/bias_function.h"
#include "compensation/models/parameter_json.h"
#include "linear_algebra/cholesky.h"
#include "linear_algebra/least_squares.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

Eigen::MatrixXd terms(const Eigen::Ref<const ArrayXXd>& x, int degree) {
  Eigen::MatrixXd columns(x.rows(), degree + x.cols());
  columns.col(0).setOnes();
  for (int n = 1; n <= degree; ++n)
    columns.col(n) = columns.col(n - 1).array() * x.col(0);
  columns.rightCols(x.cols() - 1) = x.rightCols(x.cols() - 1).matrix();
  return columns;
}

Polynomial polynomial_of(const Eigen::VectorXd& c, int degree) {
  return {{c.begin(), c.begin() + degree + 1},
          {c.begin() + degree + 1, c.end()}};
}

}  // namespace

ArrayXd Polynomial::predict(const Eigen::Ref<const ArrayXXd>& x) const {
  ArrayXd y = ArrayXd::Zero(x.rows());
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c)
    y = y * x.col(0) + *c;
  for (std::size_t j = 0; j < slopes.size(); ++j)
    y += slopes[j] * x.col(static_cast<Index>(j) + 1);
  return y;
}

Polynomial fit_polynomial(const Eigen::Ref<const ArrayXXd>& x,
                          const Eigen::Ref<const ArrayXd>& y, int degree) {
  const Eigen::MatrixXd columns = terms(x, degree);
  const auto [solution, rank] = least_squares(columns, y.matrix());
  if (rank < columns.cols())
    throw UndeterminedFit(
        fmt::format("polynomial of degree {}: the {} rows determine only {} of "
                    "its {} coefficients",
                    degree, x.rows(), rank, columns.cols()));
  return polynomial_of(solution, degree);
}

Polynomial fit_polynomial_by_normal_equations(
    const Eigen::Ref<const ArrayXXd>& x, const Eigen::Ref<const ArrayXd>& y,
    int degree) {
  const Eigen::MatrixXd columns = terms(x, degree);
  const Cholesky normal(columns.transpose() * columns);
  if (!normal.is_positive_definite())
    throw UndeterminedFit(fmt::format(
        "polynomial of degree {}: the normal equations of {} rows cannot be "
        "solved in double precision; normalised = true needs none",
        degree, x.rows()));
  return polynomial_of(
      normal.solve(Eigen::VectorXd(columns.transpose() * y.matrix())), degree);
}

std::vector<double> shifted(std::vector<double> coefficients, double origin) {
  // Repeated synthetic division.
  for (std::size_t n = 0; n < coefficients.size(); ++n)
    for (std::size_t k = coefficients.size() - 1; k-- > n;)
      coefficients[k] += origin * coefficients[k + 1];
  return coefficients;
}

nlohmann::ordered_json Polynomial::parameters() const {
  return {{"coefficients", numbers_json(coefficients)},
          {"slopes", numbers_json(slopes)}};
}

Polynomial Polynomial::read(const JsonNode& node, std::size_t inputs) {
  Polynomial polynomial{node.at("coefficients").numbers(),
                        node.at("slopes").numbers()};
  if (polynomial.coefficients.empty())
    node.at("coefficients").fail("[], must have at least one coefficient");
  if (polynomial.slopes.size() + 1 != inputs)
    node.at("slopes").fail(
        fmt::format("{} slopes, must be one for each of the {} inputs but the "
                    "first",
                    polynomial.slopes.size(), inputs));
  return polynomial;
}

void Polynomial::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"coefficients", "of the powers 0, 1, ... of x[0]",
              singles(coefficients)});
  if (!slopes.empty()) arrays.add({"slopes", "of x[1], ...", singles(slopes)});
}

float Polynomial::firmware_value(const FirmwareArrays& arrays,
                                 std::span<const float> x) const {
  float y = runtime::polynomial_of(arrays.data("coefficients"),
                                   arrays.count("coefficients"), x[0]);
  for (std::size_t j = 1; j < x.size(); ++j)
    y = y + arrays.values("slopes")[j - 1] * x[j];
  return y;
}

FirmwareCode Polynomial::firmware_code(std::size_t inputs) const {
  std::string body =
      fmt::format("  float y = polynomial_of(coefficients, {}, x[0]);\n",
                  coefficients.size());
  for (std::size_t j = 1; j < inputs; ++j)
    body += fmt::format("  y = y + slopes[{}] * x[{}];\n", j - 1, j);
  return {{"polynomial"}, body + "  return y;\n"};
}

}  // namespace beamgyro::internal
