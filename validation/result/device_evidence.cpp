// SPDX-License-Identifier: MIT
#include "validation/result/device_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "compensation/compensator/run_comparison.h"
#include "compensation/training/train.h"
#include "config/document.h"
#include "config/units.h"
#include "parallel/work_queue.h"

namespace beamgyro::internal {
namespace {

struct BaselineModel {
  std::string_view name, model;
  bool has_metrics = true;
};
constexpr BaselineModel kBaselineModels[] = {
    {"constant", "kind = \"constant\""},
    {"cubic",
     "kind = \"polynomial\"\ninputs = [\"temperature\"]\n"
     "[polynomial]\ndegree = 3"},
    {"spline",
     "kind = \"spline\"\ninputs = [\"temperature\"]\n"
     "[spline]\nknot_spacing_K = 5\nends = \"not_a_knot\""},
    {"table",
     "kind = \"table\"\ninputs = [\"temperature\"]\n"
     "[table]\nbin_width_K = 5",
     false},
};

std::vector<TrainingRun> training_runs(
    const std::vector<QualificationRun>& planned, const QualifiedDevice& device,
    std::size_t threads) {
  std::vector<Recording> recordings = qualified_runs(planned, device, threads);
  std::vector<TrainingRun> runs(planned.size());
  for_each_task(runs.size(), threads, [&](std::size_t k, std::size_t) {
    runs[k].name = planned[k].name;
    runs[k].sha256 = measured_sha256(recordings[k]);
    runs[k].recording = std::move(recordings[k]);
  });
  return runs;
}

// Returns the samples of a recording from a time on.
Recording later_part(const Recording& whole, double from) {
  Recording part = whole;
  const auto first = std::ranges::lower_bound(whole.time, from);
  const auto count = first - whole.time.begin();
  const auto cut = [&](auto& values) {
    values.erase(values.begin(), values.begin() + count);
  };
  cut(part.time);
  cut(part.status);
  for (Column& column : part.columns) cut(column.values);
  return part;
}

std::vector<double> last_of(std::vector<double> values, std::size_t count) {
  values.erase(values.begin(),
               values.end() - static_cast<std::ptrdiff_t>(count));
  return values;
}

// The rate of a run, which was answered as a whole, as evidence of the part
// `read` of it. How many samples were clamped is known of a whole run only.
EvidenceRun evidence_run(const ReadRun& named, const Recording& read,
                         std::vector<double> rate,
                         std::optional<std::size_t> clamped) {
  const bool is_part = rate.size() > read.time.size();
  if (is_part && clamped != std::size_t{0}) clamped.reset();
  return {named.name, named.purpose, &read,
          last_of(std::move(rate), read.time.size()), clamped};
}

// Counts tasks that are done.
class SharedProgress {
 public:
  SharedProgress(const ProgressOfWork& on_progress, std::size_t tasks)
      : on_progress_(on_progress), tasks_(tasks) {}
  void add_one() {
    const std::size_t done = ++done_;
    if (on_progress_)
      on_progress_(static_cast<double>(done) / static_cast<double>(tasks_));
  }

 private:
  const ProgressOfWork& on_progress_;
  std::size_t tasks_;
  std::atomic<std::size_t> done_ = 0;
};

std::vector<BaselineMethod> trained_baselines(const TrainingData& data,
                                              std::size_t threads) {
  if (data.training.empty()) return {};
  std::vector<BaselineMethod> trained(std::size(kBaselineModels));
  std::optional<FittedCompensator> cubic;
  for_each_task(trained.size(), threads, [&](std::size_t k, std::size_t) {
    const std::string name(kBaselineModels[k].name);
    const ConfigDocument document =
        ConfigDocument::parse(kBaselineModels[k].model, name);
    try {
      FittedCompensator fitted = trained_on(data, read_model(document));
      if (name == "cubic") cubic = fitted;
      trained[k] = {name,
                    [one = std::move(fitted)](const Recording& run) {
                      return compensated_rate(one, run);
                    },
                    kBaselineModels[k].has_metrics};
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format(
          "the baseline {} cannot be trained on the [[training]] runs of the "
          "qualification: {}",
          name, error.what()));
    }
  });
  if (cubic && cubic->straight_lines)
    trained.push_back(
        {"straight_lines", [lines = std::move(*cubic)](const Recording& run) {
           return straight_lines_rate(lines, run);
         }});
  return trained;
}

bool is_network(const ModelSpec& model) {
  return !model.candidates.empty() ||
         std::holds_alternative<BpSpec>(model.kind);
}

}  // namespace

TrainingData training_data(const Qualification& qualification,
                           const QualifiedDevice& device,
                           const ModelSpec* model, std::size_t threads) {
  TrainingData data{
      training_runs(qualification.training, device, threads), {}, {}};
  if (model == nullptr) return data;
  if (is_network(*model))
    data.held_out = training_runs(qualification.held_out, device, threads);
  if (model->scale_factor_bin_K)
    data.turning = training_runs(qualification.turning, device, threads);
  return data;
}

