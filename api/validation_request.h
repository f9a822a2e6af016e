// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compensation/compensator/compensator.h"
#include "compensation/rows/run_source.h"
#include "dataset/files/directory.h"
#include "include/beamgyro/validate.h"
#include "sim/campaign/campaign.h"
#include "validation/bundle/bundle.h"
#include "validation/external/compensator_source.h"
#include "validation/qualification/qualification.h"
#include "validation/result/device_evidence.h"
#include "validation/result/earlier_result.h"
#include "validation/result/validation_result.h"
#include "validation/specification/own_metrics.h"
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

/// A validation that is asked for, with every file that it names read once.
struct ValidationRequest {
  CompensatorSource source;
  ValidationOptions options;
  Qualification qualification;
  SpecificationFile specification;  // with the limits of own_metrics
  std::vector<OwnMetricSource> own_metrics;
  QualifiedDevice device;
  std::optional<CampaignPlan> campaign;
  std::optional<FittedCompensator> workbench, against;
  std::optional<EarlierResult> earlier;
  std::optional<RunSource> set;
  std::vector<ValidationInput> inputs;      // one of two groups stands twice
  std::vector<FileState> recording_states;  // before they were hashed

  /// Reads every file but the recordings, which are hashed; `keeps_inputs`
  /// holds their bytes in memory for a bundle. Isolates code of others from
  /// what it is judged by. Throws as Validator::Validator().
  ValidationRequest(CompensatorSource asked, ValidationOptions with,
                    bool keeps_inputs);

  /// Recordings are read after they were hashed. Throws std::runtime_error for
  /// one that was replaced and replaced back: it is another file, or was moved
  /// or written later.
  void require_same_recordings() const;

  /// Returns where a result comes from, when `judged` is what the device went
  /// through, as drawn from `seed`, if there is one.
  ResultProvenance provenance(const Qualification& judged,
                              std::optional<std::uint64_t> seed) const;

 private:
  void add_file(const std::string& group, const std::filesystem::path& path,
                std::string text);
  void read_device();
  void read_specification();
  void read_own_metrics();
  void open_set();
  void hash_recordings(bool keeps_inputs);
  void hash_recordings_in_memory();
  FittedCompensator read_compensator_of(const std::string& group,
                                        const std::filesystem::path& path);
  void read_baseline();
  void read_campaign();
  void isolate_code();
  void require_model_can_be_trained() const;
  void require_baselines() const;
};

}  // namespace beamgyro::internal
