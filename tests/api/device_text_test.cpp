// SPDX-License-Identifier: MIT
#include "api/device_text.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace beamgyro::internal::device_text_test {
namespace {

constexpr const char* kBase =
    "# what it is\n"
    "[beam]\n"
    "length_m = 0.04   # long\n"
    "[patches]\n"
    "offset_m = [14e-6, -5e-6, 8e-6, 3e-6]\n"
    "\n"
    "[readout]\n"
    "mode = \"open # loop\"\n";

TEST(DeviceText, KeepsValuesAndSaysWhereTheyComeFrom) {
  const DeviceText text(kBase, "base.toml", "as base.toml");
  EXPECT_EQ(text.text({"mine"}),
            "# mine\n"
            "\n[beam]\nlength_m = 0.04   # as base.toml\n"
            "\n[patches]\n"
            "offset_m = [14e-6, -5e-6, 8e-6, 3e-6]   # as base.toml\n"
            "\n[readout]\nmode = \"open # loop\"   # as base.toml\n");
}

TEST(DeviceText, ReplacesScalesAndAddsKeys) {
  DeviceText text(kBase, "base.toml", "");
  EXPECT_EQ(text.numbers("patches.offset_m"),
            (std::vector{14e-6, -5e-6, 8e-6, 3e-6}));
  EXPECT_TRUE(text.numbers("beam.offset_m").empty());
  text.scale("patches.offset_m", 0.5, "half");
  text.scale("beam.side_m", 0.5, "not there");
  text.set("beam.length_m", 9e-3, "short");
  text.set("beam.side_m", 1e-3, "new");
  EXPECT_EQ(text.text({}),
            "\n[beam]\nlength_m = 0.009   # short\nside_m = 0.001   # new\n"
            "\n[patches]\n"
            "offset_m = [7e-06, -2.5e-06, 4e-06, 1.5e-06]   # half\n"
            "\n[readout]\nmode = \"open # loop\"   # \n");
}

TEST(DeviceText, RefusesAValueOnSeveralLines) {
  EXPECT_THROW(DeviceText("[a]\nb = [1,\n2]\n", "base.toml", ""),
               std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::device_text_test
