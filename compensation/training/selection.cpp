// SPDX-License-Identifier: MIT
#include "compensation/training/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace beamgyro::internal {
namespace {

using Eigen::Index;

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

const Judged* cubic_of(const std::vector<Judged>& judged) {
  const auto found = std::ranges::find_if(
      judged, [](const Judged& each) { return is_cubic(each.candidate); });
  return found == judged.end() ? nullptr : &*found;
}

// Share of the rms of the cubic, which is one of `judged`, that another must
// take away. Those after the cubic are richer.
double needed_gain(const Judged& other, const Judged& cubic) {
  if (is_constant(other.candidate.kind))
    return other.errors.size() < kLeastGroups ? kConstantGain : kUsefulGain;
  return &other > &cubic ? kRicherGain : kUsefulGain;
}

// A table has corners at the knots of a spline, which drift has not: it gives
// way to a spline unless it leaves kUsefulGain less.
bool gives_way_to_spline(const Judged& one, const std::vector<Judged>& judged) {
  return std::holds_alternative<TableSpec>(one.candidate.kind) &&
         std::ranges::any_of(judged, [&](const Judged& other) {
           return std::holds_alternative<SplineSpec>(other.candidate.kind) &&
                  one.rms() > (1.0 - kUsefulGain) * other.rms();
         });
}

// Returns the cubic, or the simplest of those that are clearly better.
const Judged& better_than(const Judged& cubic,
                          const std::vector<Judged>& judged) {
  std::vector<const Judged*> better;
  std::vector<GroupErrors> errors;
  for (const Judged& each : judged) {
    if (gives_way_to_spline(each, judged) ||
        !is_clearly_less(each.errors, cubic.errors, needed_gain(each, cubic)))
      continue;
    better.push_back(&each);
    errors.push_back(each.errors);
  }
  return better.empty() ? cubic : *better[choose(errors)];
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
    const Judged& kept = kept_of(judged, remarks);
    if (kept.weight == 0.0)
      remarks.push_back("kept constant: of weight 0 nothing else is left");
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

  // Returns the cubic, where nothing speaks for less than a curve.
  const Judged* default_of(const std::vector<Judged>& judged) const {
    return averages() && moves_more_than_noise(data_.rows) ? cubic_of(judged)
                                                           : nullptr;
  }

  // Returns the one to keep, and adds why.
  const Judged& kept_of(const std::vector<Judged>& judged,
                        std::vector<std::string>& remarks) const {
    if (const Judged* cubic = default_of(judged)) {
      const Judged& kept = better_than(*cubic, judged);
      remarks.push_back(why_beside_the_cubic(judged, *cubic, kept));
      return kept;
    }
    const Judged& chosen =
        judged[one_leg() ? richest_curve(judged) : simplest(judged)];
    const Judged& kept = one_leg() ? chosen : useful(chosen, judged);
    remarks.push_back(reason(judged, chosen, kept));
    return kept;
  }

  std::string why_beside_the_cubic(const std::vector<Judged>& judged,
                                   const Judged& cubic,
                                   const Judged& kept) const {
    const auto& best = *std::ranges::min_element(judged, {}, &Judged::rms);
    if (&kept == &best)
      return fmt::format("kept {}: the lowest residual", kept.candidate.name);
    const auto share = [&](const Judged& other) {  // of the cubic, [%]
      return 100.0 * (1.0 - other.rms() / cubic.rms());
    };
    if (&kept != &cubic)
      return fmt::format(
          "kept {}: it takes {:.2g} % of the rms of {} away, in the groups "
          "alike",
          kept.candidate.name, share(kept), cubic.candidate.name);
    return fmt::format(
        "kept {}: of its rms {} takes {:.2g} % away; evidence is {:g} % and "
        "more than the standard error over {} {}s",
        kept.candidate.name, best.candidate.name, share(best),
        100.0 * needed_gain(best, cubic), groups_.count,
        grouping_name(groups_.by));
  }

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
    return {"constant", {data_.inputs.front()}, ConstantSpec{}};
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
    // Only groups of one shape and different sizes tell a common weight.
    if (weight.value >= kWholeWeight ||
        weight.share_of_scale < kLeastShareOfScale)
      return alone;
    if (groups_.count >= kLeastGroups) return average(weight.value);
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
                ? fmt::format("; the groups disagree, so {:.2f} of it and "
                              "{:.2f} of a constant are used",
                              found.weight, 1.0 - found.weight)
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

// Takes inputs of a candidate away that unseen groups cannot judge. Returns why
// the candidate is passed over, or an empty text, and says what else is
// missing.
std::string why_passed_over(Candidate& candidate, const SelectionData& data,
                            std::vector<std::string>& remarks) {
  const std::string objection =
      objection_to_candidate(candidate, data.rows, *data.groups);
  if (!objection.empty()) return objection;
  const RemovedInputs removed = remove_inputs_without_evidence(
      candidate, data.inputs, data.rows, *data.groups);
  if (removed.names.empty()) return "";
  // Without its further inputs it is a curve that other candidates are.
  if (candidate.inputs.size() == 1 &&
      !std::holds_alternative<BpSpec>(candidate.kind))
    return removed.reason;
  remarks.push_back(fmt::format("{}: without {}: {}", candidate.name,
                                fmt::join(removed.names, ", "),
                                removed.reason));
  return "";
}

std::vector<Candidate> that_can_be_judged(std::vector<Candidate> candidates,
                                          const SelectionData& data,
                                          std::vector<std::string>& remarks) {
  std::vector<Candidate> kept;
  for (Candidate& candidate : candidates) {
    const std::string why = why_passed_over(candidate, data, remarks);
    if (why.empty())
      kept.push_back(std::move(candidate));
    else
      remarks.push_back(
          fmt::format("{}: passed over, {}", candidate.name, why));
  }
  return kept;
}

}  // namespace

Selected select_model(std::vector<Candidate> candidates,
                      const SelectionData& data) {
  std::vector<std::string> remarks;
  const bool is_automatic = candidates.size() > 1;
  if (is_automatic && data.groups)
    candidates = that_can_be_judged(std::move(candidates), data, remarks);
  else if (data.groups)
    require_groups_for_inputs(candidates.front(), *data.groups);
  if (candidates.empty())
    throw std::invalid_argument("no candidate can be judged: " +
                                remarks.front());
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
