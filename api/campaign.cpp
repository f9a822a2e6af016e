// SPDX-License-Identifier: MIT
#include "include/beamgyro/campaign.h"

#include <fmt/format.h>

#include <sstream>
#include <stdexcept>
#include <utility>

#include "api/shared_maker.h"
#include "sim/campaign/campaign.h"

namespace beamgyro {
namespace {

std::optional<long> as_long(std::optional<std::uint32_t> number) {
  return number ? std::optional<long>(*number) : std::nullopt;
}

Campaign campaign_of(internal::CampaignPlan campaign) {
  return internal::SharedMaker::make<Campaign>(
      std::make_shared<const internal::CampaignPlan>(std::move(campaign)));
}

}  // namespace

Campaign Campaign::read(const std::filesystem::path& file,
                        std::optional<std::uint32_t> devices) {
  return campaign_of(internal::CampaignPlan::read(file, as_long(devices)));
}

Campaign Campaign::parse(const std::vector<InputFile>& files,
                         std::optional<std::uint32_t> devices) {
  if (files.empty())
    throw std::invalid_argument("no files; expected those of a campaign");
  return campaign_of(
      internal::CampaignPlan::of_copies(files, as_long(devices)));
}

std::string Campaign::name() const { return content().name; }
std::string Campaign::text() const { return content().text; }

std::vector<InputFile> Campaign::files() const { return content().sources; }

std::uint32_t Campaign::devices() const { return content().devices; }
std::uint64_t Campaign::seed() const { return content().source.seed; }

std::vector<std::string> Campaign::runs() const {
  std::vector<std::string> names;
  for (const internal::CampaignRun& run : content().runs)
    names.push_back(run.name);
  return names;
}

std::vector<std::string> Campaign::device_overrides(
    std::uint32_t number) const {
  if (number >= devices())
    throw std::invalid_argument(
        fmt::format("{}: has no device {}; expected a number from 0 to {}",
                    name(), number, devices() - 1));
  const internal::VirtualDevice drawn = content().device(number);
  if (!drawn.device)
    throw std::runtime_error(
        fmt::format("{}: device {}: {}", name(), number, drawn.failure));
  std::vector<std::string> lines;
  std::istringstream text(drawn.overrides);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

Device Campaign::device(std::uint32_t number) const {
  return Device::parse(content().device_document->text(),
                       fmt::format("{}, device {}", name(), number),
                       device_overrides(number));
}

}  // namespace beamgyro
