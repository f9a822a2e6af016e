// SPDX-License-Identifier: MIT
// What libraries and commands cost as compensators:
//
//   beamgyro_external PROGRAM SAMPLES COMPENSATOR...
//
// prints, for each, microseconds a sample: wall clock, and processor time of
// this process and of those that it started. PROGRAM is beamgyro.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <string>

#include "dataset/recording/signals.h"
#include "validation/external/compensator_source.h"

namespace {

using beamgyro::Recording;
using beamgyro::internal::Answer;

// The measured variables of a simulated run at 100 Hz.
Recording run_of(std::size_t samples) {
  Recording run;
  std::vector<double> values[6];
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = 0.01 * static_cast<double>(k);
    run.time.push_back(t);
    run.status.push_back(0);
    const double rate = 50.0 * std::sin(0.1 * t);
    const double all[] = {
        2.5 + 0.0125 * rate, rate,           20.0 + std::sin(1e-3 * t),
        9000.0 + 1e-3 * t,   1.0 + 1e-6 * t, 0.1 * std::cos(t)};
    for (std::size_t i = 0; i < 6; ++i) values[i].push_back(all[i]);
  }
  const char* names[] = {"output",          "rate",          "temperature",
                         "drive_frequency", "drive_voltage", "quadrature"};
  for (std::size_t i = 0; i < 6; ++i)
    run.columns.push_back(
        beamgyro::internal::column_of(names[i], std::move(values[i])));
  return run;
}

double processor_seconds(int who) {
  rusage use{};
  getrusage(who, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) +
           1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  beamgyro::internal::ProcessLimits limits;
  limits.program = argv[1];
  const Recording run = run_of(std::stoul(argv[2]));
  const double samples = static_cast<double>(run.time.size());
  for (int k = 3; k < argc; ++k) {
    const auto compensator =
        beamgyro::internal::open_tested_compensator(argv[k], limits);
    const double here = processor_seconds(RUSAGE_SELF);
    const double there = processor_seconds(RUSAGE_CHILDREN);
    const Answer answer = compensator->answer(run);
    fmt::print("{}: wall {:.2f}, here {:.2f}, started {:.2f} us a sample{}\n",
               argv[k], 1e6 * answer.seconds / samples,
               1e6 * (processor_seconds(RUSAGE_SELF) - here) / samples,
               1e6 * (processor_seconds(RUSAGE_CHILDREN) - there) / samples,
               answer.faults.empty() ? "" : " " + answer.faults[0].words);
  }
  return 0;
}
