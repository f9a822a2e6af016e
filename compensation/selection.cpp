// SPDX-License-Identifier: MIT
#include "compensation/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "compensation/temperature_effect.h"

namespace beamgyro {
namespace {

// A candidate with its columns of the rows, and its residuals.
struct Judged {
  Candidate candidate;
  GroupErrors errors;
};

constexpr int kLeastGroupsOfNetwork = 3;
constexpr int kLeastPowerOns = 3;
constexpr double kPowerOnsApart = 10.0;  // [K]

// Temperatures kPowerOnsApart or more apart at which power came on.
int power_on_temperatures(const TrainingRows& rows) {
  std::vector<double> temperatures;
  for (Eigen::Index k = 0; k < rows.size(); ++k)
    if (k == 0 || rows.cycle(k) != rows.cycle(k - 1))
      temperatures.push_back(rows.temperature(k));
  std::sort(temperatures.begin(), temperatures.end());
  int count = 0;
  double last = -std::numeric_limits<double>::infinity();
  for (const double T : temperatures)
    if (T - last >= kPowerOnsApart) {
      ++count;
      last = T;
    }
  return count;
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

bool is_constant(const Candidate& candidate) {
  return std::holds_alternative<NoneSpec>(candidate.kind) ||
         std::holds_alternative<ConstantSpec>(candidate.kind);
}

bool is_curve(const Candidate& candidate) {
  const auto* polynomial = std::get_if<PolynomialSpec>(&candidate.kind);
  return is_constant(candidate) ||
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
    if (is_constant(judged[k].candidate)) least = std::min(least, error(k));
    if (error(k) < error(best)) best = k;
  }
  for (std::size_t k = judged.size(); k-- > 0;)
    if (!is_constant(judged[k].candidate) && error(k) < least) return k;
  return best;
}

class Selector {
 public:
  explicit Selector(const SelectionData& data) : data_(data) {
    if (data.groups)
      groups_ = *data.groups;
    else if (data.held_out.size() > 0)
      groups_ = coarsest_groups(data.held_out, 3);
  }

  Selected only(const Candidate& candidate) const {
    Selected result;
    result.candidate = candidate;
    if (data_.groups) result.errors = judge(candidate);
    result.fit = final_fit(candidate);
    if (!data_.groups && data_.held_out.size() > 0)
      result.errors = held_out_errors(candidate, result.fit.model);
    result.constant_errors = constant_errors();
    return result;
  }

  Selected best_of(const std::vector<Candidate>& candidates) const {
    std::vector<Judged> judged;
    std::vector<Scored> scores;
    std::vector<std::string> told;
    for (const Candidate& candidate : candidates) {
      try {
        judged.push_back({candidate, judge(candidate)});
        scores.push_back({candidate.name, judged.back().errors});
        told.push_back(fmt::format("{}: {:.6f} deg/s rms over {} unseen {}s",
                                   candidate.name, rms_of(scores.back().errors),
                                   groups_.count, grouping_name(groups_.by)));
      } catch (const std::invalid_argument& error) {
        told.push_back(
            fmt::format("{}: passed over, {}", candidate.name, error.what()));
      }
    }
    if (judged.empty())
      throw std::invalid_argument("no candidate can be fitted: " +
                                  told.front());
    const bool one_leg = data_.groups && groups_.by == Grouping::kSegment;
    const std::size_t chosen = one_leg ? richest_curve(judged) : choose(scores);
    Selected result;
    result.candidate = judged[chosen].candidate;
    result.errors = scores[chosen].errors;
    result.fit = final_fit(result.candidate);
    told.push_back(reason(scores, chosen));
    result.fit.choices.insert(result.fit.choices.begin(), told.begin(),
                              told.end());
    result.constant_errors = constant_errors();
    return result;
  }

 private:
  TrainingRows rows(const Candidate& candidate) const {
    return with_columns(data_.rows, data_.inputs, candidate.inputs);
  }
  TrainingRows held_out(const Candidate& candidate) const {
    return with_columns(data_.held_out, data_.inputs, candidate.inputs);
  }

  GroupErrors held_out_errors(const Candidate& candidate,
                              const BiasModel& model) const {
    return group_errors(model, held_out(candidate), groups_);
  }

