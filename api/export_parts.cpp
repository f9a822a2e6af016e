// SPDX-License-Identifier: MIT
#include "api/export_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace beamgyro::internal {

void require_axes(const std::vector<std::string>& axes) {
  for (const std::string& axis : axes)
    if (axis != "x" && axis != "y" && axis != "z")
      throw std::invalid_argument(
          fmt::format("axis \"{}\"; expected x, y or z", axis));
}

std::vector<char> axes_of(const std::vector<std::string>& given,
                          std::size_t count, const char* what) {
  std::vector<char> axes;
  for (const std::string& axis : given) axes.push_back(axis[0]);
  if (axes.empty() && count == 1) axes = {'z'};
  if (axes.empty() && count == 3) axes = {'x', 'y', 'z'};
  if (axes.size() != count)
    throw option_error("{}: {} axes for {} {}; one each, such as {}",
                       NamedOption{"axes"}, axes.size(), count, what,
                       NamedOption{"axes", "x,y"});
  for (std::size_t k = 1; k < count; ++k)
    if (std::find(axes.begin(), axes.begin() + static_cast<std::ptrdiff_t>(k),
                  axes[k]) != axes.begin() + static_cast<std::ptrdiff_t>(k))
      throw option_error("{}: {} twice; each of the {} has an axis of its own",
                         NamedOption{"axes"}, axes[k], what);
  return axes;
}

}  // namespace beamgyro::internal
