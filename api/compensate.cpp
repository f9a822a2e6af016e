// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "api/compensators.h"
#include "api/program_version.h"
#include "dataset/files/sha256.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/signals.h"

namespace beamgyro {
namespace internal {
namespace {

constexpr const char* kCompensated = "compensated_rate";
constexpr const char* kCompensatedSigma = "compensated_rate_sigma";

void require_uncompensated(const Recording& recording,
                           const std::string& name) {
  if (find_column(recording, kCompensated) == nullptr) return;
  throw std::invalid_argument(fmt::format(
      "{}: holds a {} already; expected a recording that was not compensated",
      name, kCompensated));
}

CompensatedRate checked_answer(const CompensatorSource& source,
                               const Recording& recording,
                               const std::string& name) try {
  return public_answer(source.tested->answer(recording));
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("{}: {}", name, error.what()));
}

std::vector<std::string> range_warnings(const RateCompensator& compensator,
                                        const CompensatorSource& source,
                                        const CompensatedRate& answer,
                                        const std::string& name) {
  if (answer.clamped == 0) return {};
  if (!source.trained)
    return {fmt::format("{}: {} of {} samples were clamped, as {} says", name,
                        answer.clamped, answer.rate.size(),
                        compensator.name())};
  return {fmt::format(
      "{}: {} of {} samples lie outside {:g} to {:g} degC, the temperatures "
      "seen in training; clamped{}",
      name, answer.clamped, answer.rate.size(),
      source.trained->temperature_range.lowest,
      source.trained->temperature_range.highest,
      answer.sigma.empty() ? ""
                           : ", and sigma there is a guess that grows with the "
                             "distance")};
}

std::vector<std::string> sigma_warnings(const CompensatorSource& source,
                                        const Recording& recording,
                                        const std::string& name) {
  if (!source.trained || !source.trained->sigma) return {};
  std::vector<std::string> warnings =
      reasons_against_sigma(source.trained->sigma->validity, recording);
  for (std::string& warning : warnings) warning.insert(0, name + ": ");
  return warnings;
}

void add_answer(const RateCompensator& compensator,
                const CompensatorSource& source, CompensatedRate answer,
                Recording& recording) {
  recording.columns.push_back(column_of(kCompensated, std::move(answer.rate)));
  if (!answer.sigma.empty())
    recording.columns.push_back(
        column_of(kCompensatedSigma, std::move(answer.sigma)));
  recording.compensator = compensator.name();
  recording.compensator_sha256 =
      source.files.empty() ? "" : sha256(source.files.front().text);
  if (!recording.history.empty()) recording.history += '\n';
  recording.history += history_line("compensate with " + recording.compensator);
}

}  // namespace

void require_sound(const Recording& recording, const std::string& name) {
  const std::string defect = recording_defect(recording);
  if (!defect.empty())
    throw std::invalid_argument(fmt::format("{}: {}", name, defect));
}

CompensatedRun compensated(const RateCompensator& compensator,
                           Recording recording, const std::string& name,
                           std::vector<std::string>& faults) {
  require_uncompensated(recording, name);
  const CompensatorSource source = source_of(compensator);
  CompensatedRate answer = checked_answer(source, recording, name);
  faults = std::move(answer.faults);
  if (!faults.empty()) return {};
  std::vector<std::string> warnings =
      range_warnings(compensator, source, answer, name);
  for (std::string& warning : sigma_warnings(source, recording, name))
    warnings.push_back(std::move(warning));
  add_answer(compensator, source, std::move(answer), recording);
  return {std::move(recording), std::move(warnings)};
}

}  // namespace internal

CompensatedRun compensate(const RateCompensator& compensator,
                          Recording recording) {
  const std::string name = "the recording";
  internal::require_sound(recording, name);
  std::vector<std::string> faults;
  CompensatedRun run =
      internal::compensated(compensator, std::move(recording), name, faults);
  if (faults.empty()) faults = {internal::recording_defect(run.recording)};
  if (!faults.front().empty())
    throw std::runtime_error(
        fmt::format("{}: {}", compensator.name(), faults.front()));
  return run;
}

}  // namespace beamgyro
