// SPDX-License-Identifier: MIT
// A campaign file beside the shipped scenarios; its first devices are drawn.
#include "sim/campaign/campaign.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace beamgyro::internal;
  const std::filesystem::path file =
      scratch_file("campaign.toml", text_of(data, size));
  accept_or_reject([&] {
    const CampaignPlan campaign = CampaignPlan::read(file);
    for (std::uint32_t device = 0; device < 2; ++device) {
      static_cast<void>(campaign.device(device));
      static_cast<void>(campaign.part(device));
      for (std::size_t run = 0; run < campaign.runs.size(); ++run)
        static_cast<void>(campaign.run(run, device));
    }
  });
  return 0;
}
