// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "dataset/files/text_file.h"

// LLVMFuzzerTestOneInput of each target; CMakeLists.txt renames them.
extern "C" {
int fuzz_campaign(const std::uint8_t* data, std::size_t size);
int fuzz_compensator(const std::uint8_t* data, std::size_t size);
int fuzz_device(const std::uint8_t* data, std::size_t size);
int fuzz_log(const std::uint8_t* data, std::size_t size);
int fuzz_manifest(const std::uint8_t* data, std::size_t size);
int fuzz_map(const std::uint8_t* data, std::size_t size);
int fuzz_model(const std::uint8_t* data, std::size_t size);
int fuzz_profile(const std::uint8_t* data, std::size_t size);
int fuzz_recording(const std::uint8_t* data, std::size_t size);
int fuzz_scenario(const std::uint8_t* data, std::size_t size);
int fuzz_shard(const std::uint8_t* data, std::size_t size);
int fuzz_toml(const std::uint8_t* data, std::size_t size);
}

namespace beamgyro::internal::replay_test {
namespace {

struct Target {
  std::string name;  // of its directory in the corpus
  int (*read)(const std::uint8_t* data, std::size_t size);
};

class FuzzCorpus : public testing::TestWithParam<Target> {};

// What a reader must not do ends the process: an exception other than a
// rejection, a crash, or with the sanitizers a wrong access.
TEST_P(FuzzCorpus, EveryInputIsReadOrRefused) {
  const std::filesystem::path folder =
      std::filesystem::path(BEAMGYRO_CORPUS) / GetParam().name;
  int inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    const std::string text = read_text_file(entry.path());
    EXPECT_NO_THROW(GetParam().read(
        reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    ++inputs;
  }
  EXPECT_GT(inputs, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Targets, FuzzCorpus,
    testing::Values(Target{"campaign", fuzz_campaign},
                    Target{"compensator", fuzz_compensator},
                    Target{"device", fuzz_device}, Target{"log", fuzz_log},
                    Target{"manifest", fuzz_manifest}, Target{"map", fuzz_map},
                    Target{"model", fuzz_model},
                    Target{"profile", fuzz_profile},
                    Target{"recording", fuzz_recording},
                    Target{"scenario", fuzz_scenario},
                    Target{"shard", fuzz_shard}, Target{"toml", fuzz_toml}),
    [](const auto& target) { return target.param.name; });

}  // namespace
}  // namespace beamgyro::internal::replay_test
