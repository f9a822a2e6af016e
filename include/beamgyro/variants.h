// SPDX-License-Identifier: MIT
/// \file
/// Many runs of one scenario, with other values of some keys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "beamgyro/progress.h"
#include "beamgyro/recording.h"
#include "beamgyro/scenario.h"
#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

/// One thing that is varied: the overrides KEY=VALUE of each of its values.
using VariedValues = std::vector<std::vector<std::string>>;

struct VariantOptions {
  unsigned jobs = 0;  ///< threads; 0: one for each core
  /// What to keep of the runs, as files name it; empty: all.
  std::vector<std::string> variables = {};
  Progress progress = {};  ///< called after each run
};

/// A warning of simulate(), and the number of runs that gave it.
struct VariantWarning {
  std::string text;
  std::size_t runs = 0;
};

/// The values of all runs, run after run; the last axis varies fastest.
struct VariantRuns {
  std::size_t runs = 0;
  std::vector<double> time;          ///< [s], the same in all runs
  std::vector<std::uint8_t> status;  ///< empty where it is not kept
  std::vector<Column> columns;       ///< with runs x time values
  std::vector<VariantWarning> warnings;
};

/// Simulates the scenario with every combination of values of the axes. Each
/// run has the samples that simulate() gives for Scenario::with() these
/// overrides. Files are parsed once, so a run of one sample takes less than
/// reading its scenario. Throws as Scenario::with() and simulate(), with the
/// overrides of the run before the message; std::invalid_argument for an axis
/// without values, an unknown variable, and for runs that differ in their times
/// or in their variables. The values do not depend on the number of threads.
VariantRuns simulate_variants(const Scenario& scenario,
                              const std::vector<VariedValues>& axes,
                              const VariantOptions& options = {});

}  // namespace beamgyro
