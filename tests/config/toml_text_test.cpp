// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/document.h"
#include "config/overrides.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::toml_text_test {
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
    EXPECT_FALSE(holds(message, "\n"));
  }
}

TEST(TomlText, ALogIsTakenForOne) {
  constexpr const char* kSaid = "; the file looks like CSV, expected";
  EXPECT_TRUE(holds(rejection_of("t,w,T\n0,1,20\n"), kSaid));
  EXPECT_TRUE(holds(rejection_of("\"t\"\t\"w\"\n0\t1\n"), kSaid));
  EXPECT_FALSE(holds(rejection_of("x = [1, 2"), kSaid));
  EXPECT_FALSE(holds(rejection_of("{\"a\": 1, \"b\": 2}"), kSaid));
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

std::string repeated(std::size_t count, const std::string& text) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

TEST(TomlText, DeepNestingIsRejectedBeforeItOverflowsTheStack) {
  const std::string reason =
      "not TOML: keys, tables and arrays nest deeper than 256";
  const std::string dotted = "a" + repeated(200, ".a");
  for (const std::string& text : {
           "[a" + repeated(1000000, ".a") + "]\n",
           "\"a\"" + repeated(100000, ".\"a\"") + " = 1",
           "\",\"" + repeated(30000, ".\",\"") + " = 1",
           "'='" + repeated(30000, " . '#'") + " = 1",
           repeated(250, dotted + " = {") + "a = 1" + repeated(250, "}"),
           "x = [" + repeated(200, "[") + "{" + dotted + " = 1}",
           fmt::format("[{}]\n{} = 1", dotted, dotted),
           fmt::format("\xEF\xBB\xBF[[{}]]\n{} = 1", dotted, dotted),
           "x = \"\"\"\"\"\"\ny = " + repeated(300, "["),
           "x = '''a'''''\ny = " + repeated(300, "["),
           "x = " + repeated(100000, "["),
       }) {
    const std::string message = rejection_of(text);
    EXPECT_TRUE(holds(message, reason));
  }
  EXPECT_TRUE(rejection_of("\n[a" + repeated(300, ".a") + "]\n")
                  .starts_with("scn.toml:2:513: not TOML: "));
}

TEST(TomlText, DeepNestingBySetIsRejected) {
  const std::string value = repeated(250, "{a" + repeated(200, ".a") + " = ") +
                            "1" + repeated(250, "}");
  EXPECT_TRUE(holds(rejection([&] { Overrides({"x=" + value}); }),
                    "nest deeper than 256"));
}

TEST(TomlText, NestingUpToTheLimitIsRead) {
  const std::string dotted = "a" + repeated(120, ".a");
  const ConfigDocument document = ConfigDocument::parse(
      "[" + dotted + "]\n" + dotted + " = [{b = 1}] # [[[[\n[b]\nx = \"" +
          repeated(300, "[") + "\"\n[c]\n" + dotted + " = 1",
      "scn.toml");
  EXPECT_EQ(document.root().table("b").text("x"), repeated(300, "["));
}

TEST(TomlText, MoreValuesThanMemoryShouldHoldAreRejected) {
  for (const char* value : {"1,", "{},", "[],\n", "{a.b=1},"}) {
    const std::string message =
        rejection_of("x = [" + repeated(1000000, value) + "1]");
    EXPECT_TRUE(holds(message, "more than 500000 keys and values"));
  }
  EXPECT_TRUE(
      holds(rejection_of("# " + std::string(std::size_t{17} << 20, 'x')),
            "bytes; expected at most 16777216"));
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
  EXPECT_TRUE(
      holds(rejection([&] { document.root().number("a"); }), "x\\x0ay"));
  EXPECT_LT(rejection([&] { document.root().number("b"); }).size(), 250u);
}

}  // namespace
}  // namespace beamgyro::internal::toml_text_test