FittedCompensator trained_on(const TrainingData& data, const ModelSpec& model) {
  const std::vector<TrainingRun> none;
  std::vector<TrainingRun> fitted = data.training;
  if (model.scale_factor_bin_K)
    fitted.insert(fitted.end(), data.turning.begin(), data.turning.end());
  return train(model, fitted, is_network(model) ? data.held_out : none, 0)
      .compensator;
}

std::string words_of(const ReadRun& run) {
  return run.device.empty() ? run.name : run.name + " of device " + run.device;
}

namespace {

// Throws the same error with the run named.
[[noreturn]] void throw_named(const ReadRun& run,
                              const std::invalid_argument& error) {
  const std::string words = error.what();
  if (words.find(run.name) != std::string::npos) throw error;
  throw std::invalid_argument(fmt::format("{}: {}", words_of(run), words));
}

// Makes the answer to a run the evidence of the compensated rate.
void take_answer(DeviceEvidence& found, std::size_t k, bool reports_clamped) {
  const Answer& answer = found.answers[k];
  const Recording& part =
      found.read[k].from > 0 ? found.late[k] : found.runs[k];
  found.after.runs[k] = evidence_run(
      found.read[k], part, answer.rate,
      reports_clamped ? std::optional(answer.clamped) : std::nullopt);
  if (!answer.sigma.empty())
    found.after.runs[k].sigma = last_of(answer.sigma, part.time.size());
}

}  // namespace

DeviceEvidence answered_evidence(std::vector<ReadRun> read,
                                 std::vector<Recording> runs,
                                 const Answering& answering,
                                 std::size_t threads,
                                 const std::function<void()>& on_done) {
  const std::size_t count = read.size();
  DeviceEvidence found;
  found.read = std::move(read);
  found.runs = std::move(runs);
  found.late.resize(count);
  found.answers.resize(count);
  const Evidence blank{std::vector<EvidenceRun>(count), answering.full_scale};
  found.before = found.after = blank;
  found.baselines.push_back({"none", blank});
  for (const BaselineMethod& baseline : answering.baselines)
    found.baselines.push_back({baseline.name, blank, baseline.has_metrics});
  for_each_task(count, threads, [&](std::size_t k, std::size_t) {
    const ReadRun& named = found.read[k];
    found.runs[k].run = words_of(named);
    const Recording& run = found.runs[k];
    if (named.from > 0) found.late[k] = later_part(run, named.from);
    const Recording& part = named.from > 0 ? found.late[k] : run;
    const auto evidence = [&](std::vector<double> rate) {
      return evidence_run(named, part, std::move(rate), {});
    };
    found.before.runs[k] = evidence(column_values(run, "rate"));
    found.baselines[0].evidence.runs[k] = found.before.runs[k];
    try {
      found.answers[k] = answering.compensator.answer(run);
      for (std::size_t b = 0; b < answering.baselines.size(); ++b)
        found.baselines[b + 1].evidence.runs[k] =
            evidence(answering.baselines[b].rate(run));
    } catch (const std::invalid_argument& error) {
      if (!answering.reports_clamped) throw;  // what is asked names its run
      throw_named(named, error);
    }
    take_answer(found, k, answering.reports_clamped);
    if (on_done) on_done();
  });
  return found;
}

void answer_again(DeviceEvidence& found, const TestedCompensator& compensator,
                  bool reports_clamped, std::size_t threads) {
  for_each_task(found.read.size(), threads, [&](std::size_t k, std::size_t) {
    try {
      found.answers[k] = compensator.answer(found.runs[k]);
    } catch (const std::invalid_argument& error) {
      throw_named(found.read[k], error);
    }
    take_answer(found, k, reports_clamped);
  });
}

DeviceEvidence device_evidence(const Qualification& qualification,
                               const QualifiedDevice& device,
                               const TestedCompensator& compensator,
                               const TrainingData& data, bool reports_clamped,
                               std::size_t threads,
                               const ProgressOfWork& progress) {
  const std::vector<QualificationRun>& planned = qualification.runs;
  SharedProgress done(progress, 2 * planned.size());
  const auto on_done = [&] { done.add_one(); };
  std::vector<Recording> runs =
      qualified_runs(planned, device, threads, on_done);
  std::vector<ReadRun> read;
  for (const QualificationRun& run : planned)
    read.push_back({run.name, run.purpose, run.from});
  return answered_evidence(
      std::move(read), std::move(runs),
      {compensator, trained_baselines(data, threads),
       device.device.readout.full_scale / kDegree, reports_clamped},
      threads, on_done);
}

}  // namespace beamgyro::internal
