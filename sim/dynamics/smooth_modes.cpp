// SPDX-License-Identifier: MIT
#include "sim/dynamics/smooth_modes.h"

#include <algorithm>
#include <array>

#include "sim/dynamics/chebyshev.h"

namespace beamgyro::internal {

SmoothModes::SmoothModes(const TrimmedGyro& gyro, double low, double high) {
  for (std::size_t p = 0; p < direction_.size(); ++p) {
    direction_[p] = patch_position(gyro.device, static_cast<Patch>(p))
                        .normalized()
                        .cast<Complex>();
  }
  TrimmedGyro untrimmed = gyro;
  untrimmed.stiffness_trim = 0;
  untrimmed.spurious_reference = 0;
  std::vector<double> cuts = modal_kinks(gyro.device);
  std::erase_if(cuts, [&](double T) { return T <= low || T >= high; });
  cuts.insert(cuts.end(), {low, high});
  std::ranges::sort(cuts);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] < cuts[i + 1]) add(untrimmed, cuts[i], cuts[i + 1]);
  }
}

// Halves the piece until it agrees with the exact parameters where the error of
// Chebyshev interpolation is largest.
void SmoothModes::add(const TrimmedGyro& untrimmed, double low, double high) {
  constexpr double kSmallest = 1e-3;  // [K]
  static const Eigen::MatrixXd transform =
      chebyshev_transform(kNodes).transpose();
  Piece piece{low, high, {}};
  Eigen::Matrix<double, kModalChannelCount, kNodes> values;
  const auto place = [&](double x) {
    return 0.5 * (low + high) + 0.5 * (high - low) * x;
  };
  for (int i = 0; i < kNodes; ++i)
    values.col(i) = modal_channels(untrimmed, place(chebyshev_node(i, kNodes)));
  piece.coefficients = (values * transform).array();
  constexpr std::array<double, 3> kProbes = {-1, 0.1, 0.97};
  const bool is_good =
      high - low < kSmallest || std::ranges::all_of(kProbes, [&](double x) {
        const double T = place(x);
        return are_equal(value(piece, T), modal_channels(untrimmed, T));
      });
  if (is_good) {
    pieces_.push_back(piece);
    return;
  }
  add(untrimmed, low, place(0));
  add(untrimmed, place(0), high);
}

// Clenshaw's recurrence.
ModalChannels SmoothModes::value(const Piece& piece, double T) {
  const double x = (2 * T - piece.low - piece.high) / (piece.high - piece.low);
  ModalChannels next = ModalChannels::Zero(), after = next;
  for (int k = kNodes - 1; k > 0; --k) {
    const ModalChannels now = piece.coefficients.col(k) + 2 * x * next - after;
    after = next;
    next = now;
  }
  return piece.coefficients.col(0) + x * next - after;
}

ModalParameters SmoothModes::at(
    const TrimmedGyro& gyro, const SpuriousTemperatures& temperatures) const {
  const double T = temperatures.beam;
  const auto piece =
      std::find_if(pieces_.begin(), pieces_.end() - 1,
                   [&](const Piece& one) { return T <= one.high; });
  const double m = gyro.beam.mass;
  const ModalChannels channels = value(*piece, T);
  ModalParameters modal;
  modal.temperature = T;
  modal.mass = m;
  modal.coriolis_mass = gyro.beam.angular_gain * m;
  modal.stiffness = m * stiffness_of(channels);
  modal.stiffness(0, 1) += gyro.stiffness_trim;
  modal.stiffness(1, 0) += gyro.stiffness_trim;
  modal.damping = m * damping_of(channels);
  for (std::size_t p = 0; p < direction_.size(); ++p)
    modal.coupling[p] =
        (m * coupling_of(channels, static_cast<Patch>(p))) * direction_[p];
  add_spurious_modes(gyro, temperatures, {}, modal);
  return modal;
}

}  // namespace beamgyro::internal
