// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "include/beamgyro/campaign.h"
#include "sim/campaign/campaign.h"

namespace beamgyro {

struct Campaign::State {
  explicit State(internal::CampaignPlan read) : campaign(std::move(read)) {}

  internal::CampaignPlan campaign;
};

}  // namespace beamgyro
