// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/netcdf/hdf5_write.h"
#include "tests/dataset/netcdf/changed_hdf5.h"

namespace beamgyro::internal::hdf5_hostile_test {
namespace {

namespace fs = std::filesystem;

/// Changes that somebody made in order to do harm.
using HostileHdf5 = ChangedHdf5;

/// /rate anew, of `type` and `length`, with `properties`.
H5Id make_rate(hid_t file, hid_t type, hsize_t length, hid_t properties) {
  H5Ldelete(file, "rate", H5P_DEFAULT);
  return make_variable(file, {"rate", "degree/s", "rate"}, type,
                       space_of(std::array{length}), properties, {});
}

void write_zeros(hid_t rate, hsize_t length) {
  const std::vector<double> zeros(length);
  EXPECT_GE(H5Dwrite(rate, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                     zeros.data()),
            0);
}

H5Id chunked(hsize_t chunk) {
  H5Id properties = property_list(H5P_DATASET_CREATE);
  H5Pset_chunk(properties, 1, &chunk);
  return properties;
}

H5Id text_of_variable_length() {
  H5Id type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type");
  H5Tset_size(type, H5T_VARIABLE);
  return type;
}

long peak_memory() {  // [KiB]
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

TEST_F(HostileHdf5, AFileThatAnotherProgramChangedIsRead) {
  change([](hid_t) {});
  EXPECT_EQ(read_recording(file).columns.size(), 16u);
}

TEST_F(HostileHdf5, ShuffleDeflateAndFletcherAreRead) {
  change([](hid_t id) {
    const H5Id properties = chunked(7);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 9);
    H5Pset_fletcher32(properties);
    const H5Id rate = make_rate(id, H5T_IEEE_F32BE, kSamples, properties);
    write_zeros(rate, kSamples);
  });
  const Recording recording = read_recording(file);
  EXPECT_EQ(column_values(recording, "rate"), std::vector<double>(kSamples));
}

TEST_F(HostileHdf5, LinksAreNotFollowed) {
  const fs::path other = directory / "other.h5";
  fs::copy_file(file, other);
  EXPECT_EQ(rejected([&](hid_t id) {
              H5Ldelete(id, "rate", H5P_DEFAULT);
              H5Lcreate_external(other.c_str(), "/rate", id, "rate",
                                 H5P_DEFAULT, H5P_DEFAULT);
            }),
            "rate is a link to another place; expected the variable itself");
  EXPECT_EQ(rejected([](hid_t id) {
              H5Ldelete(id, "rate", H5P_DEFAULT);
              H5Lcreate_soft("/output", id, "rate", H5P_DEFAULT, H5P_DEFAULT);
            }),
            "rate is a link to another place; expected the variable itself");
  EXPECT_EQ(rejected([&](hid_t id) {
              H5Ldelete(id, "rate", H5P_DEFAULT);
              H5Ldelete(id, "meta/device", H5P_DEFAULT);
              H5Lcreate_external(other.c_str(), "/meta/device", id,
                                 "meta/device", H5P_DEFAULT, H5P_DEFAULT);
            }),
            "meta/device is a link to another place; expected the variable "
            "itself");
}

TEST_F(HostileHdf5, AVariableOfSeveralNamesIsNotRead) {
  EXPECT_EQ(rejected([](hid_t id) {
              H5Lcreate_hard(id, "rate", id, "again", H5P_DEFAULT, H5P_DEFAULT);
            }),
            "rate is a variable of 2 names; expected one");
}

TEST_F(HostileHdf5, AMetaThatIsALinkIsNotFollowed) {
  const fs::path other = directory / "other.h5";
  fs::copy_file(file, other);
  EXPECT_EQ(rejected([&](hid_t id) {
              H5Ldelete(id, "meta", H5P_DEFAULT);
              H5Lcreate_external(other.c_str(), "/meta", id, "meta",
                                 H5P_DEFAULT, H5P_DEFAULT);
            }),
            "meta is a link to another place; expected the group itself");
}

TEST_F(HostileHdf5, ValuesInOtherFilesAreNotRead) {
  const fs::path other = directory / "other.bin";
  write_text_file(other, std::string(kSamples * 8, '\0'));
  EXPECT_EQ(rejected([&](hid_t id) {
              const H5Id properties = property_list(H5P_DATASET_CREATE);
              H5Pset_external(properties, other.c_str(), 0, kSamples * 8);
              make_rate(id, H5T_IEEE_F64LE, kSamples, properties);
            }),
            "the values of rate are in another file; expected them in this");
  change([&](hid_t id) {
    const H5Id properties = property_list(H5P_DATASET_CREATE);
    const H5Id space = space_of(std::array{kSamples});
    H5Pset_virtual(properties, space, "other.h5", "rate", space);
    make_rate(id, H5T_IEEE_F64LE, kSamples, properties);
  });
  EXPECT_TRUE(rejected().starts_with("rate is a view of other files"));
}

TEST_F(HostileHdf5, TextsOfVariableLengthAreNotRead) {
  const char* text = "degree/s";
  const auto set_text = [&](const char* owner, const char* name) {
    change([&](hid_t id) {
      H5Adelete_by_name(id, owner, name, H5P_DEFAULT);
      const H5Id object(H5Oopen(id, owner, H5P_DEFAULT), H5Oclose, "open");
      write_attribute(object, name, text_of_variable_length(), scalar_space(),
                      &text);
    });
  };
  set_text("/rate", "units");
  EXPECT_TRUE(rejected().starts_with(
      "attribute units of rate is text of variable length"));
  set_text("/", "fidelity");
  EXPECT_TRUE(rejected().starts_with(
      "attribute fidelity of the file is text of variable length"));
}

TEST_F(HostileHdf5, AMetaTextOfVariableLengthAsOfVersion1IsNotRead) {
  change([](hid_t id) {
    H5Ldelete(id, "meta/device", H5P_DEFAULT);
    const H5Id type = text_of_variable_length();
    const H5Id text(H5Dcreate2(id, "meta/device", type, scalar_space(),
                               H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                    H5Dclose, "make text");
    const char* value = "text";
    H5Dwrite(text, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value);
  });
  EXPECT_TRUE(
      rejected().starts_with("/meta/device is text of variable length"));
}

/// nccopy gives them fill values, which are such texts, too.
TEST_F(HostileHdf5, AMetaTextOfVariableLengthWithAFillValueIsNotRead) {
  change([](hid_t id) {
    H5Ldelete(id, "meta/device", H5P_DEFAULT);
    const H5Id type = text_of_variable_length();
    const H5Id properties = property_list(H5P_DATASET_CREATE);
    const char* nothing = "";
    H5Pset_fill_value(properties, type, &nothing);
    const H5Id text(H5Dcreate2(id, "meta/device", type, scalar_space(),
                               H5P_DEFAULT, properties, H5P_DEFAULT),
                    H5Dclose, "make text");
    const char* value = "text";
    H5Dwrite(text, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value);
  });
  const std::string message = rejected();
  EXPECT_TRUE(holds(message, "/meta/device is text of variable length"));
  EXPECT_TRUE(holds(message, "nccopy"));
  EXPECT_TRUE(holds(message, "engine=\"netcdf4\""));
}

std::size_t pass(unsigned, std::size_t, const unsigned[], std::size_t bytes,
                 std::size_t*, void**) {
  return bytes;
}

TEST_F(HostileHdf5, FiltersOfOthersAreNotRun) {
  constexpr H5Z_filter_t kForeign = 300;
  const H5Z_class2_t filter = {H5Z_CLASS_T_VERS, kForeign, 1,       1,
                               "foreign",        nullptr,  nullptr, pass};
  ASSERT_GE(H5Zregister(&filter), 0);
  EXPECT_EQ(
      rejected([](hid_t id) {
        const H5Id properties = chunked(kSamples);
        H5Pset_filter(properties, kForeign, H5Z_FLAG_MANDATORY, 0, nullptr);
        const H5Id rate = make_rate(id, H5T_IEEE_F64LE, kSamples, properties);
        write_zeros(rate, kSamples);
      }),
      "rate is stored through filter 300; expected shuffle, deflate and "
      "fletcher32, each once at most");
}

TEST_F(HostileHdf5, PlugInsAreNotLoaded) {
  const QuietHdf5 as_readers_do;
  unsigned state = 1;
  ASSERT_GE(H5PLget_loading_state(&state), 0);
  EXPECT_EQ(state, 0u);
}

TEST_F(HostileHdf5, DeflateWithinDeflateIsNotInflated) {
  change([](hid_t id) {
    static constexpr hsize_t kLong = hsize_t{1} << 19;
    const H5Id properties = chunked(kLong);
    H5Pset_deflate(properties, 9);
    H5Pset_deflate(properties, 9);
    const H5Id rate = make_rate(id, H5T_IEEE_F64LE, kLong, properties);
    write_zeros(rate, kLong);
  });
  EXPECT_TRUE(rejected().starts_with("rate is stored through filter 1;"));
}

TEST_F(HostileHdf5, ClaimsBeyondTheFileTakeNoMemory) {
  const long before = peak_memory();
  // Contiguous, as large as the file system likes, over a short file.
  change([](hid_t id) {
    const H5Id properties = property_list(H5P_DATASET_CREATE);
    H5Pset_alloc_time(properties, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER);
    make_rate(id, H5T_IEEE_F64LE, hsize_t{1} << 30, properties);
  });
  const std::uintmax_t size = fs::file_size(file);
  ASSERT_GT(size, std::uintmax_t{1} << 33);
  EXPECT_TRUE(rejected().starts_with("rate has 1073741824 values"))
      << rejected();
  EXPECT_LT(peak_memory() - before, 100'000);
}

TEST_F(HostileHdf5, ValuesThatInflateToMoreThanAFileMayAskForAreNotRead) {
  const long before = peak_memory();
  static constexpr hsize_t kLong = hsize_t{1} << 28;  // 2 GB of zeros in 2 MB
  change([](hid_t id) {
    const H5Id properties = chunked(hsize_t{1} << 20);
    H5Pset_deflate(properties, 9);
    const H5Id space = space_of(std::array{kLong});
    H5Ldelete(id, "time", H5P_DEFAULT);
    const H5Id time(H5Dcreate2(id, "time", H5T_IEEE_F64LE, space, H5P_DEFAULT,
                               properties, H5P_DEFAULT),
                    H5Dclose, "make time");
    const std::vector<double> zeros(std::size_t{1} << 20);
    const hsize_t count = zeros.size();
    const H5Id memory = space_of(std::array{count});
    hsize_t start = 0;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, nullptr, &count,
                        nullptr);
    H5Dwrite(time, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, zeros.data());
    // All other chunks are copies of what the first was deflated to.
    hsize_t deflated = 0;
    H5Dflush(time);
    ASSERT_GE(H5Dget_chunk_storage_size(time, &start, &deflated), 0);
    std::vector<std::byte> chunk(deflated);
    std::uint32_t skipped_filters = 0;
    ASSERT_GE(H5Dread_chunk(time, H5P_DEFAULT, &start, &skipped_filters,
                            chunk.data()),
              0);
    for (start = count; start < kLong; start += count)
      ASSERT_GE(H5Dwrite_chunk(time, H5P_DEFAULT, skipped_filters, &start,
                               deflated, chunk.data()),
                0);
  });
  ASSERT_LT(fs::file_size(file), 4'000'000u);
  EXPECT_TRUE(
      rejected().starts_with("268435456 samples of 18 variables take "
                             "more than the "))
      << rejected();
  // Far from 2 GB; the address sanitizer holds on to 256 MB of freed memory.
  EXPECT_LT(peak_memory() - before, 400'000);
}

TEST_F(HostileHdf5, ChunksThatAreNotThereAreNoValues) {
  EXPECT_EQ(rejected([](hid_t id) {
              const H5Id properties = chunked(5);
              make_rate(id, H5T_IEEE_F64LE, kSamples, properties);
            }),
            "rate claims 160 bytes of values, and the file has 0 "
            "for them");
}

TEST_F(HostileHdf5, NumbersOfKindsThatNoProcessorHasAreNotConverted) {
  EXPECT_EQ(rejected([](hid_t id) {
              const H5Id type(H5Tcopy(H5T_IEEE_F64LE), H5Tclose, "make a type");
              H5Tset_fields(type, 60, 50, 10, 0, 50);
              H5Tset_precision(type, 61);
              const H5Id rate = make_rate(id, type, kSamples, H5P_DEFAULT);
              write_zeros(rate, kSamples);
            }),
            "rate has another type; expected floating point");
}

}  // namespace
}  // namespace beamgyro::internal::hdf5_hostile_test
