// SPDX-License-Identifier: MIT
#include "cli/hidden_process.h"

#include <fcntl.h>
#include <sys/prctl.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <sstream>
#include <string>

#include "dataset/files/open_file.h"
#include "validation/external/compensator_source.h"
#include "validation/external/isolation.h"

namespace beamgyro::internal {
namespace {

// The words were copied when the program began.
void empty_command_line() {
  constexpr int kPlaceOfStart = 48;  // in proc(5), counted from 1
  // The name of the program, which is the second value, may hold spaces.
  std::string facts;
  OpenFile("/proc/self/stat", O_RDONLY)
      .read_pieces([&](std::span<const std::byte> piece) {
        facts.append(reinterpret_cast<const char*>(piece.data()), piece.size());
      });
  std::istringstream values(facts.substr(facts.rfind(')') + 1));
  std::string skipped;
  for (int k = 3; k < kPlaceOfStart; ++k) values >> skipped;
  std::uintptr_t start = 0, end = 0;
  if (values >> start >> end && start != 0 && start < end)
    std::memset(std::bit_cast<void*>(start), 0, end - start);
}

}  // namespace

void hide_from_code(const std::string& compensator,
                    const ProcessLimits& limits) {
  if (!is_program(source_kind(compensator)) ||
      isolation_of_system(limits).holds())
    return;
  empty_command_line();
  ::prctl(PR_SET_DUMPABLE, 0);
}

}  // namespace beamgyro::internal
