// SPDX-License-Identifier: MIT
#include "compensation/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace beamgyro {
namespace {

// A candidate with its columns of the rows, and its residuals.
struct Judged {
  Candidate candidate;
  Unseen unseen;
};

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
    int epochs = 0;
    if (data_.groups) {
      const Unseen unseen = judge(candidate);
      result.errors = unseen.errors;
      epochs = unseen.epochs;
    }
    result.fit = final_fit(candidate, epochs);
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
        scores.push_back({candidate.name, judged.back().unseen.errors});
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
    const std::size_t chosen = choose(scores);
    Selected result;
    result.candidate = judged[chosen].candidate;
    result.errors = scores[chosen].errors;
    result.fit = final_fit(result.candidate, judged[chosen].unseen.epochs);
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

  Unseen judge(const Candidate& candidate) const {
    if (data_.groups)
      return cross_validate(candidate.kind, candidate.inputs, rows(candidate),
                            groups_, data_.seed);
    const Fit fit = final_fit(candidate, 0);
    return {held_out_errors(candidate, fit.model), fit.summary().best_epoch};
  }

  // Without held-out rows a network stops after the epochs that
  // cross-validation found.
  Fit final_fit(const Candidate& candidate, int epochs) const {
    FitSpec kind = candidate.kind;
    if (auto* bp = std::get_if<BpSpec>(&kind);
        bp != nullptr && data_.held_out.size() == 0 && epochs > 0)
      bp->training.max_epochs = epochs;
    return fit_model(kind, candidate.inputs, rows(candidate),
                     held_out(candidate), data_.seed);
  }

  std::optional<GroupErrors> constant_errors() const {
    if (groups_.count == 0) return std::nullopt;
    return judge({"constant", data_.inputs, ConstantSpec{}}).errors;
  }

  std::string reason(const std::vector<Scored>& scores,
                     std::size_t chosen) const {
    const auto best = std::min_element(
        scores.begin(), scores.end(), [](const Scored& a, const Scored& b) {
          return a.errors.mean() < b.errors.mean();
        });
    if (best->name == scores[chosen].name)
      return fmt::format("kept {}: the lowest residual", best->name);
    return fmt::format(
        "kept {}: the simplest within one standard error and {:g} % of {}",
        scores[chosen].name, 100.0 * kAllowedExcess, best->name);
  }

  const SelectionData& data_;
  RowGroups groups_;
};

bool is_curve(const Candidate& candidate) {
  const auto* polynomial = std::get_if<PolynomialSpec>(&candidate.kind);
  return std::holds_alternative<NoneSpec>(candidate.kind) ||
         std::holds_alternative<ConstantSpec>(candidate.kind) ||
         (polynomial != nullptr && polynomial->degree <= 3 &&
          candidate.inputs.size() == 1);
}

}  // namespace

Selected select_model(std::vector<Candidate> candidates,
                      const SelectionData& data) {
  if (candidates.size() > 1 && data.groups &&
      data.groups->by == Grouping::kSegment) {
    std::erase_if(candidates, [](const Candidate& candidate) {
      return !is_curve(candidate);
    });
    if (candidates.empty())
      throw std::invalid_argument(
          "the recordings are one leg of temperature: nothing independent can "
          "be held out, and no candidate is as simple as a cubic");
  }
  // With held-out rows fit_model() chooses the decay itself.
  if (data.groups && data.held_out.size() == 0)
    candidates = one_decay_each(candidates);
  const Selector selector(data);
  return candidates.size() == 1 ? selector.only(candidates[0])
                                : selector.best_of(candidates);
}

}  // namespace beamgyro
