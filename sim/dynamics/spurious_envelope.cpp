// SPDX-License-Identifier: MIT
#include "sim/dynamics/spurious_envelope.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim/dynamics/complex_form.h"

namespace beamgyro::internal {

using Eigen::Index;
using Eigen::Vector2cd;
using Eigen::Vector2d;

SpuriousOscillators::SpuriousOscillators(const TrimmedGyro& gyro)
    : modes_(gyro.device.spurious_modes),
      reference_(gyro.spurious_reference),
      mass_(gyro.beam.mass),
      have_memory_(
          std::ranges::any_of(modes_, [](const SpuriousModeParameters& mode) {
            return mode.drift != 0 || mode.slip != 0;
          })) {}

const std::vector<SpuriousOscillator>& SpuriousOscillators::at(
    const SpuriousTemperatures& temperatures, const MemoryState& memory) {
  now_.clear();
  if (modes_.empty()) return now_;
  const std::vector<SpuriousResonance> resonances =
      spurious_resonances(modes_, reference_, mass_, temperatures, memory);
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const SpuriousResonance& one = resonances[i];
    const double w_s = std::sqrt(one.square);
    const double rise = reference_ * modes_[i].detuning_tc;  // of w_s
    now_.push_back({one.square, one.width, one.coupling / std::sqrt(mass_),
                    2 * w_s * rise, modes_[i].loss_factor * rise,
                    modes_[i].follows_housing});
  }
  return now_;
}

Eigen::VectorXd spurious_error_weights(const TrimmedGyro& gyro) {
  std::vector<double> weights;
  for (const SpuriousModeParameters& mode : gyro.device.spurious_modes) {
    const double e =
        std::max(std::abs(mode.coupling_drive), std::abs(mode.coupling_sense));
    const double weight = std::min(1.0, 2 / (gyro.spurious_reference * e));
    weights.insert(weights.end(), 2, weight);
  }
  return Eigen::Map<const Eigen::VectorXd>(weights.data(), std::ssize(weights));
}

SpuriousEnvelope::SpuriousEnvelope(const std::vector<SpuriousOscillator>& modes,
                                   double omega, const Vector2cd& U,
                                   const Amplitudes& Z)
    : oscillators_(modes),
      omega_(omega),
      Z_(Z),
      U_(U),
      force_(Vector2cd::Zero()),
      force_rate_(Vector2cd::Zero()) {
  modes_.reserve(modes.size());
  for (const SpuriousOscillator& mode : modes) {
    const Complex Z_s = Z(static_cast<Index>(modes_.size()));
    const Vector2d& g = mode.coupling;
    const Complex P(mode.width, 2 * omega);
    const Complex r = std::conj(P) / std::norm(P);
    const Complex S(mode.square - omega * omega, omega * mode.width);
    const Complex v = -r * (S * Z_s + g(0) * U(0) + g(1) * U(1));
    modes_.push_back({g, r, S, v});
    force_ -= Z_s * g;
    force_rate_ -= v * g;
  }
}

SpuriousEnvelope::Amplitudes SpuriousEnvelope::rates(
    const Vector2cd& v_U) const {
  Amplitudes rates(Z_.size());
  for (Index i = 0; i < rates.size(); ++i) {
    const Mode& m = modes_[static_cast<std::size_t>(i)];
    rates(i) =
        m.v + m.r * m.r * (m.S * m.v + m.g(0) * v_U(0) + m.g(1) * v_U(1));
  }
  return rates;
}

SpuriousEnvelope::Slope SpuriousEnvelope::slope(
    const Vector2cd& v_U, const std::vector<Complex>& dP,
    const std::vector<Complex>& dS) const {
  Slope slope{Vector2cd::Zero(), Amplitudes(Z_.size())};
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const Mode& m = modes_[i];
    const Complex dr = -m.r * m.r * dP[i];
    const Complex dv = dr / m.r * m.v - m.r * dS[i] * Z_(k);
    const Complex bracket = m.S * m.v + m.g(0) * v_U(0) + m.g(1) * v_U(1);
    slope.force_rate -= dv * m.g;
    slope.rates(k) =
        dv + 2.0 * m.r * dr * bracket + m.r * m.r * (dS[i] * m.v + m.S * dv);
  }
  return slope;
}

SpuriousEnvelope::Slope SpuriousEnvelope::by_frequency(
    const Vector2cd& v_U) const {
  std::vector<Complex> dP, dS;
  for (const SpuriousOscillator& mode : oscillators_) {
    dP.push_back(2.0 * kI);
    dS.emplace_back(-2 * omega_, mode.width);
  }
  return slope(v_U, dP, dS);
}

SpuriousEnvelope::Slope SpuriousEnvelope::by_temperature(
    const Vector2cd& v_U, bool of_housing) const {
  std::vector<Complex> dP, dS;
  for (const SpuriousOscillator& mode : oscillators_) {
    const bool follows = mode.follows_housing == of_housing;
    dP.emplace_back(follows ? mode.width_slope : 0);
    dS.push_back(follows ? Complex(mode.square_slope, omega_ * mode.width_slope)
                         : Complex(0));
  }
  return slope(v_U, dP, dS);
}

SpuriousEnvelope::Couplings SpuriousEnvelope::couplings() const {
  const Index n = Z_.size();
  Couplings c{Eigen::Matrix2cd::Zero(),
              Eigen::Matrix2Xcd(2, n),
              Eigen::Matrix2Xcd(2, n),
              Eigen::MatrixX2cd(n, 2),
              Amplitudes(n),
              Eigen::MatrixX2cd(n, 2)};
  for (Index i = 0; i < n; ++i) {
    const Mode& m = modes_[static_cast<std::size_t>(i)];
    const Complex r2 = m.r * m.r, own = 1.0 + r2 * m.S;
    c.force_rate_by_U += m.r * (m.g * m.g.transpose());
    c.force_by_Z.col(i) = -m.g.cast<Complex>();
    c.force_rate_by_Z.col(i) = m.r * m.S * m.g;
    c.rates_by_U.row(i) = -m.r * own * m.g.transpose();
    c.rates_by_own(i) = -m.r * own * m.S;
    c.rates_by_v.row(i) = r2 * m.g.transpose();
  }
  return c;
}

}  // namespace beamgyro::internal
