// SPDX-License-Identifier: MIT
#include "dataset/files/open_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "config/document.h"
#include "config/file_error.h"
#include "dataset/files/text_file.h"
#include "tests/dataset/system_calls.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::open_file_test {
namespace {

namespace fs = std::filesystem;

class OpenFileTest : public DirectoryFixture {
 protected:
  const fs::path path = directory / "file";
};

void write_x(const fs::path& path) {
  OpenFile file(path, O_WRONLY | O_CREAT);
  file.write(std::as_bytes(std::span("x", 1)));
  file.sync();
  file.close();
}

TEST_F(OpenFileTest, WhatASignalInterruptsIsDoneAgain) {
  for (const char* name : {"open", "fsync", "close"}) {
    SystemCalls calls;
    calls.fail_next(name, EINTR, name == std::string("close") ? 1 : 3);
    EXPECT_NO_THROW(write_x(path)) << name;
    EXPECT_EQ(read_text_file(path), "x");
  }
}

// Linux has closed the file then; its number may be that of another already.
TEST_F(OpenFileTest, AnInterruptedCloseIsNotMadeTwice) {
  SystemCalls calls;
  OpenFile file(path, O_WRONLY | O_CREAT);
  calls.fail_next("close", EINTR, 1);
  file.close();
  const auto made = calls.made();
  EXPECT_EQ(std::count(made.begin(), made.end(), "close"), 1);
}

TEST_F(OpenFileTest, AFailingDiskIsNoWrongInput) {
  write_x(path);
  for (const int error : {EIO, EMFILE, ENOMEM, ESTALE}) {
    SystemCalls calls;
    calls.fail_next("open", error, 1);
    EXPECT_THROW(read_text_file(path), FileError) << error;
    calls.fail_next("open", error, 1);
    EXPECT_THROW(ConfigDocument::read(path), FileError) << error;
  }
  for (const int error : {ENOENT, EACCES, ENAMETOOLONG}) {
    SystemCalls calls;
    calls.fail_next("open", error, 1);
    EXPECT_THROW(read_text_file(path), std::invalid_argument) << error;
    calls.fail_next("open", error, 1);
    EXPECT_THROW(ConfigDocument::read(path), std::invalid_argument) << error;
  }
}

}  // namespace
}  // namespace beamgyro::internal::open_file_test
