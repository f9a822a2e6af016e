// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "config/document.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::unknown_key_test {
namespace {

/// Reads what a small device file may hold.
void read_device(const ConfigDocument& document) {
  const ConfigTable& root = document.root();
  root.text_or("name", "");
  const ConfigTable beam = root.table_or_empty("beam");
  beam.number_or("length_m", 0.0);
  beam.number_or("side_m", 0.0);
  const ConfigTable readout = root.table_or_empty("readout");
  readout.number_or("offset_V", 0.0);
  readout.table_or_empty("oven").number_or("power_W", 0.0);
}

std::string rejection_of(const std::string& text) {
  const ConfigDocument document = ConfigDocument::parse(text, "unit.toml");
  read_device(document);
  return rejection([&] { document.reject_unknown_keys(); });
}

TEST(UnknownKey, AFullyReadDocumentIsAccepted) {
  const ConfigDocument document = ConfigDocument::parse(
      "name = \"a\"\n[readout.oven]\npower_W = 1\n[beam]\nlength_m = 1\n",
      "unit.toml");
  read_device(document);
  EXPECT_NO_THROW(document.reject_unknown_keys());
}

TEST(UnknownKey, SuggestsAKeyOfItsTable) {
  EXPECT_EQ(rejection_of("[beam]\nside_m = 1\n  lenght_m = 0.04\n"),
            "unit.toml:3:3: beam.lenght_m: unknown key; did you mean "
            "'length_m'?");
  EXPECT_EQ(rejection_of("[baem]\nlength_m = 1"),
            "unit.toml:1:2: baem: unknown key; did you mean 'beam'?");
}

TEST(UnknownKey, SuggestsAnotherTableThatHasTheKey) {
  EXPECT_EQ(rejection_of("[beam]\noffset_V = 2.5"),
            "unit.toml:2:1: beam.offset_V: unknown key; did you mean "
            "'readout.offset_V'?");
}

TEST(UnknownKey, AnAxisOfAnotherTableIsNoSuggestion) {
  const ConfigDocument document = ConfigDocument::parse(
      "[acceleration]\nz = 1\n[cross_rate]\nx = 1\nz = 2\n", "unit.toml");
  document.root().table("acceleration").number("z");
  document.root().table("cross_rate").number("x");
  EXPECT_EQ(rejection([&] { document.reject_unknown_keys(); }),
            "unit.toml:5:1: cross_rate.z: unknown key; [cross_rate] takes x");
}

TEST(UnknownKey, ListsTheKeysOfTheTableWhenNothingIsNear) {
  EXPECT_EQ(rejection_of("[beam]\ncolour = 2.5"),
            "unit.toml:2:1: beam.colour: unknown key; [beam] takes length_m, "
            "side_m");
  EXPECT_EQ(rejection_of("colour = 2.5"),
            "unit.toml:1:1: colour: unknown key; this file takes beam, name, "
            "readout");
}

TEST(UnknownKey, ReportsTheFirstInFileOrder) {
  EXPECT_EQ(rejection_of("[readout]\n[readout.oven]\nzz = 1\n[beam]\naa = 1"),
            "unit.toml:3:1: readout.oven.zz: unknown key; [readout.oven] "
            "takes power_W");
  EXPECT_EQ(rejection_of("[beam]\nzz = 1\naa = 2"),
            "unit.toml:2:1: beam.zz: unknown key; [beam] takes length_m, "
            "side_m");
}

TEST(UnknownKey, FindsKeysOfInlineTables) {
  EXPECT_EQ(rejection_of("beam = { length_m = 1, x = 2 }"),
            "unit.toml:1:24: beam.x: unknown key; [beam] takes length_m, "
            "side_m");
}

TEST(UnknownKey, AKeyOnlyLookedForIsNotUsed) {
  const ConfigDocument document =
      ConfigDocument::parse("[rate]\nsine = 1\nsteps = 2\n", "scn.toml");
  const ConfigTable rate = document.root().table("rate");
  EXPECT_TRUE(rate.has("sine"));
  EXPECT_TRUE(rate.has("steps"));
  EXPECT_FALSE(rate.has("file"));
  rate.number("sine");
  EXPECT_EQ(rejection([&] { document.reject_unknown_keys(); }),
            "scn.toml:3:1: rate.steps: not used together with the other keys "
            "given here; remove it");
}

TEST(UnknownKey, AWrongTypeCountsAsRead) {
  const ConfigDocument document = ConfigDocument::parse("a = 1", "x.toml");
  rejection([&] { document.root().text("a"); });
  EXPECT_NO_THROW(document.reject_unknown_keys());
}

}  // namespace
}  // namespace beamgyro::internal::unknown_key_test
