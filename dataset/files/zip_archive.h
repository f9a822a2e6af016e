// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace beamgyro::internal {

/// A file inside an archive.
struct ZipEntry {
  std::string name;  // with "/" between folders
  std::string bytes;
};

/// Returns the bytes of a zip archive (APPNOTE.TXT of PKWARE, version 2.0) with
/// these files in their order, deflated where that makes them smaller. There
/// are no clock times in it, so equal files make equal bytes. Throws
/// std::invalid_argument for more than 65,535 files or 4 GiB.
std::string zip_archive(const std::vector<ZipEntry>& entries);

}  // namespace beamgyro::internal
