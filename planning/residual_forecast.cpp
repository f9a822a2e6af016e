// SPDX-License-Identifier: MIT
#include "planning/residual_forecast.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "planning/random_purposes.h"
#include "random/random_stream.h"

namespace beamgyro {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kLeastDevices = 3;   // one that is predicted by two others
constexpr Index kLeastDraws = 4000;  // of the noise, over all devices
constexpr Index kGaussianDraws = 8000;

// A matrix of normal numbers, from stream `number`.
MatrixXd normal_numbers(Index rows, Index columns, std::uint32_t number) {
  MatrixXd values(rows, columns);
  RandomStream stream(0, number, 0, kResidualForecastStream);
  stream.fill_normal(std::span<double>(
      values.data(), static_cast<std::size_t>(values.size())));
  return values;
}

// With straight lines between the order statistics.
double quantile_of(const std::vector<double>& sorted, double probability) {
  const double place = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above],
                   place - static_cast<double>(below));
}

ResidualForecast quantiles_of(std::vector<double> rms) {
  std::ranges::sort(rms);
  return {quantile_of(rms, 0.5), quantile_of(rms, 0.9), quantile_of(rms, 0.95)};
}

MatrixXd inverse_with_identity(MatrixXd B) {
  B.diagonal().array() += 1.0;
  return B.llt().solve(MatrixXd::Identity(B.rows(), B.cols()));
}

// Appends the residual of each device that is predicted by all others.
void append_residuals(const SoakModel& model, const MatrixXd& H,
                      const MatrixXd& noise, std::vector<double>& rms) {
  const MatrixXd& c = model.population().coefficients;
  const auto n = static_cast<double>(model.population().devices);
  const double alpha = (n - 1.0) / (n - 2.0);
  const double beta = n / (n - 1.0) / (n - 2.0), gamma = n / (n - 1.0);
  const MatrixXd B = inverse_with_identity(alpha * H * H.transpose());
  const MatrixXd g = c * H.transpose();  // H c, a row per device
  const MatrixXd Bg = g * B;
  MatrixXd w = (gamma * g + noise) * B;
  MatrixXd e = gamma * c;
  for (Index d = 0; d < c.rows(); ++d) {
    // S^-1 = (B^-1 - beta g g^T)^-1 by Sherman and Morrison.
    const double share = 1.0 - beta * g.row(d).dot(Bg.row(d));
    w.row(d) += beta * g.row(d).dot(w.row(d)) / share * Bg.row(d);
    e.row(d) += beta * g.row(d).dot(w.row(d)) * c.row(d);
  }
  e -= alpha * w * H;
  const VectorXd square = (e * model.weight()).cwiseProduct(e).rowwise().sum();
  for (const double value : square)
    rms.push_back(std::sqrt(std::max(value, 0.0)));
}

ResidualForecast forecast_of_devices(const SoakModel& model,
                                     const MatrixXd& H) {
  const Index devices = model.population().coefficients.rows();
  const Index rounds = (kLeastDraws + devices - 1) / devices;
  std::vector<double> rms;
  for (Index round = 0; round < rounds; ++round)
    append_residuals(
        model, H,
        normal_numbers(devices, H.rows(), static_cast<std::uint32_t>(round)),
        rms);
  return quantiles_of(std::move(rms));
}

ResidualForecast forecast_of_process(const SoakModel& model,
                                     const MatrixXd& H) {
  // The eigenvalues of L^T W L, L L^T = A^-1, are those of the posterior.
  MatrixXd A = H.transpose() * H;
  A.diagonal().array() += 1.0;
  const Eigen::LLT<MatrixXd> llt(A);
  const MatrixXd left = llt.matrixL().solve(model.weight());
  const MatrixXd posterior = llt.matrixL().solve(left.transpose());
  const VectorXd variance =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(posterior, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .cwiseMax(0.0);
  const VectorXd square = normal_numbers(kGaussianDraws, variance.size(), 0)
                              .array()
                              .square()
                              .matrix() *
                          variance;
  const Eigen::ArrayXd rms = square.array().sqrt();
  return quantiles_of({rms.begin(), rms.end()});
}

}  // namespace

ForecastBasis forecast_basis(const Population& population) {
  return population.coefficients.rows() >= kLeastDevices &&
                 population.devices >= population.coefficients.rows()
             ? ForecastBasis::kDevices
             : ForecastBasis::kGaussian;
}

ResidualForecast forecast_residual(const SoakModel& model,
                                   const std::vector<double>& soaks) {
  const MatrixXd H = model.equations(soaks);
  return forecast_basis(model.population()) == ForecastBasis::kDevices
             ? forecast_of_devices(model, H)
             : forecast_of_process(model, H);
}

}  // namespace beamgyro
