// SPDX-License-Identifier: MIT
#include "include/beamgyro/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "api/beam_temperatures.h"
#include "api/program_version.h"
#include "api/reported_progress.h"
#include "dataset/files/atomic_file.h"
#include "dataset/files/file_ending.h"
#include "dataset/netcdf/curves_file.h"
#include "parallel/work_queue.h"
#include "sim/campaign/campaign.h"
#include "sim/dynamics/characteristic.h"
#include "sim/numerics/simulation_failure.h"

namespace beamgyro {
namespace internal {
namespace {

constexpr std::size_t kMostPoints = 10000000;  // of all devices

/// The curves of one device, or why there are none.
struct DeviceRows {
  std::vector<CharacteristicRow> rows;
  std::string failure;
  CharacteristicLimits limits = {};
};

DeviceRows rows_of(const CampaignPlan& campaign, std::uint32_t number,
                   std::span<const double> temperatures) {
  const VirtualDevice drawn = campaign.device(number);
  if (!drawn.device) return {{}, drawn.failure};
  try {
    std::vector<CharacteristicRow> rows =
        characteristic(make_gyro(*drawn.device), temperatures);
    const CharacteristicLimits limits = limits_met(*drawn.device, rows);
    return {std::move(rows), {}, limits};
  } catch (const SimulationFailure& error) {
    return {{}, error.what()};
  }
}

std::vector<DeviceRows> all_rows(const CampaignPlan& campaign,
                                 std::span<const double> temperatures,
                                 const CurveOptions& options) {
  std::vector<DeviceRows> devices(campaign.devices);
  std::mutex one_at_a_time;
  double done = 0;
  for_each_task(
      devices.size(), thread_count(options.jobs),
      [&](std::size_t k, std::size_t) {
        devices[k] =
            rows_of(campaign, static_cast<std::uint32_t>(k), temperatures);
        const std::lock_guard lock(one_at_a_time);
        report(options.progress, ++done / static_cast<double>(devices.size()));
      });
  return devices;
}

void require_moderate_size(const CampaignPlan& campaign,
                           std::span<const double> temperatures) {
  if (temperatures.size() <= kMostPoints / campaign.devices) return;
  throw std::invalid_argument(fmt::format(
      "{}: {} devices at {} temperatures each; expected at most {} in all",
      campaign.name, campaign.devices, temperatures.size(), kMostPoints));
}

/// Moves the rows of devices that work into columns, and keeps why others do
/// not.
void fill(std::vector<DeviceRows> devices, const std::string& name,
          CampaignCurves& curves) {
  std::size_t failures = 0, not_locked = 0, saturated = 0;
  std::string first_failure;
  for (std::size_t k = 0; k < devices.size(); ++k) {
    if (!devices[k].failure.empty()) {
      if (failures++ == 0)
        first_failure = fmt::format("device {}: {}", k, devices[k].failure);
      continue;
    }
    curves.devices.push_back(static_cast<std::uint32_t>(k));
    not_locked += devices[k].limits.not_locked > 0;
    saturated += devices[k].limits.saturated > 0;
    for (const CharacteristicRow& row : devices[k].rows)
      for (std::size_t i = 0; i < row.size(); ++i)
        curves.columns[i].values.push_back(row[i]);
    devices[k].rows = {};
  }
  if (curves.devices.empty())
    throw std::runtime_error(fmt::format("{}: no device of {} works; {}", name,
                                         devices.size(), first_failure));
  if (failures > 0)
    curves.warnings.push_back(
        fmt::format("{}: {} of {} devices do not work and are left out; {}",
                    name, failures, devices.size(), first_failure));
  if (not_locked > 0)
    curves.warnings.push_back(fmt::format(
        "{}: the drive of {} of {} devices needs more than its voltage limit "
        "at some temperature; the loops do not lock there",
        name, not_locked, devices.size()));
  if (saturated > 0)
    curves.warnings.push_back(fmt::format(
        "{}: the bias of {} of {} devices is beyond the full scale at some "
        "temperature",
        name, saturated, devices.size()));
}

std::string csv_of(const CampaignCurves& curves) {
  std::string csv = "temperature_degC";
  auto out = std::back_inserter(csv);
  for (const std::uint32_t device : curves.devices)
    fmt::format_to(out, ",device_{}_bias_deg_per_s", device);
  csv += '\n';
  const std::size_t count = curves.temperature.size();
  const std::vector<double>& bias = curves.columns.front().values;
  for (std::size_t k = 0; k < count; ++k) {
    fmt::format_to(out, "{}", curves.temperature[k]);
    for (std::size_t i = 0; i < curves.devices.size(); ++i)
      fmt::format_to(out, ",{:.12g}", bias[i * count + k]);
    csv += '\n';
  }
  return csv;
}

CurvesContent content_of(const CampaignCurves& curves,
                         const CampaignPlan& campaign) {
  CurvesContent content{kProgramVersion,
                        kGitRevision,
                        "static",
                        campaign.source.seed,
                        campaign.text,
                        campaign.device_document->text(),
                        {curves.devices.begin(), curves.devices.end()},
                        curves.temperature,
                        {}};
  const auto quantities = characteristic_quantities();
  for (std::size_t i = 0; i < quantities.size(); ++i)
    content.variables.push_back(
        {{std::string(quantities[i].name), std::string(quantities[i].units),
          std::string(quantities[i].long_name), Role::kTruth},
         curves.columns.at(i).values});
  return content;
}

}  // namespace
}  // namespace internal

CampaignCurves characterise(const Campaign& campaign,
                            std::span<const double> temperatures_degC,
                            const CurveOptions& options) {
  const internal::CampaignPlan& plan = campaign.content();
  internal::require_material_temperatures(temperatures_degC);
  internal::require_moderate_size(plan, temperatures_degC);
  CampaignCurves curves;
  curves.temperature.assign(temperatures_degC.begin(), temperatures_degC.end());
  curves.warnings = internal::ceramic_warnings(temperatures_degC, plan.name);
  for (const internal::CharacteristicQuantity& about :
       internal::characteristic_quantities())
    curves.columns.push_back(
        {std::string(about.name), std::string(about.units), {}});
  internal::fill(internal::all_rows(plan, temperatures_degC, options),
                 plan.name, curves);
  curves.csv = internal::csv_of(curves);
  return curves;
}

void write_curves(const CampaignCurves& curves, const Campaign& campaign,
                  const std::filesystem::path& path) {
  if (internal::file_ending(path) == ".csv")
    internal::write_text_file(path, curves.csv);
  else
    internal::write_curves_file(
        path, internal::content_of(curves, campaign.content()));
}

}  // namespace beamgyro
