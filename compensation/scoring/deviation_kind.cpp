// SPDX-License-Identifier: MIT
#include "compensation/scoring/deviation_kind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace beamgyro::internal {

const std::vector<std::string>& deviation_names() {
  static const std::vector<std::string> names{"adev", "oadev", "mdev",
                                              "hdev", "ohdev", "totdev"};
  return names;
}

DeviationKind deviation_kind(std::string_view name) {
  const auto& names = deviation_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw std::invalid_argument(
        fmt::format("deviation \"{}\": not known; expected {}", name,
                    fmt::join(names, ", ")));
  return static_cast<DeviationKind>(found - names.begin());
}

std::string name_of(DeviationKind kind) {
  return deviation_names()[static_cast<std::size_t>(kind)];
}

int order_of(DeviationKind kind) {
  return kind == DeviationKind::kHdev || kind == DeviationKind::kOhdev ? 3 : 2;
}

}  // namespace beamgyro::internal
