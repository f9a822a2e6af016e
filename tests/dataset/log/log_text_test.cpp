// SPDX-License-Identifier: MIT
#include "dataset/log/log_text.h"

#include <gtest/gtest.h>

#include "tests/config/rejection.h"

namespace beamgyro::internal::log_text_test {
namespace {

using Cells = std::vector<std::string>;

// Every cell of two columns, row by row.
Cells cells_of(std::string_view text, const LogLayout& layout = {}) {
  LogText log(text, "log.csv", layout);
  const std::size_t last = log.select(log.width() - 1);
  const std::size_t first = log.select(0);
  Cells cells;
  while (log.next()) {
    EXPECT_TRUE(log.is_whole()) << log.line();
    cells.emplace_back(log.cell(first));
    cells.emplace_back(log.cell(last));
  }
  return cells;
}

std::string rejection_of(std::string_view text, const LogLayout& layout = {}) {
  return rejection([&] { cells_of(text, layout); });
}

const Cells kFour = {"1", "2", "3", "4"};

TEST(LogText, FindsTheDelimiter) {
  EXPECT_EQ(cells_of("a,x,b\n1,9,2\n3,9,4\n"), kFour);
  EXPECT_EQ(cells_of("a\tx, y\tb\n1\t9\t2\n3\t9\t4\n"), kFour);
  EXPECT_EQ(cells_of("a;x, y;b\n1;9;2\n3;9;4\n"), kFour);
  EXPECT_EQ(
      cells_of("a|b\n1|2\n3|4\n", {.delimiter = '|', .comment_prefixes = {}}),
      kFour);
}

TEST(LogText, AcceptsWhatLoggersAndSpreadsheetsWrite) {
  EXPECT_EQ(cells_of("\xEF\xBB\xBF\"a, 1\",b\r\n 1 ,\"2\"\r\n\r\n3, 4 \r\n"),
            kFour);
  EXPECT_EQ(cells_of("a,b\n1,2,\n3,4,\n"), kFour);
  EXPECT_EQ(cells_of("a,b\n1,2\n3,4"), kFour);
  EXPECT_EQ(cells_of("a,b\n\"1\",2\n   \n3,4"), kFour);
}

TEST(LogText, LeavesOutCommentsAndRowsAsTold) {
  EXPECT_EQ(cells_of("# log\na,b\ns,-\n1,2\n # 5,6\n3,4\n",
                     {.skip_rows = 1, .comment_prefixes = {"#"}}),
            kFour);
  EXPECT_EQ(cells_of("x\ny,z\na,b\n1,2\n3,4\n",
                     {.header_line = 3, .comment_prefixes = {}}),
            kFour);
  EXPECT_EQ(cells_of("1,2\n3,4\n", {.header = false, .comment_prefixes = {}}),
            kFour);
  EXPECT_EQ(cells_of("7,8\n1,2\n3,4\n",
                     {.header = false, .skip_rows = 1, .comment_prefixes = {}}),
            kFour);
}

TEST(LogText, ReadsNamesWithoutQuotes) {
  const LogText log("\"time (ms)\", gyro rad/s,,\n1,2,3,4\n", "log.csv", {});
  EXPECT_EQ(log.names(), (Cells{"time (ms)", "gyro rad/s", "", ""}));
}

TEST(LogText, TellsRowsOfAnotherWidth) {
  LogText log("a,b,c\n1,2\n1,2,3,4\n1,2,3\n1,2,3,,\n", "log.csv", {});
  log.select(2);
  for (const std::size_t cells : {2u, 4u, 3u, 5u}) {
    ASSERT_TRUE(log.next());
    EXPECT_EQ(log.cells(), cells);
    EXPECT_EQ(log.is_whole(), cells == 3);
  }
  EXPECT_FALSE(log.next());
}

TEST(LogText, CellsThatARowLacksAtItsEndAreEmpty) {
  LogText log("a,b,c\n1,2,3\n4,5\n", "log.csv", {});
  const std::size_t c = log.select(2);
  ASSERT_TRUE(log.next());
  EXPECT_FALSE(log.is_short());
  ASSERT_TRUE(log.next());
  EXPECT_TRUE(log.is_short());
  EXPECT_EQ(log.cell(c), "");
  EXPECT_EQ(rejection([&] { log.fail(c, "no"); }), "log.csv:3:4: no");
}

TEST(LogText, LeavesOutHeadersThatAreRepeated) {
  const LogLayout layout{.header_line = 3, .repeated_header = "Channels"};
  LogText log(
      "Channels\t2\n\n t\tw\r\n0\t1\nChannels\t2\n\"\nt\tw\n2\t3\nChannels\n"
      "t\tw \n4\t5",
      "log.lvm", layout);
  const std::size_t w = log.select(1);
  std::string found;
  while (log.next()) found += std::string(log.cell(w)) + ";";
  EXPECT_EQ(found, "1;3;5;");
  log.return_to(8);
  EXPECT_EQ(log.cell(w), "3");

  LogText cut("t,w\n0,1\nChannels\n1,2\n", "log.csv",
              {.repeated_header = "Channels"});
  ASSERT_TRUE(cut.next());
  EXPECT_EQ(rejection([&] { cut.next(); }),
            "log.csv:3:1: a header that no line of names ends; expected the "
            "line 't,w' below it, or another repeated_header in the map");
}

TEST(LogText, GoesBackToARow) {
  LogText log("a,b\n1,2\n\n3,44\n5,6\n", "log.csv", {});
  const std::size_t b = log.select(1);
  while (log.next()) continue;
  log.return_to(4);
  EXPECT_EQ(log.cell(b), "44");
  EXPECT_EQ(rejection([&] { log.fail(b, "no"); }), "log.csv:4:3: no");
  EXPECT_EQ(rejection([&] { log.fail_row("no"); }), "log.csv:4:5: no");
}

TEST(LogText, RefusesWhatIsNoText) {
  EXPECT_EQ(rejection_of(""), "log.csv:1:1: the file is empty; expected a log");
  EXPECT_EQ(rejection_of("\n\n"),
            "log.csv:2:1: no line is left; expected a line of names");
  EXPECT_EQ(rejection_of("# 1\n", {.header = false, .comment_prefixes = {"#"}}),
            "log.csv:1:1: no line is left; expected rows");
  EXPECT_EQ(rejection_of(std::string_view("a,b\n1,\0002\n", 9)),
            "log.csv:2:3: a NUL byte; expected text with one row a line");
  EXPECT_EQ(rejection_of("\xFF\xFE"
                         "a"),
            "log.csv:1:1: the text is UTF-16; expected UTF-8");
  EXPECT_EQ(rejection_of("1,2\n3,4\n"),
            "log.csv:1:1: '1' is a number; expected the line of names (or "
            "header = false in the map)");
  EXPECT_EQ(rejection_of("a,b\n1,\"2\n"),
            "log.csv:2:3: a quote that is not closed on its line; expected a "
            "second '\"'");
}

TEST(LogText, ShowsCellsOnOneLine) {
  EXPECT_EQ(shown_cell("a\rb"), "'a\\x0db'");
  EXPECT_EQ(shown_cell(std::string(41, 'x')),
            "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace beamgyro::internal::log_text_test
