// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/config/rejection.h"
#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::spurious_mode_file_test {
namespace {

std::string mode(const std::string& name, const std::string& changed = "") {
  return "spurious_mode." + name +
         "={detuning=-0.004, detuning_tc_per_K=-2.5e-4, loss_factor=1e-3, "
         "coupling_drive=2e-5, coupling_sense=-1e-5" +
         changed + "}";
}

std::string why(const std::vector<std::string>& overrides) {
  return rejection([&] { nominal_device(overrides); });
}

TEST(SpuriousModeFile, ModesAreReadInTheOrderOfTheFile) {
  const auto modes =
      nominal_device({mode("wire"), mode("pin", ", follows=\"housing\""),
                      "spurious_mode.pin.coupling_sense=3e-5"})
          .spurious_modes;
  ASSERT_EQ(modes.size(), 2);
  EXPECT_EQ(modes[0].name, "wire");
  EXPECT_EQ(modes[0].detuning, -0.004);
  EXPECT_EQ(modes[0].coupling_sense, -1e-5);
  EXPECT_FALSE(modes[0].follows_housing);
  EXPECT_TRUE(modes[1].follows_housing);
  EXPECT_EQ(modes[1].coupling_sense, 3e-5);
}

TEST(SpuriousModeFile, WithoutCouplingThereIsNoMode) {
  const std::string none = "spurious_mode.wire.coupling_drive=0";
  EXPECT_EQ(nominal_device({mode("wire"), none}).spurious_modes.size(), 1);
  EXPECT_TRUE(nominal_device(
                  {mode("wire"), none, "spurious_mode.wire.coupling_sense=0"})
                  .spurious_modes.empty());
}

TEST(SpuriousModeFile, WhatIsWrongIsRefusedWithItsKeyAndValue) {
  const std::pair<std::string, std::string> values[] = {
      {"detuning=0.5", "spurious_mode.wire.detuning"},
      {"detuning_tc_per_K=0.01", "spurious_mode.wire.detuning_tc_per_K"},
      {"loss_factor=0", "spurious_mode.wire.loss_factor"},
      {"coupling_drive=0.1", "spurious_mode.wire.coupling_drive"},
      {"coupling_sense=-0.1", "spurious_mode.wire.coupling_sense"},
      {"follows=\"board\"", "expected one of \"beam\", \"housing\""},
      {"detuning_per_decade=1e-4", "without [memory.ageing]"},
      {"detuning_slip=1e-4", "without [memory.hysteresis]"},
      {"stiffness=1", "spurious_mode.wire.stiffness"}};
  for (const auto& [bad, says] : values)
    EXPECT_TRUE(holds(why({mode("wire"), "spurious_mode.wire." + bad}), says));
  EXPECT_TRUE(holds(why({"spurious_mode.wire.detuning=0"}),
                    "spurious_mode.wire.detuning_tc_per_K"));
}

TEST(SpuriousModeFile, SeventeenModesAreTooMany) {
  std::vector<std::string> modes;
  for (int i = 0; i < 17; ++i) modes.push_back(mode("m" + std::to_string(i)));
  EXPECT_TRUE(holds(why(modes), "17 modes; expected at most 16"));
  modes.pop_back();
  EXPECT_EQ(nominal_device(modes).spurious_modes.size(), 16);
}

}  // namespace
}  // namespace beamgyro::internal::spurious_mode_file_test
