// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "cli/inputs.h"
#include "cli/progress.h"
#include "cli/terminal.h"
#include "cli/validate.h"
#include "cli/version.h"
#include "config/file_error.h"
#include "dataset/files/atomic_file.h"
#include "parallel/work_queue.h"
#include "report/verdict_report.h"
#include "validation/page/figures.h"
#include "validation/page/page.h"
#include "validation/result/device_validation.h"
#include "validation/result/result_json.h"

namespace beamgyro {
namespace {

namespace fs = std::filesystem;

// Returns the qualification that is shipped with this program: in its source
// tree or where it was installed.
fs::path shipped_qualification() {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
  for (const char* place : {"../../scenarios", "../share/beamgyro/scenarios"}) {
    const fs::path file =
        (program / place / "qualification.toml").lexically_normal();
    if (fs::exists(status_of(file))) return file;
  }
  throw std::invalid_argument(fmt::format(
      "--qualification is missing, and {} has no scenarios beside it; expected "
      "--qualification QUALIFICATION.toml",
      program.string()));
}

void require_campaign(const ValidateArguments& arguments) {
  if (arguments.devices && !arguments.campaign)
    throw std::invalid_argument(
        "--devices needs --campaign CAMPAIGN.toml, from which they are drawn");
}

ValidationRequest request_of(const ValidateArguments& arguments) {
  ValidationRequest request{.compensator = arguments.compensator,
                            .device = arguments.device.at(0),
                            .qualification = {},
                            .devices = arguments.devices,
                            .program_version = kProgramVersion,
                            .git_revision = kGitRevision,
                            .limits = {.program = "/proc/self/exe"}};
  request.qualification = arguments.qualification
                              ? fs::path(*arguments.qualification)
                              : shipped_qualification();
  if (arguments.specification) request.specification = *arguments.specification;
  if (arguments.campaign) request.campaign = *arguments.campaign;
  return request;
}

// Returns what --json writes and the page shows.
nlohmann::ordered_json json_of(const DeviceValidation& validation) {
  nlohmann::ordered_json json = to_json(validation.result);
  json["figures"] =
      figures_of(validation.evidence.before, validation.evidence.after);
  if (!validation.result.population) return json;
  for (const PopulationMetric& metric : validation.result.population->metrics)
    json["figures"].push_back(population_figure(
        {std::string(metric.metric->name), std::string(metric.metric->unit),
         metric.before, metric.after}));
  return json;
}

}  // namespace

int validate_on_device(const ValidateArguments& arguments) {
  require_campaign(arguments);
  const DeviceValidator validator(request_of(arguments));
  const fs::path page = fs::path(arguments.report) / "index.html";
  if (!arguments.json.empty())
    require_output(arguments.json, validator.files());
  if (!arguments.report.empty()) {
    require_directory_name(arguments.report);
    fs::create_directories(arguments.report);
    require_output(page, validator.files());
  }
  std::optional<Progress> progress("validating " + arguments.compensator);
  const DeviceValidation validation = validator.validate(
      thread_count(static_cast<unsigned>(arguments.jobs.value_or(0))),
      [&](double share) { progress->set_share(share); });
  const nlohmann::ordered_json json = json_of(validation);
  if (!arguments.json.empty())
    write_text_file(arguments.json, json.dump(2) + "\n");
  if (!arguments.report.empty()) write_text_file(page, page_of(json));
  progress.reset();
  for (const std::string& warning : validation.result.warnings)
    print_warning(warning);
  print_result(verdict_report(validation.result));
  return validation.result.verdict == Conformity::kPass ? 0 : kNotPassed;
}

}  // namespace beamgyro
