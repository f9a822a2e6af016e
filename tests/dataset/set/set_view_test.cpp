// SPDX-License-Identifier: MIT
#include "dataset/set/set_view.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/set/set_writer.h"
#include "dataset/set/shard/shard_reader.h"
#include "tests/config/rejection.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_view_test {
namespace {

namespace fs = std::filesystem;

using SetView = DirectoryFixture;

TEST_F(SetView, IsTheSameEveryTimeAndNoFileOfTheSet) {
  const Manifest manifest = write_sample_set(directory);
  const std::string before = read_text_file(directory / "warm_up.nc");
  ShardHead head = ShardFile(directory / "warm_up_00001.h5").head();
  std::vector<ManifestEntry> entries;
  for (const ManifestEntry& entry : manifest.entries) {
    if (entry.file.starts_with("warm_up")) entries.push_back(entry);
  }
  const ManifestView view = write_view(directory, head, entries);
  EXPECT_EQ(view, manifest.views[1]);
  EXPECT_EQ(read_text_file(directory / "warm_up.nc"), before);
  EXPECT_EQ(rejection([&] { ShardFile{directory / "warm_up.nc"}; }),
            (directory / "warm_up.nc").string() +
                ": beam_length_m is a view of other files, which does not tell "
                "missing files from missing values; expected the values");
}

class ViewCheck : public DirectoryFixture {
 protected:
  std::vector<ManifestEntry> entries_of(const std::string& run) const {
    std::vector<ManifestEntry> entries;
    for (const ManifestEntry& entry : manifest.entries) {
      if (entry.file.starts_with(run)) entries.push_back(entry);
    }
    return entries;
  }

  /// Publishes a view of `run` made of another head than its files have, and
  /// the manifest with it, as a failed read once did.
  void publish_view(const std::string& run, const ShardHead& head) {
    for (ManifestView& view : manifest.views) {
      if (view.file == view_name(run))
        view = write_view(directory, head, entries_of(run));
    }
    write_manifest(directory, kManifestName, manifest);
  }

  std::vector<FileDefect> defects() const {
    const Manifest read = read_manifest(directory, kManifestName);
    const std::vector<FileDefect> known = check_set(directory, read);
    std::vector<FileDefect> found = check_views(directory, read, known);
    found.insert(found.end(), known.begin(), known.end());
    return found;
  }

  Manifest manifest = write_sample_set(directory);
};

TEST_F(ViewCheck, FindsNothingWhereViewsShowTheirFiles) {
  EXPECT_TRUE(defects().empty());
}

TEST_F(ViewCheck, FindsAViewWithoutTheTexts) {
  ShardHead head = ShardFile(directory / "rest_00000.h5").head();
  head.scenario_text.clear();
  head.campaign_text.clear();
  publish_view("rest", head);
  const std::vector<FileDefect> found = defects();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].file, "rest.nc");
  EXPECT_EQ(found[0].what, "is not the view of its files");
}

TEST_F(ViewCheck, FindsAViewWithoutAVariableOrAFile) {
  ShardHead head = ShardFile(directory / "warm_up_00000.h5").head();
  head.variables.pop_back();
  publish_view("warm_up", head);
  EXPECT_EQ(defects().size(), 1u);
  head = ShardFile(directory / "warm_up_00000.h5").head();
  publish_view("warm_up", head);
  EXPECT_TRUE(defects().empty());
  const std::vector<ManifestEntry> entries = entries_of("warm_up");
  manifest.views[1] =
      write_view(directory, head, std::span(entries).first(entries.size() - 1));
  write_manifest(directory, kManifestName, manifest);
  EXPECT_EQ(defects().size(), 1u);
}

TEST_F(ViewCheck, ADamagedFileLeavesItsViewOut) {
  write_text_file(directory / "rest_00000.h5", "nothing");
  const std::vector<FileDefect> found = defects();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].file, "rest_00000.h5");
}

TEST_F(ViewCheck, GoingOnWithASetMendsItsViews) {
  const std::string view = read_text_file(directory / "rest.nc");
  const std::string text = read_text_file(directory / kManifestName);
  ShardHead head = ShardFile(directory / "rest_00000.h5").head();
  head.scenario_text.clear();
  publish_view("rest", head);
  ASSERT_NE(read_text_file(directory / "rest.nc"), view);
  SetWriter set(directory, *manifest.head, {}, {}, true);
  ASSERT_TRUE(set.lacking().empty());
  EXPECT_TRUE(set.finish().is_merged);
  EXPECT_EQ(read_text_file(directory / "rest.nc"), view);
  EXPECT_EQ(read_text_file(directory / kManifestName), text);
}

TEST_F(ViewCheck, GoingOnWithASetThatLostAViewMakesIt) {
  const std::string view = read_text_file(directory / "rest.nc");
  fs::remove(directory / "rest.nc");
  SetWriter set(directory, *manifest.head, {}, {}, true);
  EXPECT_TRUE(set.finish().is_merged);
  EXPECT_EQ(read_text_file(directory / "rest.nc"), view);
}

}  // namespace
}  // namespace beamgyro::internal::set_view_test
