// SPDX-License-Identifier: MIT
#include "compensation/training/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "compensation/methods/method_inputs.h"
#include "compensation/models/array_view.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;

constexpr double kSlowNoise = 0.05;  // [-], of n s^2

// A candidate, its weight beside a constant, and the residuals of the two.
struct Judged {
  Candidate candidate;
  double weight = 1.0;
  GroupErrors errors;

  double rms() const { return rms_of(errors); }
};

// Standard errors that the weight of a curve is lowered by where fewer than
// kLeastGroups disagree [-].
constexpr double kCaution = 0.25;
constexpr int kLeastPowerOns = 3;
constexpr double kPowerOnsApart = 10.0;  // [K]

// Temperatures kPowerOnsApart or more apart at which power came on.
int power_on_temperatures(const TrainingRows& rows) {
  std::vector<double> temperatures;
  for (Eigen::Index k = 0; k < rows.size(); ++k)
    if (k == 0 || rows.cycle(k) != rows.cycle(k - 1))
      temperatures.push_back(rows.temperature(k));
  return distinct_temperatures(array_view(temperatures), kPowerOnsApart);
}

// A network of several weight decays is as many candidates, the strongest decay
// first: it is the simplest.
std::vector<Candidate> one_decay_each(
    const std::vector<Candidate>& candidates) {
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates) {
    const auto* bp = std::get_if<BpSpec>(&candidate.kind);
    if (bp == nullptr || bp->weight_decays.size() == 1) {
      result.push_back(candidate);
      continue;
    }
    std::vector<double> decays = bp->weight_decays;
    std::sort(decays.rbegin(), decays.rend());
    for (const double decay : decays) {
      BpSpec single = *bp;
      single.weight_decays = {decay};
      result.push_back(
          {fmt::format("{}, weight decay {:g}", candidate.name, decay),
           candidate.inputs, single});
    }
  }
  return result;
}

bool is_curve(const Candidate& candidate) {
  const auto* polynomial = std::get_if<PolynomialSpec>(&candidate.kind);
  return is_constant(candidate.kind) ||
         (polynomial != nullptr && polynomial->degree <= 3 &&
          candidate.inputs.size() == 1);
}

// Segments are not independent and excuse no simplicity: the last that leaves
// less than every constant does, or else the best.
std::size_t richest_curve(const std::vector<Judged>& judged) {
  const auto error = [&](std::size_t k) { return judged[k].errors.mean(); };
  double least = std::numeric_limits<double>::infinity();
  std::size_t best = 0;
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (is_constant(judged[k].candidate.kind))
      least = std::min(least, error(k));
    if (error(k) < error(best)) best = k;
  }
  for (std::size_t k = judged.size(); k-- > 0;)
    if (!is_constant(judged[k].candidate.kind) && error(k) < least) return k;
  return best;
}

std::size_t simplest(const std::vector<Judged>& judged) {
  std::vector<GroupErrors> errors;
  for (const Judged& each : judged) errors.push_back(each.errors);
  return choose(errors);
}

// Returns the curve or network, unless "none" or "constant" is about as good.
const Judged& useful(const Judged& chosen, const std::vector<Judged>& judged) {
  const Judged* flat = nullptr;
  for (const Judged& each : judged)
    if (is_constant(each.candidate.kind) &&
        (flat == nullptr || flat->rms() > (1.0 + kAllowedExcess) * each.rms()))
      flat = &each;
  const bool gains =
      flat == nullptr || chosen.rms() <= (1.0 - kUsefulGain) * flat->rms();
  return gains || is_constant(chosen.candidate.kind) ? chosen : *flat;
}

class Selector {
 public:
  Selector(const SelectionData& data, bool is_automatic)
      : data_(data), is_automatic_(is_automatic) {
    if (data.groups)
      groups_ = *data.groups;
    else if (data.held_out.size() > 0)
      groups_ = coarsest_groups(data.held_out, kLeastGroups);
  }

  Selected only(const Candidate& candidate) const {
    Selected result;
    result.candidate = candidate;
    if (data_.groups) result.errors = errors_of(predictions(candidate));
    result.fit = final_fit(candidate);
    if (!data_.groups && data_.held_out.size() > 0)
      result.errors =
          errors_of(predict_all(result.fit.model, held_out(candidate)));
    result.constant_errors = constant_errors();
    return result;
  }

