// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "config/document.h"
#include "tests/config/rejection.h"

namespace beamgyro {
namespace {

std::string rejection_of(const std::string& text) {
  return rejection([&] { ConfigDocument::parse(text, "scn.toml"); });
}

TEST(TomlText, MalformedTextIsRejectedWithItsPlace) {
  const std::pair<std::string, std::string> cases[] = {
      {"[beam\nx = 1", "scn.toml:1:6: not TOML: "},
      {"x = ", "scn.toml:1:5: not TOML: "},
      {"[beam]\nx = [1, 2", "scn.toml:2:10: not TOML: "},
      {"x = 1\nx = 2", "scn.toml:2:5: not TOML: "},
      {"x = 1e999", "scn.toml:1:10: not TOML: "},
      {"x = 99999999999999999999", "scn.toml:1:25: not TOML: "},
      {"\x89HDF\r\n\x1a\n", "scn.toml:1:1: not TOML: "},
      {"{\"filetype\": 1}", "scn.toml:1:1: not TOML: "},
      {std::string("x = 1\0", 6), "scn.toml:1:6: not TOML: "},
  };
  for (const auto& [text, start] : cases) {
    const std::string message = rejection_of(text);
    EXPECT_EQ(message.substr(0, start.size()), start) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(TomlText, InputThatStopsThePackagedParserIsRejectedLikeAnyOther) {
  EXPECT_TRUE(rejection_of("[[[").starts_with("scn.toml:1:3: not TOML: "));
  EXPECT_TRUE(rejection_of("[`").starts_with("scn.toml:1:2: not TOML: "));
  EXPECT_TRUE(rejection_of("x = 1 \xc3\xa9").starts_with("scn.toml:1:7: "));
  EXPECT_TRUE(rejection_of("\xc2\xb5 = 1").starts_with("scn.toml:1:1: "));
}

TEST(TomlText, TextThatIsNotUtf8IsRejected) {
  EXPECT_TRUE(rejection_of("a = 1\nname = \"\xff\"")
                  .starts_with("scn.toml:2:8: not TOML: "));
  EXPECT_TRUE(
      rejection_of("name = \"gr\xf6\xdf\x65\"").starts_with("scn.toml:1:"));
}

TEST(TomlText, DeepNestingIsRejectedBeforeItOverflowsTheStack) {
  std::string header = "[a";
  for (int i = 0; i < 1000000; ++i) header += ".a";
  EXPECT_EQ(rejection_of("\n" + header + "]\n"),
            "scn.toml:2:513: not TOML: a key of more than 256 parts");
  EXPECT_TRUE(rejection_of("x = " + std::string(100000, '['))
                  .starts_with("scn.toml:1:"));
}

TEST(TomlText, LongTextsWithDotsAreNoDeepKeys) {
  std::string text = "x = \"";
  for (int i = 0; i < 1000; ++i) text += "...";
  text += "\"\ny = [";
  for (int i = 0; i < 1000; ++i) text += "0.5, ";
  const ConfigDocument document = ConfigDocument::parse(text + "]", "scn.toml");
  EXPECT_EQ(document.root().numbers("y").size(), 1000u);
}

TEST(TomlText, ByteOrderMarkAndCarriageReturnsAreAccepted) {
  const ConfigDocument document =
      ConfigDocument::parse("\xEF\xBB\xBF[a]\r\nx = 1\r\n", "scn.toml");
  EXPECT_EQ(document.root().table("a").number("x"), 1.0);
}

TEST(TomlText, ANulInATextIsRejected) {
  const ConfigDocument document =
      ConfigDocument::parse("file = \"a\\u0000b\"", "scn.toml");
  EXPECT_EQ(rejection([&] { document.root().text("file"); }),
            "scn.toml:1:8: file: \"a\\x00b\" holds a NUL character; remove it");
}

TEST(TomlText, LongAndStrangeValuesAreShownOnOneLine) {
  const ConfigDocument document = ConfigDocument::parse(
      "a = \"x\\ny\"\nb = \"" + std::string(1000, 'b') + "\"", "scn.toml");
  EXPECT_NE(rejection([&] { document.root().number("a"); }).find("x\\x0ay"),
            std::string::npos);
  EXPECT_LT(rejection([&] { document.root().number("b"); }).size(), 250u);
}

}  // namespace
}  // namespace beamgyro
