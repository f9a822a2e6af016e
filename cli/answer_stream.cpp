// SPDX-License-Identifier: MIT
#include "cli/answer_stream.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <iterator>
#include <utility>
#include <vector>

#include "cli/input_lines.h"
#include "cli/sample_lines.h"
#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

constexpr int kLookEvery = 1000;  // [ms], whether the process still works

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

void take_line(InputLine line, SampleLines& lines, RefusedLines& count,
               CompensatorStream& stream) {
  std::optional<Recording> sample;
  try {
    sample = lines.sample(std::move(line));
  } catch (const BadLine& bad) {
    count.add(bad);
    stream.skip();
  }
  if (!sample) return;
  count.add();
  stream.take(*sample);
}

void take_lines(InputLines& input, SampleLines& lines, RefusedLines& count,
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
  RefusedLines count;
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
