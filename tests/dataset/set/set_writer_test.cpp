// SPDX-License-Identifier: MIT
#include "dataset/set/set_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "dataset/files/text_file.h"
#include "dataset/set/set_check.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_writer_test {
namespace {

namespace fs = std::filesystem;

// A set of six files made again in another directory.
class WriteSet : public DirectoryFixture {
 protected:
  void SetUp() override {
    fs::create_directory(original_);
    manifest_ = write_sample_set(original_);
    for (const SourceEntry& source : manifest_.head->sources)
      sources_.push_back(
          {original_ / source.file, read_text_file(original_ / source.file)});
    head_ = *manifest_.head;
    head_.sources = source_entries(sources_);
  }
  void add(SetWriter& set, std::uint32_t index) const {
    const std::string text =
        read_text_file(original_ / manifest_.entries[index].file);
    set.add(index, std::as_bytes(std::span(text)),
            manifest_.entries[index].failures);
  }
  SetState make(const SetTask& task, bool resume = false) {
    SetWriter set(copy_, head_, sources_, task, resume);
    for (const std::uint32_t index : set.lacking()) add(set, index);
    return set.finish();
  }
  std::map<std::string, std::string> published() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(copy_)) {
      if (entry.is_regular_file())
        files[entry.path().lexically_relative(copy_).string()] =
            read_text_file(entry.path());
    }
    return files;
  }
  bool is_whole() const {
    return check_set(copy_, read_manifest(copy_, kManifestName)).empty();
  }

  const fs::path original_ = directory / "original";
  const fs::path copy_ = directory / "copy";
  Manifest manifest_;
  ManifestHead head_;
  std::vector<SourceText> sources_;
};

TEST_F(WriteSet, TasksInAnyOrderMakeTheSameDirectoryAsAWholeRun) {
  EXPECT_TRUE(make({}).is_merged);
  EXPECT_TRUE(is_whole());
  const auto expected = published();
  fs::remove_all(copy_);
  EXPECT_FALSE(make({3, 4}).is_whole());
  EXPECT_EQ(lacking_tasks(copy_, head_, 4), "1-2,4");
  make({1, 4});
  make({4, 4});
  EXPECT_TRUE(make({2, 4}).is_merged);
  EXPECT_EQ(published(), expected);
  EXPECT_EQ(lacking_tasks(copy_, head_, 4), "");
}

TEST_F(WriteSet, AWholeRunTakesOverWhatTasksHaveMade) {
  make({2, 3});
  EXPECT_THROW(make({}), std::invalid_argument);
  SetWriter set(copy_, head_, sources_, {}, true);
  EXPECT_EQ(set.lacking(), (std::vector<std::uint32_t>{0, 2, 3, 5}));
}

TEST_F(WriteSet, AFileLostFromAMergedSetIsMadeAgain) {
  make({});
  const auto expected = published();
  fs::remove(copy_ / manifest_.entries[4].file);
  EXPECT_EQ(lacking_tasks(copy_, head_, 2), "1");
  {
    SetWriter set(copy_, head_, sources_, {}, true);
    EXPECT_EQ(set.lacking(), std::vector<std::uint32_t>{4});
    // Nothing but that file is lost if this process dies now.
    EXPECT_EQ(set_contents(copy_).state.entries.size(), 5u);
    add(set, 4);
    set.finish();
  }
  EXPECT_EQ(published(), expected);
}

TEST_F(WriteSet, ALineCutShortCostsItsFileOnly) {
  {
    SetWriter set(copy_, head_, sources_, {}, false);
    add(set, 0);
    add(set, 1);
  }
  const fs::path manifest = copy_ / kManifestName;
  fs::resize_file(manifest, fs::file_size(manifest) - 5);
  SetWriter set(copy_, head_, sources_, {}, true);
  EXPECT_EQ(set.lacking(), (std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
}

TEST_F(WriteSet, AnotherCampaignOrProgramIsRefusedAndLosesNothing) {
  make({1, 2});
  const auto before = published();
  for (const bool program : {false, true}) {
    ManifestHead other = head_;
    if (program) {
      other.git_revision = "other";
    } else {
      other.campaign_sha256.front() = 'x';
    }
    EXPECT_THROW(SetWriter(copy_, other, sources_, {}, true),
                 std::invalid_argument);
    EXPECT_THROW(SetWriter(copy_, other, sources_, {2, 2}, false),
                 std::invalid_argument);
    EXPECT_THROW(lacking_tasks(copy_, other, 2), std::invalid_argument);
  }
  EXPECT_EQ(published(), before);
}

TEST_F(WriteSet, TheSameWorkIsOneProcessOnly) {
  const SetWriter set(copy_, head_, sources_, {1, 2}, false);
  EXPECT_THROW(SetWriter(copy_, head_, sources_, {1, 2}, false),
               std::runtime_error);
  EXPECT_THROW(SetWriter(copy_, head_, sources_, {}, true), std::runtime_error);
  EXPECT_NO_THROW(SetWriter(copy_, head_, sources_, {2, 2}, false));
}

TEST_F(WriteSet, ADirectoryThatWasRefusedIsNotLeftBehind) {
  fs::create_directory(copy_);
  std::ofstream(copy_ / "rest_00000.h5") << "mine";
  EXPECT_THROW(SetWriter(copy_, head_, sources_, {}, false),
               std::invalid_argument);
  EXPECT_EQ(published().size(), 1u);
  EXPECT_THROW(
      SetWriter(directory / "no" / "where", head_, sources_, {}, false),
      std::invalid_argument);
  EXPECT_FALSE(fs::exists(directory / "no"));
}

}  // namespace
}  // namespace beamgyro::internal::set_writer_test
