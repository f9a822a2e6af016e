// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "validation/checks/check_context.h"

namespace beamgyro::internal {

constexpr double kGainTolerance = 1e-3;       // [-]
constexpr double kCorrectedTolerance = 5e-3;  // [-], of a corrected one
constexpr double kRateResolution = 1e-3;      // [deg/s], less is not counted

/// What became of a rate that was added.
struct AddedRate {
  double rate;         // [deg/s], to which it was added, or which was added
  double gain;         // [-], share of it in the answers
  double temperature;  // [degC]; NaN where it is not measured
  double time;         // [s]; NaN in a sweep over temperature
  double change;       // [deg/s], what was added
};

/// Returns where a gain was found: "at 25.1 degC, 360 s into its run".
std::string place_words(const AddedRate& found);

/// Collects gains and judges the worst one. A compensator either keeps the
/// rate, gain 1 within kGainTolerance, or corrects the scale factor s, gain
/// 1 / s within kCorrectedTolerance; then it has to leave less than half of the
/// largest departure that rate tables show. Where s is not known,
/// ScaleFactorCurve::departure_of_corrected() counts.
class GainJudge {
 public:
  explicit GainJudge(const ScaleFactorCurve& curve) : curve_(&curve) {}

  void add(const AddedRate& found);
  /// The same where the scale factor of the recorded rate is known.
  void add(const AddedRate& found, double scale_factor);
  void add(const GainJudge& other);
  std::size_t count() const { return count_; }

  bool corrects() const;
  bool passed() const;
  double departure() const { return judged().departure; }  // [-], of worst()
  double limit() const;
  /// Returns the result of a check of the gains alone, without words.
  CheckResult result() const {
    return {
        .outcome = passed_if(passed()), .value = departure(), .limit = limit()};
  }
  /// Returns the one that departs most; of those that lose all or more that of
  /// the largest rate. There must be one.
  const AddedRate& worst() const;

 private:
  struct Worst {
    double departure = 0.0;
    std::optional<AddedRate> where = {};
  };
  static void keep(Worst& worst, double departure, const AddedRate& where);
  const Worst& judged() const { return corrects() ? corrected_ : kept_; }

  const ScaleFactorCurve* curve_;
  Worst kept_, corrected_;
  std::size_t count_ = 0;
};

}  // namespace beamgyro::internal