  GroupErrors judge(const Candidate& candidate) const {
    if (data_.groups)
      return cross_validate(candidate.kind, candidate.inputs, rows(candidate),
                            groups_, data_.seed);
    return held_out_errors(candidate, final_fit(candidate).model);
  }

  Fit final_fit(const Candidate& candidate) const {
    return fit_model(candidate.kind, candidate.inputs, rows(candidate),
                     held_out(candidate), data_.seed);
  }

  std::optional<GroupErrors> constant_errors() const {
    if (groups_.count == 0) return std::nullopt;
    return judge({"constant", data_.inputs, ConstantSpec{}});
  }

  std::string reason(const std::vector<Scored>& scores,
                     std::size_t chosen) const {
    const auto best = std::min_element(
        scores.begin(), scores.end(), [](const Scored& a, const Scored& b) {
          return a.errors.mean() < b.errors.mean();
        });
    if (best->name == scores[chosen].name)
      return fmt::format("kept {}: the lowest residual", best->name);
    if (data_.groups && groups_.by == Grouping::kSegment)
      return fmt::format(
          "kept {}: the richest curve that leaves less than a constant; one "
          "leg tells no more",
          scores[chosen].name);
    return fmt::format(
        "kept {}: the simplest within one standard error and {:g} % of {}",
        scores[chosen].name, 100.0 * kAllowedExcess, best->name);
  }

  const SelectionData& data_;
  RowGroups groups_;
};

bool sees_power_on(const Candidate& candidate) {
  return std::any_of(candidate.inputs.begin(), candidate.inputs.end(),
                     [](const Input& input) {
                       return input.kind == InputKind::kSincePowerOn;
                     });
}

// Why unseen groups cannot judge a candidate; empty when they can.
std::string objection(const Candidate& candidate, const TrainingRows& rows,
                      const RowGroups& groups) {
  if (is_constant(candidate)) return "";
  if (groups.by == Grouping::kSegment && !is_curve(candidate))
    return "the recordings are one leg of temperature, or legs that share too "
           "little of it, and nothing independent can be held out: curves up "
           "to "
           "the cubic only";
  if (groups.count < kLeastGroupsOfNetwork &&
      std::holds_alternative<BpSpec>(candidate.kind))
    return fmt::format("{} {}s or more judge a network; the recordings have {}",
                       kLeastGroupsOfNetwork, grouping_name(groups.by),
                       groups.count);
  const bool few =
      groups.by == Grouping::kSegment || groups.count < kLeastGroupsOfNetwork;
  if (few && !temperature_shows(rows))
    return temperature_comes_back(rows)
               ? "the bias does not come back with the temperature: a cubic "
                 "leaves half its variance or more"
               : "the bias moves no more than slow noise does while the "
                 "temperature goes one way";
  if (const int ambients = power_on_temperatures(rows);
      sees_power_on(candidate) && ambients < kLeastPowerOns)
    return fmt::format(
        "time since power-on is told from temperature by power-ons at {} "
        "temperatures {:g} K apart; the recordings have {}",
        kLeastPowerOns, kPowerOnsApart, ambients);
  return "";
}

}  // namespace

Selected select_model(std::vector<Candidate> candidates,
                      const SelectionData& data) {
  std::vector<std::string> told;
  if (candidates.size() > 1 && data.groups)
    std::erase_if(candidates, [&](const Candidate& candidate) {
      const std::string why = objection(candidate, data.rows, *data.groups);
      if (!why.empty())
        told.push_back(fmt::format("{}: passed over, {}", candidate.name, why));
      return !why.empty();
    });
  if (candidates.empty())
    throw std::invalid_argument("no candidate can be judged: " + told.front());
  // With held-out rows fit_model() chooses the decay itself.
  if (data.groups && data.held_out.size() == 0)
    candidates = one_decay_each(candidates);
  const Selector selector(data);
  Selected result = candidates.size() == 1 ? selector.only(candidates[0])
                                           : selector.best_of(candidates);
  result.fit.choices.insert(result.fit.choices.begin(), told.begin(),
                            told.end());
  return result;
}

}  // namespace beamgyro
