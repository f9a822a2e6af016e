// SPDX-License-Identifier: MIT
#include "compensation/scoring/deviation_kind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace beamgyro::internal {

namespace {

// In the order of DeviationKind.
constexpr std::string_view kDeviationNames[] = {"adev", "oadev", "mdev",
                                                "hdev", "ohdev", "totdev"};

}  // namespace

DeviationKind deviation_kind(std::string_view name) {
  const auto* const found = std::ranges::find(kDeviationNames, name);
  if (found == std::end(kDeviationNames))
    throw std::invalid_argument(
        fmt::format("deviation \"{}\": not known; expected {}", name,
                    fmt::join(kDeviationNames, ", ")));
  return static_cast<DeviationKind>(found - kDeviationNames);
}

std::string name_of(DeviationKind kind) {
  return std::string(kDeviationNames[static_cast<std::size_t>(kind)]);
}

int order_of(DeviationKind kind) {
  return kind == DeviationKind::kHdev || kind == DeviationKind::kOhdev ? 3 : 2;
}

}  // namespace beamgyro::internal
