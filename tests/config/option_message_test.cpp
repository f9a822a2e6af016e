// SPDX-License-Identifier: MIT
#include "config/option_message.h"

#include <gtest/gtest.h>

#include "config/overrides.h"

namespace beamgyro::internal::option_message_test {
namespace {

std::string shouted(std::string_view name, std::string_view value) {
  return '!' + std::string(name) + '(' + std::string(value) + ')';
}

OptionError window() {
  std::string file = "a.h5";  // is gone when the message is composed again
  return option_error("{}: {} is {:g} s; expected no {}", file,
                      NamedOption{"from_s", "9"}, 9.5, NamedOption{"to_s"});
}

TEST(OptionMessage, EachReaderSeesOptionsInItsOwnSpelling) {
  const OptionError error = window();
  EXPECT_STREQ(error.what(), "a.h5: from_s = 9 is 9.5 s; expected no to_s");
  EXPECT_EQ(error.words(shouted),
            "a.h5: !from_s(9) is 9.5 s; expected no !to_s()");
}

TEST(OptionMessage, WordsBeforeAnErrorLeaveItsSpellingToTheReader) {
  const OptionError error("b.toml: ", window());
  EXPECT_STREQ(error.what(),
               "b.toml: a.h5: from_s = 9 is 9.5 s; expected no to_s");
  EXPECT_EQ(error.words(shouted),
            "b.toml: a.h5: !from_s(9) is 9.5 s; expected no !to_s()");
  const std::invalid_argument plain("no options");
  EXPECT_EQ(OptionError("x: ", plain).words(shouted), "x: no options");
}

TEST(OptionMessage, AnOverrideIsSpelledAsAnOption) {
  try {
    reject_override("a.b=3", "is wrong");
    FAIL();
  } catch (const OptionError& error) {
    EXPECT_STREQ(error.what(), "set a.b=3: is wrong");
    EXPECT_EQ(error.words(shouted), "!set() a.b=3: is wrong");
  }
}

}  // namespace
}  // namespace beamgyro::internal::option_message_test
