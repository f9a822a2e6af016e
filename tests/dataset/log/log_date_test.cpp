// SPDX-License-Identifier: MIT
#include "dataset/log/log_date.h"

#include <gtest/gtest.h>

#include "tests/config/rejection.h"

namespace beamgyro::internal::log_date_test {
namespace {

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
// date -u -d '2026-03-05 14:07:09' +%s
constexpr std::int64_t kMarch = 1772719629 * kSecond;

std::optional<std::int64_t> read(const char* pattern, const char* text) {
  return DateFormat(pattern).read(text);
}

TEST(DateFormat, ReadsIso8601) {
  EXPECT_EQ(read("iso", "1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(read("iso", "2026-03-05T14:07:09"), kMarch);
  EXPECT_EQ(read("iso", "2026-03-05 14:07:09.25"), kMarch + kSecond / 4);
  EXPECT_EQ(read("iso", "2026-03-05t14:07:09,000000001"), kMarch + 1);
  EXPECT_EQ(read("iso", "2026-03-05T14:07:09.1234567899"), kMarch + 123456789);
  EXPECT_EQ(read("iso", "2026-03-05T15:07:09+01:00"), kMarch);
  EXPECT_EQ(read("iso", "2026-03-05T08:37:09 -0530"), kMarch);
  EXPECT_EQ(read("iso", "2026-03-05T14:07"), kMarch - 9 * kSecond);
  EXPECT_EQ(read("iso", "2026-03-05"),
            kMarch - (14 * 3600 + 7 * 60 + 9) * kSecond);
  EXPECT_EQ(read("iso", "2024-02-29T00:00:00"),
            read("iso", "2024-03-01T00:00:00").value() - kNanosecondsPerDay);
}

TEST(DateFormat, RefusesWhatIsNoIso8601OrDoesNotExist) {
  for (const char* text :
       {"", "2026", "2026-3-5", "05.03.2026", "2026-02-29T00:00:00",
        "2026-13-01", "2026-00-01", "2026-03-05T24:00:00",
        "2026-03-05T14:60:00", "2026-03-05T14:07:61", "2026-03-05T",
        "2026-03-05T14:07:09X", "2026-03-05T14:07:09+1", "2026-03-05T14:07:09.",
        "1583600000", "1850-01-01", "9999-01-01", "2026-03-05T14:07:09+99:00"})
    EXPECT_EQ(read("iso", text), std::nullopt) << text;
}

TEST(DateFormat, ReadsPatterns) {
  EXPECT_EQ(read("%d.%m.%Y %H:%M:%S", "05.03.2026  14:07:09"), kMarch);
  EXPECT_EQ(read("%d.%m.%Y %H:%M:%S", "5.3.2026 14:07:09,5"),
            kMarch + kSecond / 2);
  EXPECT_EQ(read("%m/%d/%y %I:%M:%S %p", "03/05/26 02:07:09 PM"), kMarch);
  EXPECT_EQ(read("%m/%d/%Y %I:%M:%S %p", "3/5/2026 12:00:00 am"),
            kMarch - (14 * 3600 + 7 * 60 + 9) * kSecond);
  EXPECT_EQ(read("%d-%b-%Y %H:%M:%S", "05-MAR-2026 14:07:09"), kMarch);
  EXPECT_EQ(read("%Y%m%d%H%M%S", "20260305140709"), kMarch);
  EXPECT_EQ(read("%Y-%m-%dT%H:%M:%S%z", "2026-03-05T15:07:09+01"), kMarch);
  EXPECT_EQ(read("%Y/%m/%d %H:%M:%S:%f", "2026/03/05 14:07:09:250"),
            kMarch + kSecond / 4);
  EXPECT_EQ(read("%d.%m.%y 100%% %H h", "01.01.70 100% 1 h"), 3600 * kSecond);
  EXPECT_EQ(read("%H:%M", "01:30"), 5400 * kSecond);
  EXPECT_EQ(read("%d.%m.%Y", "32.01.2026"), std::nullopt);
  EXPECT_EQ(read("%m/%d/%Y %I:%M %p", "3/5/2026 13:00 PM"), std::nullopt);
  EXPECT_EQ(read("%H:%M", "01:30:00"), std::nullopt);
}

TEST(DateFormat, ItsExampleIsOfItsForm) {
  for (const char* pattern : {"iso", "%d.%m.%Y %H:%M:%S", "%m/%d/%y %I:%M %p",
                              "%H:%M:%S.%f", "%Y%m%d %H%M%S%z", "%d-%b-%Y"}) {
    const DateFormat format(pattern);
    EXPECT_TRUE(format.read(format.example())) << format.example();
  }
  EXPECT_TRUE(DateFormat("%d.%m.%Y").has_date());
  EXPECT_FALSE(DateFormat("%H:%M:%S").has_date());
}

TEST(DateFormat, RefusesPatternsThatAreNoTime) {
  const auto says = [](const char* pattern, const char* why) {
    const std::string message = rejection([&] { DateFormat format(pattern); });
    EXPECT_TRUE(holds(message, why)) << pattern << message;
  };
  says("", "is no form of a date or time");
  says("DD.MM.YYYY", "is no form of a date or time");
  says("%d.%m %H:%M", "is no form of a date or time");
  says("%d.%m.%Y %Q", "%Q is not known");
  says("%d.%m.%Y %", "is not known");
  says("%d.%m.%Y %I:%M", "%p (AM or PM)");
  says("%H:%M %p", "%p (AM or PM)");
}

TEST(LooksLikeDate, TellsDatesFromNumbers) {
  for (const char* text :
       {"2026-03-05T14:00:00", "05.03.2026", "3/5/26", "14:00", "2026-03-05"})
    EXPECT_TRUE(looks_like_date(text)) << text;
  for (const char* text : {"", "12.5", "-1-2-3", "1e-5", "25 degC", "12,5"})
    EXPECT_FALSE(looks_like_date(text)) << text;
}

}  // namespace
}  // namespace beamgyro::internal::log_date_test
