// SPDX-License-Identifier: MIT
#include "cli/validate_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <string>
#include <system_error>

#include "cli/inputs.h"
#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kNotWritten = 1;

// What an option asks for.
struct AskedOutput {
  const char* option;
  std::string name;
  fs::path place;  // absolute, with links followed as far as it is there
};

fs::path place_of(const fs::path& path) {
  std::error_code error;
  fs::path place = fs::weakly_canonical(fs::absolute(path), error);
  if (error) place = fs::absolute(path).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

// Whether a path is the other one or below it.
bool is_within(const fs::path& path, const fs::path& other) {
  return std::mismatch(path.begin(), path.end(), other.begin(), other.end())
             .second == other.end();
}

void require_places_of_their_own(const ValidateArguments& arguments) {
  std::vector<AskedOutput> asked;
  for (const auto& [option, name] : {std::pair("--json", arguments.json),
                                     std::pair("--report", arguments.report),
                                     std::pair("--figures", arguments.figures),
                                     std::pair("--bundle", arguments.bundle)})
    if (!name.empty()) asked.push_back({option, name, place_of(name)});
  for (const AskedOutput& one : asked)
    for (const AskedOutput& other : asked)
      if (&one != &other && is_within(one.place, other.place))
        throw std::invalid_argument(fmt::format(
            "{} {}: is {} {} {}; expected a place of its own", one.option,
            one.name, one.place == other.place ? "the same as" : "inside",
            other.option, other.name));
}

// Does one thing. Returns whether it succeeded, or else prints what failed.
bool succeeds(const std::function<void()>& work) try {
  work();
  return true;
} catch (const std::exception& error) {
  print_error(error.what());
  return false;
}

}  // namespace

void require_outputs_of(const ValidateArguments& arguments,
                        const std::vector<fs::path>& inputs) {
  require_places_of_their_own(arguments);
  if (!arguments.report.empty())
    require_output_directory("--report", arguments.report, "index.html",
                             inputs);
  if (!arguments.figures.empty())
    require_output_directory("--figures", arguments.figures, "result.json",
                             inputs);
  if (!arguments.bundle.empty())
    require_output_directory("--bundle", arguments.bundle, "bundle.json",
                             inputs);
  if (arguments.json.empty()) return;
  require_output(arguments.json, inputs);
  require_json_name(arguments.json);
}

int deliver(std::string_view result,
            const std::vector<std::function<void()>>& files, int status) {
  bool all = succeeds([&] { print_result(result); });
  for (const std::function<void()>& file : files) all = succeeds(file) && all;
  return all ? status : kNotWritten;
}

}  // namespace beamgyro::internal
