// SPDX-License-Identifier: MIT
#include "validation/external/file_compensator.h"

#include <set>
#include <utility>

#include "validation/external/answering.h"

namespace beamgyro::internal {
namespace {

class FileCompensator : public TestedCompensator {
 public:
  explicit FileCompensator(FittedCompensator compensator)
      : compensator_(std::move(compensator)) {}

  std::vector<std::string> inputs() const override {
    std::set<std::string> names = {"rate", "temperature"};
    for (const Input& input : compensator_.inputs)
      if (!input.column.empty()) names.insert(input.column);
    return {names.begin(), names.end()};
  }

  std::vector<Answer> answers(
      const std::vector<const Recording*>& runs) const override {
    std::vector<Answer> all;
    for (const Recording* run : runs) {
      const Stopwatch watch;
      Answer& answer = all.emplace_back();
      answer.rate = compensated_rate(compensator_, *run);
      answer.sigma = compensated_rate_sigma(compensator_, *run);
      answer.seconds = watch.seconds();
      answer.clamped = clamped_samples(compensator_, *run);
      add_fault_of_values(*run, answer);
      add_fault_of_speed(*run, answer);
    }
    return all;
  }

 private:
  FittedCompensator compensator_;
};

}  // namespace

std::unique_ptr<TestedCompensator> tested(FittedCompensator compensator) {
  return std::make_unique<FileCompensator>(std::move(compensator));
}

}  // namespace beamgyro::internal
