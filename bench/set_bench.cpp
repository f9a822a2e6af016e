// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <fcntl.h>

#include <filesystem>
#include <vector>

#include "dataset/files/open_file.h"
#include "dataset/files/set_files.h"
#include "dataset/files/sha256.h"
#include "dataset/set/shard/shard_builder.h"
#include "sim/campaign/shard_making.h"
#include "sim/scenario/simulation.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCampaign = BEAMGYRO_SCENARIOS "/campaigns/warm_up.toml";
constexpr std::uint32_t kDevices = 20;

const fs::path kFile =
    fs::temp_directory_path() / "beamgyro_bench" / "warm_up_00000.h5";

// Hours of warm-up of twenty devices, before they are put into a file.
struct Hours {
  CampaignPlan campaign = CampaignPlan::read(kCampaign, kDevices);
  ShardPlan plan{campaign, {"bench", "bench"}};
  std::vector<DeviceRow> rows;
  std::vector<Recording> recordings;
};

const Hours& hours() {
  static const Hours all = [] {
    Hours made;
    for (std::uint32_t d = 0; d < kDevices; ++d) {
      const TrimmedGyro gyro =
          make_gyro(made.campaign.device(d).device.value());
      made.recordings.push_back(
          simulated(*made.campaign.run(0, d).scenario, gyro, {.device = d}));
      made.rows.emplace_back();
      made.rows.back().parameters = made.campaign.device(d).parameters;
    }
    return made;
  }();
  return all;
}

std::unique_ptr<ShardBuilder> built(bool compress) {
  ShardHead head = hours().plan.head_of(0);
  head.compress = compress;
  auto file = std::make_unique<ShardBuilder>(head);
  for (std::uint32_t d = 0; d < kDevices; ++d)
    file->add(hours().rows[d], &hours().recordings[d]);
  return file;
}

void report_bytes(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes) *
                          state.iterations());
  state.counters["kB_per_device_hour"] =
      static_cast<double>(bytes) / 1000 / kDevices;
}

// From recordings in memory to a published file with its hash.
void file_written(benchmark::State& state, bool compress) {
  fs::create_directory(kFile.parent_path());
  hours();
  std::size_t bytes = 0;
  for (auto _ : state) {
    const auto file = built(compress);
    const std::span<const std::byte> image = file->finish();
    benchmark::DoNotOptimize(sha256(image));
    publish_file(kFile.parent_path(), kFile.filename(), image);
    bytes = image.size();
  }
  report_bytes(state, bytes);
  fs::remove_all(kFile.parent_path());
}

// What a program takes that only writes the same bytes.
void plain_write(benchmark::State& state) {
  fs::create_directory(kFile.parent_path());
  const auto file = built(false);
  const std::span<const std::byte> image = file->finish();
  for (auto _ : state) {
    OpenFile out(kFile, O_WRONLY | O_CREAT | O_TRUNC);
    out.write(image);
    out.sync();
    out.close();
  }
  report_bytes(state, image.size());
  fs::remove_all(kFile.parent_path());
}

// A whole file of the campaign: devices drawn, prepared, simulated, encoded.
void file_made(benchmark::State& state) {
  const ShardPlan& plan = hours().plan;
  for (auto _ : state) {
    ShardMaker maker(plan);
    GenerationCounts counts;
    benchmark::DoNotOptimize(maker.make(0, counts).bytes.data());
  }
  state.counters["device_hours_per_s"] = benchmark::Counter(
      kDevices, benchmark::Counter::kIsIterationInvariantRate);
}

// The part of it before any file: computed, in memory.
void hours_computed(benchmark::State& state) {
  const CampaignPlan& campaign = hours().campaign;
  for (auto _ : state) {
    for (std::uint32_t d = 0; d < kDevices; ++d) {
      const TrimmedGyro gyro = make_gyro(campaign.device(d).device.value());
      benchmark::DoNotOptimize(
          simulated(*campaign.run(0, d).scenario, gyro, {.device = d}));
    }
  }
  state.counters["device_hours_per_s"] = benchmark::Counter(
      kDevices, benchmark::Counter::kIsIterationInvariantRate);
}

void device_drawn(benchmark::State& state) {
  const CampaignPlan& campaign = hours().campaign;
  std::uint32_t d = 0;
  for (auto _ : state) benchmark::DoNotOptimize(campaign.device(d++));
}

BENCHMARK(device_drawn)->Unit(benchmark::kMicrosecond);
BENCHMARK(hours_computed)->Unit(benchmark::kMillisecond);
BENCHMARK(file_made)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(file_written, compressed, true)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK_CAPTURE(file_written, plain_values, false)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(plain_write)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace beamgyro::internal
