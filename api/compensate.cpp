// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "api/compensation.h"
#include "api/compensator_state.h"
#include "api/program_version.h"
#include "api/user_compensator.h"
#include "dataset/files/sha256.h"
#include "dataset/recording/recording_defect.h"
#include "dataset/recording/signals.h"

namespace beamgyro {
namespace internal {
namespace {

constexpr const char* kCompensated = "compensated_rate";
constexpr const char* kCompensatedSigma = "compensated_rate_sigma";

// Of its file; empty where there is none.
std::string sha256_of(const RateCompensator& compensator) {
  if (const auto* file =
          dynamic_cast<const beamgyro::Compensator*>(&compensator))
    return sha256(file->text());
  const auto* opened = dynamic_cast<const OpenedCompensator*>(&compensator);
  if (opened == nullptr || is_command(opened->argument())) return "";
  return sha256_of_file(opened->argument());
}

}  // namespace

void require_sound(const Recording& recording, const std::string& name) {
  const std::string defect = recording_defect(recording);
  if (!defect.empty())
    throw std::invalid_argument(fmt::format("{}: {}", name, defect));
}

void require_uncompensated(const Recording& recording,
                           const std::string& name) {
  if (find_column(recording, kCompensated) == nullptr) return;
  throw std::invalid_argument(fmt::format(
      "{}: holds a {} already; expected a recording that was not compensated",
      name, kCompensated));
}

CompensatedRate checked_answer(const RateCompensator& compensator,
                               const Recording& recording,
                               const std::string& name) try {
  return public_answer(tested(compensator)->answer(recording));
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(fmt::format("{}: {}", name, error.what()));
}

std::vector<std::string> range_warnings(const RateCompensator& compensator,
                                        const CompensatedRate& answer,
                                        const std::string& name) {
  const auto* file = dynamic_cast<const beamgyro::Compensator*>(&compensator);
  if (answer.clamped == 0) return {};
  if (file == nullptr)
    return {fmt::format("{}: {} of {} samples were clamped, as {} says", name,
                        answer.clamped, answer.rate.size(),
                        compensator.name())};
  return {fmt::format(
      "{}: {} of {} samples lie outside {:g} to {:g} degC, the temperatures "
      "seen in training; clamped{}",
      name, answer.clamped, answer.rate.size(), file->lowest_temperature(),
      file->highest_temperature(),
      answer.sigma.empty() ? ""
                           : ", and sigma there is a guess that grows with the "
                             "distance")};
}

void add_answer(const RateCompensator& compensator, CompensatedRate answer,
                Recording& recording) {
  recording.columns.push_back(column_of(kCompensated, std::move(answer.rate)));
  if (!answer.sigma.empty())
    recording.columns.push_back(
        column_of(kCompensatedSigma, std::move(answer.sigma)));
  recording.compensator = compensator.name();
  recording.compensator_sha256 = sha256_of(compensator);
  if (!recording.history.empty()) recording.history += '\n';
  recording.history += history_line("compensate with " + recording.compensator);
}

}  // namespace internal

CompensatedRun compensate(const RateCompensator& compensator,
                          Recording recording) {
  const std::string name = "the recording";
  internal::require_sound(recording, name);
  internal::require_uncompensated(recording, name);
  CompensatedRate answer =
      internal::checked_answer(compensator, recording, name);
  if (!answer.faults.empty())
    throw std::runtime_error(
        fmt::format("{}: {}", compensator.name(), answer.faults.front()));
  CompensatedRun run{{}, internal::range_warnings(compensator, answer, name)};
  internal::add_answer(compensator, std::move(answer), recording);
  const std::string defect = internal::recording_defect(recording);
  if (!defect.empty())
    throw std::runtime_error(fmt::format("{}: {}", compensator.name(), defect));
  run.recording = std::move(recording);
  return run;
}

}  // namespace beamgyro
