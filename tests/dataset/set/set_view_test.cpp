// SPDX-License-Identifier: MIT
#include "dataset/set/set_view.h"

#include <gtest/gtest.h>

#include "dataset/files/text_file.h"
#include "dataset/set/shard/shard_reader.h"
#include "tests/config/rejection.h"
#include "tests/dataset/set/sample_set.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::set_view_test {
namespace {

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

}  // namespace
}  // namespace beamgyro::internal::set_view_test
