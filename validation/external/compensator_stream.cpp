// SPDX-License-Identifier: MIT
#include "validation/external/compensator_stream.h"

#include <cmath>
#include <utility>

#include "compensation/compensator/compensator_file.h"
#include "compensation/uncertainty/bias_sigma.h"
#include "validation/external/command_compensator.h"
#include "validation/external/compensator_source.h"
#include "validation/external/library_compensator.h"
#include "validation/external/process_stream.h"

namespace beamgyro::internal {
namespace {

std::vector<Input> with_temperature(std::vector<Input> inputs) {
  inputs.push_back(parse_input("temperature"));
  return inputs;
}

class FileStream : public CompensatorStream {
 public:
  explicit FileStream(FittedCompensator compensator)
      : compensator_(std::move(compensator)),
        inputs_(with_temperature(compensator_.inputs)),
        features_(inputs_, compensator_.temperature_range),
        measured_(inputs_.size()),
        values_(inputs_.size()) {
    if (compensator_.sigma) sigma_.emplace(*compensator_.sigma);
  }

  void take(const Recording& sample) override;
  void finish() override {}
  bool states_sigma() const override { return sigma_.has_value(); }

 private:
  FittedCompensator compensator_;
  std::vector<Input> inputs_;  // with the temperature at the end
  FeatureStream features_;
  std::optional<BiasSigmaStream> sigma_;
  std::vector<double> measured_, values_;
};

void FileStream::take(const Recording& sample) {
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (!inputs_[i].column.empty())
      measured_[i] = column_values(sample, inputs_[i].column)[0];
  const double rate = column_values(sample, "rate")[0];
  if (!features_.step(sample.time[0], sample.status[0], measured_, values_)) {
    if (sigma_) sigma_->step(sample.time[0], sample.status[0], NAN);
    answers_.push_back({NAN});
    return;
  }
  const auto count = static_cast<Eigen::Index>(inputs_.size()) - 1;
  const Eigen::ArrayXXd x =
      Eigen::Map<const Eigen::ArrayXXd>(values_.data(), 1, count);
  const double bias = compensator_.bias.predict(x)(0);
  const double scale = compensator_.scale_factor
                           ? compensator_.scale_factor->at(values_.back())
                           : 1.0;
  StreamAnswer answer{(rate - bias) / scale};
  if (sigma_)
    answer.sigma = sigma_->step(sample.time[0], sample.status[0],
                                column_values(sample, "temperature")[0]) /
                   scale;
  answers_.push_back(answer);
}

}  // namespace

std::unique_ptr<CompensatorStream> open_compensator_stream(
    const std::string& argument, const ProcessLimits& limits,
    std::optional<double> period) {
  switch (source_kind(argument)) {
    case SourceKind::kCommand:
      return process_stream(command_process(argument, limits), limits, 1.0);
    case SourceKind::kLibrary:
      return process_stream(library_process(argument, limits), limits, period);
    default:
      return std::make_unique<FileStream>(read_compensator(argument));
  }
}

}  // namespace beamgyro::internal
