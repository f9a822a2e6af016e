// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compensation/inputs/input.h"
#include "compensation/methods/method_list.h"
#include "compensation/rows/training_rows.h"
#include "config/document.h"

namespace beamgyro::internal {

/// One of the models of an automatic choice.
struct Candidate {
  std::string name;  // as the model file says it
  std::vector<Input> inputs;
  FitSpec kind;
};

/// The contents of a model file: what to train.
struct ModelSpec {
  std::vector<Input> inputs = {};
  RowOptions rows = {};
  FitSpec kind = {};
  std::vector<Candidate> candidates = {};  // simplest first; empty = `kind`
  std::optional<double> scale_factor_bin_K = {};  // [scale_factor], > 0
  std::string text = {};                          // model file as read
  std::vector<std::filesystem::path> files = {};  // all that was read
};

/// Reads a model file (docs/reference/model_file.md). Throws
/// std::invalid_argument with file, line and column for a key, type or value
/// that is not allowed, an unknown key, or inputs the kind of model cannot
/// take; of an adapted model also for the file of its population, whose name is
/// relative to the model file.
ModelSpec read_model(const std::filesystem::path& file);
ModelSpec read_model(const ConfigDocument& document);

/// Makes every network of `spec` tell `observer` about its epochs.
void observe(ModelSpec& spec, const EpochObserver& observer);

}  // namespace beamgyro::internal