  Selected best_of(const std::vector<Candidate>& candidates) const {
    std::vector<std::string> remarks;
    const std::vector<Judged> judged = judge_all(candidates, remarks);
    if (judged.empty())
      throw std::invalid_argument("no candidate can be fitted: " +
                                  remarks.front());
    const Judged& chosen =
        judged[one_leg() ? richest_curve(judged) : simplest(judged)];
    const Judged& kept = one_leg() ? chosen : useful(chosen, judged);
    remarks.push_back(reason(judged, chosen, kept));
    Selected result;
    result.candidate = kept.weight > 0.0 ? kept.candidate : constant();
    result.errors = kept.errors;
    result.fit = final_fit(result.candidate);
    if (kept.weight > 0.0 && kept.weight < 1.0) {
      result.weight = kept.weight;
      result.fit.model = averaged_with_constant(
          std::move(result.fit.model), data_.rows.bias.mean(), kept.weight);
    }
    result.fit.choices.insert(result.fit.choices.begin(), remarks.begin(),
                              remarks.end());
    result.constant_errors = constant_errors();
    return result;
  }

 private:
  bool one_leg() const {
    return data_.groups && groups_.by == Grouping::kSegment;
  }
  bool averages() const { return is_automatic_ && !one_leg(); }
  // Returns the rows on which candidates are judged.
  const TrainingRows& judging() const {
    return data_.groups ? data_.rows : data_.held_out;
  }
  TrainingRows rows(const Candidate& candidate) const {
    return with_columns(data_.rows, data_.inputs, candidate.inputs);
  }
  TrainingRows held_out(const Candidate& candidate) const {
    return with_columns(data_.held_out, data_.inputs, candidate.inputs);
  }
  Candidate constant() const {
    return {"constant", data_.inputs, ConstantSpec{}};
  }

  Predictions predictions(const Candidate& candidate) const {
    if (data_.groups)
      return predict_unseen(candidate.kind, candidate.inputs, rows(candidate),
                            groups_, data_.seed);
    return predict_all(final_fit(candidate).model, held_out(candidate));
  }

  GroupErrors errors_of(const Predictions& found) const {
    return group_errors(found, judging().bias, groups_);
  }

  std::optional<GroupErrors> constant_errors() const {
    if (groups_.count == 0) return std::nullopt;
    return errors_of(predictions(constant()));
  }

  Fit final_fit(const Candidate& candidate) const {
    return fit_model(candidate.kind, candidate.inputs, rows(candidate),
                     held_out(candidate), data_.seed);
  }

  Judged judge(const Candidate& candidate, const Predictions& flat) const {
    const Predictions found = predictions(candidate);
    Judged alone{candidate, 1.0, errors_of(found)};
    if (!averages() || is_constant(candidate.kind)) return alone;
    const StackingWeight weight =
        stacking_weight(flat, found, judging().bias, groups_);
    const auto average = [&](double share) {
      return Judged{candidate, share, errors_of(averaged(flat, found, share))};
    };
    const Judged best = average(weight.value);
    if (alone.rms() <= (1.0 + kAllowedExcess) * best.rms()) return alone;
    if (groups_.count >= kLeastGroups) return best;
    return average(
        std::max(weight.value - kCaution * weight.standard_error, 0.0));
  }

  std::vector<Judged> judge_all(const std::vector<Candidate>& candidates,
                                std::vector<std::string>& remarks) const {
    std::vector<Judged> judged;
    const Predictions flat = predictions(constant());
    for (const Candidate& candidate : candidates) {
      try {
        const Judged& found = judged.emplace_back(judge(candidate, flat));
        remarks.push_back(fmt::format(
            "{}: {:.6f} deg/s rms over {} unseen {}s{}", candidate.name,
            found.rms(), groups_.count, grouping_name(groups_.by),
            found.weight < 1.0
                ? fmt::format(", averaged with a constant, weight {:.2f}",
                              found.weight)
                : ""));
      } catch (const std::invalid_argument& error) {
        remarks.push_back(
            fmt::format("{}: passed over, {}", candidate.name, error.what()));
      }
    }
    return judged;
  }

