// SPDX-License-Identifier: MIT
#include "include/beamgyro/compensator.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "api/compensators.h"
#include "api/shared_maker.h"
#include "compensation/compensator/compensator.h"
#include "compensation/compensator/compensator_file.h"
#include "config/option_message.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"

namespace beamgyro {
namespace {

class FunctionCompensator final : public RateCompensator {
 public:
  using Function = std::function<std::vector<double>(const Recording&)>;

  FunctionCompensator(std::string name, std::vector<std::string> inputs,
                      Function rate_of)
      : name_(std::move(name)),
        inputs_(std::move(inputs)),
        rate_of_(std::move(rate_of)) {}

  std::string name() const override { return name_; }
  std::vector<std::string> inputs() const override { return inputs_; }
  CompensatedRate answer(const Recording& recording) const override {
    return {.rate = rate_of_(recording)};
  }

 private:
  std::string name_;
  std::vector<std::string> inputs_;
  Function rate_of_;
};

Compensator compensator_of_text(std::string text, const std::string& name,
                                std::string file) {
  auto state = std::make_shared<internal::CompensatorState>();
  state->compensator = internal::parse_compensator(text, name);
  state->text = std::move(text);
  state->name = std::filesystem::path(name).filename().string();
  state->file = std::move(file);
  return internal::SharedMaker::make<Compensator>(std::move(state));
}

}  // namespace

RateCompensator::~RateCompensator() = default;

std::shared_ptr<const RateCompensator> compensator_of(
    std::string name, std::vector<std::string> inputs,
    std::function<std::vector<double>(const Recording&)> rate_of) {
  if (!rate_of)
    throw std::invalid_argument(name + ": no function; expected one");
  return std::make_shared<FunctionCompensator>(
      std::move(name), std::move(inputs), std::move(rate_of));
}

Compensator Compensator::read(const std::filesystem::path& file) {
  return compensator_of_text(internal::read_compensator_text(file),
                             file.string(), file.string());
}

Compensator Compensator::parse(const std::string& text,
                               const std::string& name) {
  return compensator_of_text(text, name, "");
}

std::string Compensator::text() const { return content().text; }

void Compensator::write(const std::filesystem::path& file) const {
  internal::write_text_file(file, content().text);
}

std::string Compensator::name() const { return content().name; }

std::vector<std::string> Compensator::inputs() const {
  return internal::tested(content().compensator)->inputs();
}

CompensatedRate Compensator::answer(const Recording& recording) const {
  internal::require_sound(recording, "the recording");
  const internal::FittedCompensator& own = content().compensator;
  return {.rate = internal::compensated_rate(own, recording),
          .sigma = internal::compensated_rate_sigma(own, recording),
          .clamped = internal::clamped_samples(own, recording)};
}

std::string Compensator::method() const {
  return content().compensator.provenance.method;
}
double Compensator::lowest_temperature() const {
  return content().compensator.temperature_range.lowest;
}
double Compensator::highest_temperature() const {
  return content().compensator.temperature_range.highest;
}
bool Compensator::states_sigma() const {
  return content().compensator.sigma.has_value();
}
std::string Compensator::curve() const {
  return internal::settled_curve(content().compensator);
}
std::vector<std::string> Compensator::warnings() const {
  return content().compensator.provenance.warnings;
}

std::shared_ptr<const RateCompensator> open_compensator(
    const std::string& argument, const ProcessOptions& options) {
  const internal::SourceKind kind = internal::source_kind(argument);
  if (!internal::is_program(kind)) {
    if (!options.plugin_files.empty())
      throw internal::option_error(
          "{} is for a library or a command; {} is neither",
          internal::NamedOption{"plugin_files"}, argument);
    return std::make_shared<Compensator>(Compensator::read(argument));
  }
  if (!(options.stall_s > 0))
    throw std::invalid_argument(
        fmt::format("stall_s {}: expected a time above 0", options.stall_s));
  if (kind == internal::SourceKind::kLibrary) {
    if (!std::filesystem::exists(argument))
      throw std::invalid_argument(argument + ": No such file or directory");
    if (options.program.empty())
      throw std::invalid_argument(
          argument +
          ": no program to load it; expected the place of the "
          "program beamgyro");
  }
  return std::make_shared<internal::OpenedCompensator>(internal::open_source(
      argument, internal::ProcessLimits{
                    .stall = options.stall_s,
                    .memory = options.memory,
                    .program = options.program,
                    .isolation = {.plugin_files = options.plugin_files,
                                  .hidden = options.hidden_files,
                                  .required = options.require_isolation}}));
}

}  // namespace beamgyro
