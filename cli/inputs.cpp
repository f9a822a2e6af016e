// SPDX-License-Identifier: MIT
#include "cli/inputs.h"

#include <fmt/format.h>

#include <stdexcept>

#include "config/document.h"
#include "dataset/atomic_file.h"
#include "sim/device/device_file.h"
#include "sim/scenario/scenario_file.h"

namespace beamgyro {

void require_recording_name(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension != ".h5" && extension != ".csv") {
    throw std::invalid_argument(
        fmt::format("-o {}: unknown kind of file \"{}\"; expected a name that "
                    "ends in .h5 or .csv",
                    path.string(), extension));
  }
}

void require_output(const std::filesystem::path& output,
                    const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code ignored;
    const bool is_of_set =
        std::filesystem::is_directory(input, ignored) &&
        std::filesystem::exists(output, ignored) &&
        std::filesystem::equivalent(
            std::filesystem::absolute(output).parent_path(), input, ignored);
    if (is_of_set || std::filesystem::equivalent(output, input, ignored)) {
      throw std::invalid_argument(
          fmt::format("{}: is read by this command; expected another name for "
                      "what it writes",
                      output.string()));
    }
  }
  require_writable(output);
}

LoadedDevice load_device(const std::filesystem::path& path,
                         const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(path, set);
  LoadedDevice loaded{read_device(document), document.text()};
  document.reject_unknown_keys();
  set.check_all_used();
  return loaded;
}

LoadedScenario load_scenario(const std::filesystem::path& path,
                             const std::vector<std::string>& overrides) {
  Overrides set(overrides);
  const ConfigDocument document = ConfigDocument::read(path, set);
  const Scenario scenario = read_scenario(document);
  document.reject_unknown_keys();
  const ConfigDocument unit = ConfigDocument::read(scenario.device_file, set);
  const Device device = read_device(unit);
  unit.reject_unknown_keys();
  set.check_all_used();
  return {scenario, device, document.text(), unit.text(), set.text()};
}

}  // namespace beamgyro