  std::string reason(const std::vector<Judged>& judged, const Judged& chosen,
                     const Judged& kept) const {
    const auto& best = *std::ranges::min_element(judged, {}, &Judged::rms);
    if (&kept != &chosen)
      return fmt::format(
          "kept {}: {} takes {:.2g} % of its rms away, less than {:g} %",
          kept.candidate.name, chosen.candidate.name,
          100.0 * (1.0 - chosen.rms() / kept.rms()), 100.0 * kUsefulGain);
    if (&kept == &best)
      return fmt::format("kept {}: the lowest residual", kept.candidate.name);
    if (one_leg())
      return fmt::format(
          "kept {}: the richest curve that leaves less than a constant; one "
          "leg tells no more",
          kept.candidate.name);
    return fmt::format("kept {}: the simplest within {:g} % of {}",
                       kept.candidate.name, 100.0 * kAllowedExcess,
                       best.candidate.name);
  }

  const SelectionData& data_;
  bool is_automatic_;  // several candidates, not the decays of one network
  RowGroups groups_;
};

bool sees_power_on(const Candidate& candidate) {
  return std::any_of(candidate.inputs.begin(), candidate.inputs.end(),
                     [](const Input& input) {
                       return input.kind == InputKind::kSincePowerOn;
                     });
}

// Returns why unseen groups cannot judge a candidate, or an empty text when
// they can.
std::string objection(const Candidate& candidate, const TrainingRows& rows,
                      const RowGroups& groups) {
  if (is_constant(candidate.kind)) return "";
  if (groups.by == Grouping::kSegment && !is_curve(candidate))
    return "the recordings are one leg of temperature, or legs that share too "
           "little of it, and nothing independent can be held out: curves up "
           "to "
           "the cubic only";
  if (groups.count < kLeastGroups &&
      std::holds_alternative<BpSpec>(candidate.kind))
    return fmt::format("{} {}s or more judge a network; the recordings have {}",
                       kLeastGroups, grouping_name(groups.by), groups.count);
  if (groups.by == Grouping::kSegment && !moves_more_than_noise(rows))
    return "the bias moves no more than slow noise does while the temperature "
           "goes one way";
  if (const int ambients = power_on_temperatures(rows);
      sees_power_on(candidate) && ambients < kLeastPowerOns)
    return fmt::format(
        "time since power-on is told from temperature by power-ons at {} "
        "temperatures {:g} K apart; the recordings have {}",
        kLeastPowerOns, kPowerOnsApart, ambients);
  return "";
}

}  // namespace

bool is_constant(const FitSpec& kind) {
  return std::holds_alternative<NoneSpec>(kind) ||
         std::holds_alternative<ConstantSpec>(kind);
}

bool moves_more_than_noise(const TrainingRows& rows) {
  double squares = 0.0, count = 0.0;
  for (Index k = 2; k < rows.size(); ++k) {
    if (rows.cycle(k) != rows.cycle(k - 2)) continue;
    const double second =
        rows.bias(k) - 2.0 * rows.bias(k - 1) + rows.bias(k - 2);
    squares += second * second;
    count += 1.0;
  }
  const double variance = (rows.bias - rows.bias.mean()).square().mean();
  const auto size = static_cast<double>(rows.size());
  return count > 0.0 && variance > kSlowNoise * size * 0.5 * squares / count;
}

Selected select_model(std::vector<Candidate> candidates,
                      const SelectionData& data) {
  std::vector<std::string> remarks;
  if (candidates.size() > 1 && data.groups)
    std::erase_if(candidates, [&](const Candidate& candidate) {
      const std::string why = objection(candidate, data.rows, *data.groups);
      if (!why.empty())
        remarks.push_back(
            fmt::format("{}: passed over, {}", candidate.name, why));
      return !why.empty();
    });
  if (candidates.empty())
    throw std::invalid_argument("no candidate can be judged: " +
                                remarks.front());
  const bool is_automatic = candidates.size() > 1;
  // With held-out rows fit_model() chooses the decay itself.
  if (data.groups && data.held_out.size() == 0)
    candidates = one_decay_each(candidates);
  const Selector selector(data, is_automatic);
  Selected result = candidates.size() == 1 ? selector.only(candidates[0])
                                           : selector.best_of(candidates);
  result.fit.choices.insert(result.fit.choices.begin(), remarks.begin(),
                            remarks.end());
  return result;
}

}  // namespace beamgyro::internal
