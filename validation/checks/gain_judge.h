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
  // Largest departure that answers rounded to 1 deg/s show [1/(deg/s)]; 0: that
  // of two answers, 1 / change.
  double of_rounding = 0.0;
};

/// Returns where a gain was found: "at 25.1 degC, 360 s into its run".
std::string place_words(const AddedRate& found);

/// Collects gains and judges the worst one. A compensator either keeps the
/// rate, gain 1 within kGainTolerance, or corrects the scale factor s, gain
/// 1 / s within kCorrectedTolerance; then it has to leave less than half of the
/// largest departure that held rates show. Where s is not known,
/// ScaleFactorCurve::departure_of_corrected() counts. Two answers that are
/// rounded to r differ by up to r more or less than they should, so r times
/// AddedRate::of_rounding is taken off every departure.
class GainJudge {
 public:
  /// `resolution` r [deg/s] of the answers.
  GainJudge(const ScaleFactorCurve& curve, double resolution)
      : curve_(&curve), resolution_(resolution) {}

  void add(const AddedRate& found);
  /// The same where the scale factor of the recorded rate is known, within
  /// `uncertainty` [-].
  void add(const AddedRate& found, double scale_factor, double uncertainty);
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
  /// Returns what gains are held against: "1, or 1 / s of a scale factor s of
  /// 1.0005 to 1.0255 at ...".
  std::string expected() const;

 private:
  struct Worst {
    double departure = 0.0;
    std::optional<AddedRate> where = {};
  };
  static void keep(Worst& worst, double departure, const AddedRate& where);
  const Worst& judged() const { return corrects() ? corrected_ : kept_; }

  double counted(const AddedRate& found, double departure) const;

  const ScaleFactorCurve* curve_;
  double resolution_;  // [deg/s]
  Worst kept_, corrected_;
  std::size_t count_ = 0;
};

}  // namespace beamgyro::internal
