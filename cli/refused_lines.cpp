// SPDX-License-Identifier: MIT
#include "cli/refused_lines.h"

#include <fmt/format.h>

#include "cli/terminal.h"

namespace beamgyro::internal {
namespace {

// As the summary names them, in the order of LineFault.
constexpr std::array<const char*, static_cast<std::size_t>(LineFault::kCount)>
    kFaultWords = {"with another number of cells than names",
                   "with a cell that is no number of its column",
                   "with a value that is not finite or out of range",
                   "with a time that does not rise",
                   "too long",
                   "cut off"};

}  // namespace

void RefusedLines::add(const BadLine& bad) {
  ++lines_;
  ++refused_;
  if (++counts_[static_cast<std::size_t>(bad.fault())] == 1)
    print_warning(fmt::format(
        "{}; it is answered nan, and so are others of this kind", bad.what()));
}

void RefusedLines::print_summary() const {
  if (refused_ == 0) return;
  std::string kinds;
  for (std::size_t k = 0; k < counts_.size(); ++k)
    if (counts_[k] > 0)
      kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", counts_[k],
                           kFaultWords[k]);
  print_warning(fmt::format("{} of {} samples are answered nan: {}", refused_,
                            lines_, kinds));
}

}  // namespace beamgyro::internal
