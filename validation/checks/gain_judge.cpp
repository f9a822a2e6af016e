// SPDX-License-Identifier: MIT
#include "validation/checks/gain_judge.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamgyro::internal {
std::string place_words(const AddedRate& found) {
  if (std::isnan(found.time))
    return fmt::format("replayed at {:.1f} degC", found.temperature);
  std::string words;
  if (!std::isnan(found.temperature))
    words = fmt::format("at {:.1f} degC, ", found.temperature);
  return words + fmt::format("{:g} s into its run", found.time);
}

double GainJudge::counted(const AddedRate& found, double departure) const {
  const double change = std::abs(found.change);
  const double left =
      departure - resolution_ * (found.of_rounding > 0.0 ? found.of_rounding
                                                         : 1.0 / change);
  return left * change < kRateResolution ? 0.0 : left;
}

void GainJudge::keep(Worst& worst, double departure, const AddedRate& where) {
  if (std::isnan(departure))
    departure = std::numeric_limits<double>::infinity();
  if (worst.where) {
    const double here = std::min(departure, 1.0);
    const double there = std::min(worst.departure, 1.0);
    if (here < there ||
        (here == there && std::abs(where.rate) <= std::abs(worst.where->rate)))
      return;
  }
  worst = {departure, where};
}

void GainJudge::add(const AddedRate& found) {
  if (!curve_->empty() && !std::isnan(found.temperature))
    keep(corrected_,
         counted(found,
                 curve_->departure_of_corrected(found.gain, found.temperature)),
         found);
  keep(kept_, counted(found, std::abs(found.gain - 1.0)), found);
  ++count_;
}

void GainJudge::add(const AddedRate& found, double scale_factor,
                    double uncertainty) {
  const double departure = std::abs(found.gain * scale_factor - 1.0);
  keep(corrected_, counted(found, std::max(departure - uncertainty, 0.0)),
       found);
  keep(kept_, counted(found, std::abs(found.gain - 1.0)), found);
  ++count_;
}

void GainJudge::add(const GainJudge& other) {
  count_ += other.count_;
  if (other.kept_.where) keep(kept_, other.kept_.departure, *other.kept_.where);
  if (other.corrected_.where)
    keep(corrected_, other.corrected_.departure, *other.corrected_.where);
}

bool GainJudge::corrects() const {
  return kept_.departure > kGainTolerance && corrected_.where &&
         corrected_.departure <= kCorrectedTolerance &&
         corrected_.departure < 0.5 * curve_->largest_departure();
}

bool GainJudge::passed() const {
  return corrects() || kept_.departure <= kGainTolerance;
}

double GainJudge::limit() const {
  return corrects() ? kCorrectedTolerance : kGainTolerance;
}

std::string GainJudge::expected() const {
  if (curve_->empty())
    return "1, for no run of held rates shows the scale factor";
  return fmt::format("1, or 1 / s of a scale factor s of {}", curve_->words());
}

const AddedRate& GainJudge::worst() const { return *judged().where; }

}  // namespace beamgyro::internal
