// SPDX-License-Identifier: MIT
#include "dataset/set/manifest.h"

#include <gtest/gtest.h>

#include "dataset/files/atomic_file.h"
#include "dataset/files/sha256.h"
#include "dataset/files/text_file.h"
#include "tests/config/rejection.h"
#include "tests/dataset/overwrite.h"
#include "tests/dataset/test_directory.h"

namespace beamgyro::internal::manifest_test {
namespace {

class ManifestFile : public DirectoryFixture {
 protected:
  std::filesystem::path file() const { return directory / kManifestName; }
};

ManifestHead sample_manifest_head() {
  ManifestHead head;
  head.campaign = "source/small.toml";
  head.campaign_sha256 = std::string(64, 'a');
  head.program_version = "1.2.3";
  head.seed = 18446744073709551615u;
  head.devices = 5;
  head.devices_per_file = 2;
  head.runs = {"rest", "warm_up"};
  head.sources = {{"source/small.toml", std::string(64, 'a')},
                  {"source/devices/gr\xc3\xbcn.toml", std::string(64, 'b')}};
  return head;
}

ManifestEntry sample_entry(std::uint32_t index) {
  ManifestEntry entry = expected_entry(sample_manifest_head(), index);
  entry.bytes = 5000000000u + index;
  entry.sha256 = std::string(64, 'c');
  if (index == 2) entry.failures = {{3, "beam.length_m: \"too\" long\n"}};
  return entry;
}

Manifest sample_manifest() {
  Manifest manifest;
  manifest.head = sample_manifest_head();
  for (std::uint32_t i = 0; i < 6; ++i)
    manifest.entries.push_back(sample_entry(i));
  return manifest;
}

TEST_F(ManifestFile, FilesAreNumberedByRangeThenRun) {
  const ManifestHead head = sample_manifest_head();
  ASSERT_EQ(file_count(head), 6u);
  EXPECT_EQ(expected_entry(head, 0).file, "rest_00000.h5");
  EXPECT_EQ(expected_entry(head, 3).file, "warm_up_00001.h5");
  EXPECT_EQ(expected_entry(head, 3).first_device, 2u);
  EXPECT_EQ(expected_entry(head, 3).devices, 2u);
  EXPECT_EQ(expected_entry(head, 4).first_device, 4u);
  EXPECT_EQ(expected_entry(head, 4).devices, 1u);
}

TEST_F(ManifestFile, GivesBackWhatWasAppended) {
  start_manifest(directory, kManifestName, sample_manifest_head());
  append_entry(directory, kManifestName, sample_entry(2));
  append_entry(directory, kManifestName, sample_entry(0));
  const Manifest found = read_manifest(directory, kManifestName);
  EXPECT_EQ(found.head, sample_manifest_head());
  EXPECT_EQ(found.entries,
            (std::vector<ManifestEntry>{sample_entry(0), sample_entry(2)}));
  EXPECT_FALSE(found.is_finished);
  EXPECT_TRUE(found.damaged_lines.empty());
}

TEST_F(ManifestFile, ALineCutShortCountsAsNotThereWhereverItIsCut) {
  start_manifest(directory, kManifestName, sample_manifest_head());
  append_entry(directory, kManifestName, sample_entry(0));
  const std::string before = read_text_file(file());
  append_entry(directory, kManifestName, sample_entry(1));
  const std::string after = read_text_file(file());
  for (std::size_t size = before.size(); size < after.size() - 1; size += 9) {
    write_text_file(file(), after.substr(0, size));
    const Manifest torn = read_manifest(directory, kManifestName);
    ASSERT_EQ(torn.entries, std::vector<ManifestEntry>{sample_entry(0)})
        << size;
    ASSERT_TRUE(torn.damaged_lines.empty()) << size;
    append_entry(directory, kManifestName, sample_entry(3));
    ASSERT_EQ(read_manifest(directory, kManifestName).entries,
              (std::vector<ManifestEntry>{sample_entry(0), sample_entry(3)}))
        << size;
  }
}

TEST_F(ManifestFile, OfTwoLinesForOneFileTheLaterCounts) {
  start_manifest(directory, kManifestName, sample_manifest_head());
  append_entry(directory, kManifestName, sample_entry(1));
  ManifestEntry again = sample_entry(1);
  again.sha256 = std::string(64, 'd');
  append_entry(directory, kManifestName, again);
  EXPECT_EQ(read_manifest(directory, kManifestName).entries,
            std::vector<ManifestEntry>{again});
}

TEST_F(ManifestFile, TheFinishedOneIsSortedAndDoesNotDependOnTheOrder) {
  Manifest manifest;
  manifest.head = sample_manifest_head();
  for (std::uint32_t i = 6; i-- > 0;)
    manifest.entries.push_back(sample_entry(i));
  manifest.views = {{"warm_up.nc", 20, "e"}, {"rest.nc", 10, "f"}};
  write_manifest(directory, kManifestName, manifest);
  const std::string text = read_text_file(file());
  const Manifest found = read_manifest(directory, kManifestName);
  EXPECT_TRUE(found.is_finished);
  EXPECT_EQ(found.entries.size(), 6u);
  EXPECT_EQ(found.entries[2], sample_entry(2));
  EXPECT_EQ(found.views[0].file, "rest.nc");
  write_manifest(directory, kManifestName, found);
  EXPECT_EQ(read_manifest(directory, kManifestName).entries, found.entries);
  EXPECT_EQ(read_text_file(file()), text);
}

TEST_F(ManifestFile, EveryFlippedBitIsFoundAndCostsAtMostTwoLines) {
  const Manifest manifest = sample_manifest();
  write_manifest(directory, kManifestName, manifest);
  const std::string text = read_text_file(file());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char flipped = static_cast<char>(text[i] ^ (1 << (i % 8)));
    overwrite(file(), i, {&flipped, 1});
    const Manifest found = read_manifest(directory, kManifestName);
    overwrite(file(), i, {&text[i], 1});
    ASSERT_TRUE(!found.damaged_lines.empty() || !found.is_finished) << i;
    ASSERT_TRUE(found.head == manifest.head) << i;  // it is there twice
    ASSERT_GE(found.entries.size(), 4u) << i;
  }
  EXPECT_TRUE(read_manifest(directory, kManifestName).damaged_lines.empty());
}

TEST_F(ManifestFile, ALineThatIsLostOrMovedIsFound) {
  const Manifest manifest = sample_manifest();
  write_manifest(directory, kManifestName, manifest);
  const std::string text = read_text_file(file());
  const std::size_t second = text.find('\n') + 1;
  const std::size_t third = text.find('\n', second) + 1;
  std::string changed = text;
  changed.erase(second, third - second);
  write_text_file(file(), changed);
  EXPECT_EQ(read_manifest(directory, kManifestName).damaged_lines.size(), 1u);
  changed.insert(0, text.substr(second, third - second));
  write_text_file(file(), changed);
  EXPECT_EQ(read_manifest(directory, kManifestName).damaged_lines.size(), 1u);
}

TEST_F(ManifestFile, NamesThatNoSetHasAreDamage) {
  const auto is_taken = [&](const auto& change) {
    Manifest manifest = sample_manifest();
    change(manifest);
    write_manifest(directory, kManifestName, manifest);
    return read_manifest(directory, kManifestName).damaged_lines.empty();
  };
  EXPECT_TRUE(is_taken([](Manifest&) {}));
  for (const char* name : {"../victim/data", "/etc/passwd", "", "a.b", "Rest",
                           "a/b", "..", ".rest"}) {
    EXPECT_FALSE(is_taken([&](Manifest& m) { m.head->runs[0] = name; }))
        << name;
    EXPECT_FALSE(is_taken([&](Manifest& m) {
      m.entries[0].file = std::string(name) + "_00000.h5";
    })) << name;
    EXPECT_FALSE(is_taken([&](Manifest& m) {
      m.views.push_back({std::string(name) + ".nc", 1, std::string(64, 'a')});
    })) << name;
  }
  for (const char* name : {"rest.h5", "rest_1.h5", "rest_0000a.h5",
                           "rest_00000.h5/", "manifest.jsonl"}) {
    EXPECT_FALSE(is_taken([&](Manifest& m) { m.entries[0].file = name; }))
        << name;
  }
  for (const char* name : {"../a", "/source/a", "source", "source/", "a",
                           "source/../a", "source//a", "source/./a"}) {
    EXPECT_FALSE(is_taken([&](Manifest& m) {
      m.head->sources.push_back({name, std::string(64, 'a')});
    })) << name;
  }
}

// As in a copy of a set made of hard links.
TEST_F(ManifestFile, OneWithAnotherNameIsNotWrittenTo) {
  start_manifest(directory, kManifestName, sample_manifest_head());
  const std::string before = read_text_file(file());
  std::filesystem::create_hard_link(file(), directory / "other");
  EXPECT_THROW(append_entry(directory, kManifestName, sample_entry(0)),
               std::runtime_error);
  EXPECT_EQ(read_text_file(directory / "other"), before);
}

TEST_F(ManifestFile, ALinkIsNotFollowed) {
  start_manifest(directory, "manifest.1-of-2.jsonl", sample_manifest_head());
  const std::filesystem::path other = directory / "manifest.1-of-2.jsonl";
  const std::string before = read_text_file(other);
  std::filesystem::create_symlink(other, file());
  EXPECT_THROW(append_entry(directory, kManifestName, sample_entry(0)),
               std::invalid_argument);
  EXPECT_THROW(read_manifest(directory, kManifestName), std::invalid_argument);
  EXPECT_EQ(read_text_file(other), before);
}

TEST_F(ManifestFile, AMissingOneIsNamedAndAnythingElseIsDamage) {
  EXPECT_EQ(rejection([&] { read_manifest(directory, kManifestName); }),
            file().string() + ": cannot open: No such file or directory");
  write_text_file(file(), std::string("\0\n\n{}\n[1]\n\xff\xfe", 12));
  const Manifest found = read_manifest(directory, kManifestName);
  EXPECT_EQ(found.damaged_lines, (std::vector<std::size_t>{1, 2, 3, 4}));
  EXPECT_FALSE(found.head.has_value());
  write_text_file(file(), "");
  EXPECT_FALSE(read_manifest(directory, kManifestName).is_finished);
}

/// A line as a manifest has it, of an object without its last brace.
std::string line_of(const std::string& body) {
  return body + ",\"check\":\"" + sha256(body).substr(0, 16) + "\"}\n";
}

TEST_F(ManifestFile, LinesThatNestTooDeepAreDamaged) {
  std::string deep(100000, '[');
  deep += std::string(100000, ']');
  std::string keys;
  for (int i = 0; i < 3000; ++i) keys += ",\"" + std::to_string(i) + "\":1";
  write_text_file(
      file(), line_of("{\"index\":" + deep) + line_of("{\"filetype\":" + deep) +
                  line_of("{\"sha256_before\":{\"a\":" + deep + "}") +
                  line_of("{\"view\":1" + keys));
  EXPECT_EQ(read_manifest(directory, kManifestName).damaged_lines,
            (std::vector<std::size_t>{1, 2, 3, 4}));
}

TEST_F(ManifestFile, AHeadThatDescribesNoSetIsDamaged) {
  const std::string head =
      "{\"filetype\":\"beamgyro-manifest\",\"format_version\":1,"
      "\"campaign\":\"c\",\"campaign_sha256\":\"\","
      "\"beamgyro_version\":\"1\",\"git_revision\":\"1\",\"seed\":1,";
  const std::string source = "[{\"file\":\"source/c\",\"sha256\":\"\"}]";
  const auto text = [&](const std::string& devices, const std::string& per_file,
                        const std::string& runs, const std::string& sources) {
    return line_of(head + "\"devices\":" + devices + ",\"devices_per_file\":" +
                   per_file + ",\"runs\":" + runs + ",\"sources\":" + sources);
  };
  write_text_file(file(), text("5", "2", "[\"rest\"]", source));
  EXPECT_TRUE(read_manifest(directory, kManifestName).head);
  for (const std::string& damaged :
       {text("5", "2", "[\"rest\"]", "[]"), text("5", "2", "[]", source),
        text("0", "2", "[\"rest\"]", source),
        text("5", "0", "[\"rest\"]", source),
        text("5e9", "2", "[\"rest\"]", source),
        text("-5", "2", "[\"rest\"]", source),
        text("5000000000", "2", "[\"rest\"]", source),
        text("4000000000", "1", "[\"rest\",\"ramp\"]", source)}) {
    write_text_file(file(), damaged);
    EXPECT_FALSE(read_manifest(directory, kManifestName).head) << damaged;
    EXPECT_EQ(read_manifest(directory, kManifestName).damaged_lines.size(), 1u)
        << damaged;
  }
}

TEST_F(ManifestFile, KnowsTheNamesOfItsFiles) {
  ManifestHead head = sample_manifest_head();
  for (std::uint32_t i = 0; i < file_count(head); ++i)
    EXPECT_TRUE(is_file_of(head, expected_entry(head, i).file));
  for (const char* name :
       {"rest_00003.h5", "warm_up_00003.h5", "rest_0.h5", "rest_00000.nc",
        "rest_00000", "rest_-0001.h5", "other_00000.h5", "_00000.h5", "",
        "rest_99999999999.h5", "x/rest_00000.h5"})
    EXPECT_FALSE(is_file_of(head, name)) << name;
  head.devices = 4'000'000'000;
  EXPECT_TRUE(is_file_of(head, "warm_up_1999999999.h5"));
  EXPECT_FALSE(is_file_of(head, "warm_up_2000000000.h5"));
}

}  // namespace
}  // namespace beamgyro::internal::manifest_test
