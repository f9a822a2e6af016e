// SPDX-License-Identifier: MIT
#include "validation/result/set_verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "validation/metrics/sigma_evidence.h"
#include "validation/metrics/sigma_report.h"
#include "validation/result/judgement.h"
#include "validation/result/population_yield.h"

namespace beamgyro::internal {
namespace {

class SetJudge {
 public:
  SetJudge(const RunSource& set, const RecordedAnswering& answering,
           const SpecificationFile& specification, std::size_t threads,
           const EvidenceVisitor& on_device)
      : set_(*set.set),
        answering_(answering),
        specification_(specification),
        threads_(threads),
        on_device_(on_device) {
    found_.devices.campaign = set_.name;
    found_.devices.metrics = followed_metrics(specification);
  }

  // Judges the device whose runs these are.
  void add(std::vector<TrainingRun> runs) {
    const std::string device = runs.front().device;
    DeviceEvidence evidence =
        recorded_evidence(std::move(runs), answering_, threads_);
    if (on_device_) on_device_(evidence);
    ValidationResult result;
    judge({specification_,
           {},
           answering_.compensator,
           answering_.known,
           &set_,
           answering_.requires_provenance},
          evidence, threads_, result);
    if (result.sigma)
      sigma_.add_device(sigma_evidence(evidence.after),
                        found_.devices.devices.size());
    found_.devices.devices.push_back({result.verdict, result.words, device});
    verdicts_.push_back(result.verdict);
    add_figures(result, found_.devices.metrics);
    if (found_.devices.devices.size() > 1 &&
        !is_more_severe(result.verdict, found_.shown.verdict))
      return;
    found_.devices.shown = device;
    found_.shown = std::move(result);
    found_.evidence = std::move(evidence);
  }

  SetVerdicts finish() {
    PopulationYield& all = found_.devices;
    static_cast<VerdictCount&>(all) = count_of(verdicts_);
    if (found_.shown.sigma) found_.shown.sigma = sigma_report(sigma_);
    found_.shown.words =
        fmt::format("{} of {} devices pass. Device {}: {}", all.passed,
                    all.devices.size(), all.shown, found_.shown.words);
    return std::move(found_);
  }

 private:
  const TrainingSet& set_;
  const RecordedAnswering& answering_;
  const SpecificationFile& specification_;
  std::size_t threads_;
  const EvidenceVisitor& on_device_;
  SetVerdicts found_;
  std::vector<Verdict> verdicts_;
  SigmaEvidence sigma_;
};

}  // namespace

SetVerdicts set_verdicts(const RunSource& set,
                         const RecordedAnswering& answering,
                         const SpecificationFile& specification,
                         std::size_t threads, const ProgressOfWork& progress,
                         const EvidenceVisitor& on_device) {
  if (set.count == 0) throw std::invalid_argument("no run of the set to judge");
  SetJudge judge(set, answering, specification, threads, on_device);
  std::vector<TrainingRun> runs;
  std::size_t seen = 0;
  set.for_each_by_device([&](const TrainingRun& run) {
    if (!runs.empty() && runs.front().device != run.device) {
      judge.add(std::exchange(runs, {}));
      if (progress)
        progress(static_cast<double>(seen) / static_cast<double>(set.count));
    }
    runs.push_back(run);
    ++seen;
  });
  judge.add(std::move(runs));
  return judge.finish();
}

}  // namespace beamgyro::internal
