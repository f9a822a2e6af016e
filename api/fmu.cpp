// SPDX-License-Identifier: MIT
#include "include/beamgyro/fmu.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "api/model_description.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/text_file.h"
#include "dataset/files/zip_archive.h"
#include "sim/stepper/gyro_stepper.h"

namespace beamgyro {
namespace {

// What cannot be stepped is refused here, not by a master.
void require_steps(const Device& device, const internal::PackedDevice& packed) {
  try {
    static_cast<void>(internal::GyroStepper(
        internal::stepper_model(internal::make_gyro(packed.parameters())),
        {.fidelity = packed.fidelity()}));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("{}: {}", device.name(), error.what()));
  }
}

}  // namespace

std::string fmu_of(const Device& device, const FmuOptions& options) {
  if (options.fmi != 2 && options.fmi != 3)
    throw std::invalid_argument(
        fmt::format("fmi is {}; expected 2 or 3", options.fmi));
  const internal::FmiVersion version{options.fmi};
  const std::string overrides =
      fmt::format("{}", fmt::join(device.overrides(), "\n"));
  const internal::PackedDevice packed(device.text(), overrides,
                                      options.fidelity);
  require_steps(device, packed);
  const std::string name = std::filesystem::path(device.name()).stem().string();
  const char* const platform =
      version == internal::FmiVersion::k2 ? "linux64" : "x86_64-linux";
  return internal::zip_archive(
      {{"modelDescription.xml",
        internal::model_description(packed, version, name)},
       {fmt::format("binaries/{}/{}.so", platform, internal::kFmuIdentifier),
        internal::read_text_file(options.binary)},
       {fmt::format("resources/{}", internal::kPackedDevice), device.text()},
       {fmt::format("resources/{}", internal::kPackedOverrides), overrides},
       {fmt::format("resources/{}", internal::kPackedFidelity),
        options.fidelity}});
}

void write_fmu(const Device& device, const std::filesystem::path& file,
               const FmuOptions& options) {
  internal::write_text_file(file, fmu_of(device, options));
}

}  // namespace beamgyro
