// SPDX-License-Identifier: MIT
#include "dataset/netcdf/curves_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <system_error>

#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/file_checksum.h"
#include "dataset/netcdf/hdf5_driver.h"
#include "dataset/netcdf/hdf5_id.h"
#include "dataset/netcdf/hdf5_write.h"

namespace beamgyro::internal {
namespace {

/// Bytes of a variable, and where they belong in the file.
struct Piece {
  std::uint64_t place = 0;
  std::span<const std::byte> bytes;
};

/// Makes variables without their values, which stand in one piece each.
class CurvesLayout {
 public:
  explicit CurvesLayout(hid_t file)
      : file_(file), properties_(creation_properties(H5P_DATASET_CREATE)) {
    check_hdf5(H5Pset_alloc_time(properties_, H5D_ALLOC_TIME_EARLY),
               "place values");
    check_hdf5(H5Pset_fill_time(properties_, H5D_FILL_TIME_NEVER),
               "leave values open");
  }

  H5Id make(const VariableAbout& about, hid_t type,
            std::span<const hsize_t> lengths, std::span<const H5Id* const> axes,
            std::span<const std::byte> bytes) {
    H5Id variable =
        make_variable(file_, about, type, space_of(lengths), properties_, axes);
    const haddr_t place = H5Dget_offset(variable);
    check_hdf5(place == HADDR_UNDEF ? -1 : 0, "place " + about.name);
    pieces_.push_back({place, bytes});
    return variable;
  }

  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  hid_t file_;
  H5Id properties_;
  std::vector<Piece> pieces_;
};

std::vector<Piece> make_curve_variables(hid_t file,
                                        const CurvesContent& content) {
  CurvesLayout layout(file);
  const std::array<hsize_t, 2> lengths = {content.devices.size(),
                                          content.temperatures.size()};
  const std::span<const hsize_t> both(lengths);
  H5Id device = layout.make(
      {"device", "1", "number of the device", Role::kTruth}, H5T_STD_I64LE,
      both.first(1), {}, std::as_bytes(std::span(content.devices)));
  H5Id temperature = layout.make(
      {"temperature", "degC", "temperature of the beam", Role::kTruth},
      H5T_IEEE_F64LE, both.last(1), {}, std::as_bytes(content.temperatures));
  const std::array<const H5Id*, 2> axes = {&device, &temperature};
  for (const CurvesVariable& one : content.variables)
    layout
        .make(one.about, H5T_IEEE_F64LE, both, axes, std::as_bytes(one.values))
        .close("write " + one.about.name);
  device.close("write device");
  temperature.close("write temperature");
  return layout.pieces();
}

/// Makes `bytes` an HDF5 file that is complete but for its values. These are
/// written without the library, because HDF5 1.10 is unreliable after one of
/// its own writes has failed (a full disk). Throws Hdf5Error.
std::vector<Piece> make_file(const CurvesContent& content, OpenFile& bytes) {
  const QuietHdf5 quiet;
  H5Id file = create_hdf5_file(bytes);
  write_origin(file, kCurvesFiletype, kCurvesFormatVersion, content);
  std::vector<Piece> pieces = make_curve_variables(file, content);
  const std::array<NamedText, 2> texts = {
      {{"campaign", content.campaign_text}, {"device", content.device_text}}};
  write_meta(file, texts);
  file.close("close the file");
  check_system_calls();
  return pieces;
}

}  // namespace

void write_curves_file(const std::filesystem::path& path,
                       const CurvesContent& content) {
  AtomicFile target(path);
  std::vector<Piece> pieces;
  try {
    pieces = make_file(content, target.file());
  } catch (const Hdf5Error& error) {
    throw std::runtime_error(
        fmt::format("{}: {}", path.string(), error.what()));
  }
  try {
    for (const Piece& piece : pieces)
      target.file().write_at(piece.place, piece.bytes);
    append_checksum(target.file());
  } catch (const std::system_error& error) {
    throw_file_error(path, "cannot write", error.code());
  }
  target.publish();
}

}  // namespace beamgyro::internal
