// SPDX-License-Identifier: MIT
#include "validation/specification/limit.h"

#include <fmt/core.h>

namespace beamgyro::internal {

bool Limit::contains(double value) const {
  return (!least || value >= *least) && (!most || value <= *most);
}

std::string text_of(const Limit& limit) {
  std::string text;
  if (limit.least && limit.most)
    text = fmt::format("{:g} to {:g}", *limit.least, *limit.most);
  else if (limit.most)
    text = fmt::format("at most {:g}", *limit.most);
  else if (limit.least)
    text = fmt::format("at least {:g}", *limit.least);
  if (limit.absolute) text += " without its sign";
  if (limit.relative_to == "before")
    text += " times the recorded rate's";
  else if (!limit.relative_to.empty())
    text += fmt::format(" times the {}'s", limit.relative_to);
  return text;
}

}  // namespace beamgyro::internal
