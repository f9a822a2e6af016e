// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "validation/result/judgement.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// Seeds in a row.
struct SeedRange {
  std::uint64_t first = 1;
  std::size_t count = 1;  // at least 1
};

/// Judges with one seed on so many threads. Called by several threads at once.
using JudgeOfSeed =
    std::function<CompletedValidation(std::uint64_t seed, std::size_t threads)>;

/// Judges with every seed, side by side, and returns the result of the first
/// seed with the worst verdict; its words name it and tell how many seeds pass.
/// The evidence of one seed for each thread is in memory. The result does not
/// depend on the number of threads. Throws what `judge` throws.
CompletedValidation seed_verdicts(const SeedRange& seeds,
                                  const JudgeOfSeed& judge,
                                  const SpecificationFile& specification,
                                  std::size_t threads,
                                  const ProgressOfWork& progress = {});

}  // namespace beamgyro::internal
