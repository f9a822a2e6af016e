// SPDX-License-Identifier: MIT
#include "cli/answer_stream.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

#include "cli/input_lines.h"
#include "cli/sample_lines.h"
#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

constexpr int kLookEvery = 1000;  // [ms], whether the process still works

// As the summary names them, in the order of SampleFault.
constexpr std::array<const char*, static_cast<std::size_t>(SampleFault::kCount)>
    kFaultWords = {"with another number of cells than names",
                   "with a cell that is no number of its column",
                   "with a value that is not finite or out of range",
                   "with a time that does not rise",
                   "too long",
                   "cut off"};

// Counts the samples, and those that are answered nan because they are none.
class SampleCount {
 public:
  void add() { ++samples_; }

  // Warns of the first one of each kind.
  void add(const BadSample& bad) {
    ++samples_;
    ++refused_;
    if (++counts_[static_cast<std::size_t>(bad.fault())] == 1)
      print_warning(
          fmt::format("{}; it is answered nan, and so are others of this kind",
                      bad.what()));
  }

  void print_summary() const {
    if (refused_ == 0) return;
    std::string kinds;
    for (std::size_t k = 0; k < counts_.size(); ++k)
      if (counts_[k] > 0)
        kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", counts_[k],
                             kFaultWords[k]);
    print_warning(fmt::format("{} of {} samples are answered nan: {}", refused_,
                              samples_, kinds));
  }

 private:
  std::array<std::size_t, kFaultWords.size()> counts_{};
  std::size_t samples_ = 0, refused_ = 0;
};

void print_answers(CompensatorStream& stream) {
  const std::vector<StreamAnswer> answers = stream.answers();
  if (answers.empty()) return;
  std::string text;
  for (const auto& [rate, sigma] : answers) {
    const auto out = std::back_inserter(text);
    if (stream.states_sigma())
      fmt::format_to(out, "{},{}\n", rate, sigma);
    else
      fmt::format_to(out, "{}\n", rate);
  }
  print_result(text);
}

void take_line(InputLine line, SampleLines& lines, SampleCount& count,
               CompensatorStream& stream) {
  std::optional<Recording> sample;
  try {
    sample = lines.sample(std::move(line));
  } catch (const BadSample& bad) {
    count.add(bad);
    stream.skip();
  }
  if (!sample) return;
  count.add();
  stream.take(*sample);
}

void take_lines(InputLines& input, SampleLines& lines, SampleCount& count,
                CompensatorStream& stream) {
  while (!stream.fault()) {
    std::optional<InputLine> line = input.next();
    if (!line) return;
    take_line(std::move(*line), lines, count, stream);
    print_answers(stream);
  }
}

}  // namespace

bool answer_stream(CompensatorStream& stream, const std::string& compensator) {
  if (stream.states_sigma())
    print_result("compensated_rate,compensated_rate_sigma\n");
  InputLines input;
  SampleLines lines;
  SampleCount count;
  while (!input.ended() && !stream.fault()) {
    std::array<pollfd, 2> waits = {pollfd{STDIN_FILENO, POLLIN, 0},
                                   pollfd{stream.descriptor(), POLLIN, 0}};
    ::poll(waits.data(), waits.size(), kLookEvery);
    if (waits[0].revents != 0) input.read();
    take_lines(input, lines, count, stream);
    stream.collect();
    print_answers(stream);
  }
  if (!stream.fault()) stream.finish();
  print_answers(stream);
  count.print_summary();
  if (!stream.fault()) return true;
  print_error(fmt::format("{}: {}", compensator, stream.fault()->words));
  return false;
}

}  // namespace beamgyro::internal
