// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sim/dynamics/gyro.h"
#include "sim/dynamics/smooth_modes.h"
#include "sim/memory/memory_trajectory.h"

namespace beamgyro::internal {

/// Static response of one gyro, tabulated over a range of beam temperatures and
/// rates, so that a sample costs some ten nanoseconds. The table holds
/// Chebyshev polynomials in temperature, times one Chebyshev polynomial in
/// rate. Pieces end at the kinks of the materials and are halved until the
/// table agrees with the exact solution (2.10).
///
/// For a unit with memory the table has up to three more dimensions, T_f -
/// T_f,ref, hysteresis and age, over the range of each that the run visits;
/// that of T_f - T_f,ref is the range within the piece. Each takes as few
/// Chebyshev polynomials as the tolerance allows; docs/model.md says how many
/// that are. What two states do together takes few, and what three do together
/// none, unless the exact solution disagrees.
///
/// For a unit with spurious modes the housing is as warm as the beam, and the
/// table also holds the response at rest without them. It follows their bumps
/// by smaller pieces.
class StaticMap {
 public:
  /// Tabulates temperatures in [low, high] [K] and rates up to +-`rate_limit`
  /// [rad/s]. The error of the demodulated signal stays below `tolerance`
  /// [rad/s]; the default is 1e-6 deg/s.
  StaticMap(const TrimmedGyro& gyro, double low, double high, double rate_limit,
            double tolerance = 1.7e-8);

  /// Returns the range of the memory states while the beam is within two
  /// temperatures [K].
  using MemoryBounds = std::function<MemoryRange(double low, double high)>;

  /// The same for a unit with memory; the default tolerance is 1e-5 deg/s.
  /// Throws SimulationFailure where the range of the states holds one in which
  /// the drive loop cannot lock, or more than so many polynomials and pieces
  /// resolve: the states that the unit visits may be harmless, and can be
  /// solved one by one.
  StaticMap(const TrimmedGyro& gyro, double low, double high, double rate_limit,
            MemoryBounds bounds, double tolerance = 1.7e-7);

  struct Signals {
    BeamSignal at_rate;
    std::complex<double> at_rest;  // demodulated, twin at rate 0 [rad/s]
    // The same without_spurious_modes().
    std::complex<double> without_spurious;
  };
  /// Returns the response at T [K], which must lie in the tabulated range (to
  /// 1e-6 K), and at a rate [rad/s] below the limit.
  Signals at(double T, double rate, const MemoryState& memory = {}) const;

  /// Writes at() of every T, rate and memory state. The spans have the same
  /// length, but that of the states may be empty for a unit without memory.
  void sample(std::span<const double> T, std::span<const double> rate,
              std::span<const MemoryState> memory,
              std::span<Signals> signals) const;

  int pieces() const { return static_cast<int>(pieces_.size()); }

 private:
  // Re, Im of the demodulated signal, drive frequency, voltage.
  static constexpr int kChannels = 4, kFrequency = 2;
  static constexpr int kTemperatureNodes = 10, kMaxRates = 12;
  static constexpr Eigen::Index kBlock = 64;  // samples at a time
  template <int kColumns>
  using Lanes = Eigen::Array<double, Eigen::Dynamic, kColumns, 0, kBlock,
                             kColumns == Eigen::Dynamic ? kMaxRates : kColumns>;

  static constexpr int kMemoryAxes = 3, kMaxMemoryNodes = 12;
  static constexpr int kGlassAxis = 0;
  using MemoryPoint = std::array<double, kMemoryAxes>;

  // The memory states of a piece: nodes along each axis, 1 where the state does
  // not change.
  struct MemoryBox {
    MemoryPoint middle{}, half{};
    std::array<int, kMemoryAxes> nodes = {1, 1, 1};

    int size() const { return nodes[0] * nodes[1] * nodes[2]; }
    MemoryState state(const MemoryPoint& place) const;  // -1 .. 1 each
    MemoryState node_state(int index) const;
    Eigen::MatrixXd transform() const;
  };
  struct Piece {
    double low, high;  // [K]
    // (channel x rate degree x memory polynomial) x temperature node
    Eigen::MatrixXd coefficients;
    MemoryBox memory = {};
    std::vector<int> terms = {};         // of each row
    std::vector<int> memory_terms = {};  // polynomials that have terms, from 1
    // Re, Im of the demodulated signal, voltage x temperature node; at rest
    // without spurious modes.
    Eigen::MatrixXd without_spurious = {};
  };
  class MemoryResponse;
  struct Channels {  // one row a sample
    Lanes<kChannels> at_rate, at_rest;
    Lanes<2> without_spurious;
  };

  static double weighted(const Eigen::Vector4d& error);
  void tabulate(double low, double high);
  MemoryBox memory_box(double low, double high);
  int needed_memory_nodes(std::span<const double> temperatures,
                          const MemoryBox& box, int axis);
  bool add_part(Piece& piece, const std::array<int, kMemoryAxes>& nodes,
                int temperature_nodes, bool is_pair);
  std::optional<Eigen::MatrixXd> lacking(const Piece& piece,
                                         const MemoryBox& box,
                                         const Eigen::MatrixXd& in_temperature,
                                         bool is_pair);
  void add_coefficients(Piece& piece, const MemoryBox& box,
                        Eigen::MatrixXd& values,
                        const Eigen::MatrixXd& in_temperature) const;
  bool add_memory(Piece& piece);
  void prune(Piece& piece) const;
  Eigen::Vector4d value(const Piece& piece, double T, double rate,
                        const MemoryState& memory) const;
  Eigen::Vector4d exact(const ModalParameters& modal, double rate,
                        double guess = 0);
  ModalParameters modal(double T, const MemoryState& memory) const;
  void add_without_spurious(Piece& piece);
  std::optional<Piece> fitted(double low, double high);
  double error(const Piece& piece, double memory_share = 1);
  void refine(double low, double high);
  std::vector<double> rate_temperatures(double low, double high);
  int needed_rate_degree(double low, double high);
  Channels channels(const Piece& piece, std::span<const double> T,
                    std::span<const double> rate,
                    std::span<const MemoryState> memory) const;
  Lanes<Eigen::Dynamic> memory_basis(const MemoryBox& box, int axis,
                                     std::span<const MemoryState> memory) const;
  Signals single(const Piece& piece, double T, double rate) const;
  Signals signals_of(const Piece& piece, double T, double rate,
                     const Eigen::Vector4d& at_rate,
                     const Eigen::Vector4d& at_rest,
                     Complex without_spurious) const;
  BeamSignal limited(const Eigen::Vector4d& channels) const;
  std::complex<double> without_spurious(const Piece& piece, double T) const;
  const Piece& piece_at(double T) const;

  TrimmedGyro gyro_;
  MemoryBounds bounds_;
  std::array<int, kMemoryAxes> memory_nodes_ = {1, 1, 1};  // of all pieces
  LockPath path_;
  // Of a unit with spurious modes, and the path of the one without.
  std::optional<TrimmedGyro> without_;
  LockPath without_path_;
  std::optional<SmoothModes> smooth_;
  double rate_limit_, tolerance_;
  double voltage_limit_;
  int rate_degree_ = 0;
  int fits_ = 0;                              // pieces that have been tried
  Eigen::MatrixXd in_rate_, in_temperature_;  // node_transform() of each
  std::vector<Piece> pieces_;
};

}  // namespace beamgyro::internal
