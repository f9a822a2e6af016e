// SPDX-License-Identifier: MIT
#include "validation/external/error_text.h"

#include <algorithm>
#include <cctype>

namespace beamgyro::internal {
namespace {

constexpr std::size_t kTail = 4096;        // bytes
constexpr std::size_t kLongestLine = 200;  // bytes

}  // namespace

void keep_tail(std::string& text) {
  if (text.size() > 2 * kTail) text.erase(0, text.size() - kTail);
}

std::string last_words(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == text.npos) return "";
  const std::size_t before = text.find_last_of("\r\n", end);
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  return "; it wrote: " +
         text.substr(begin, std::min(end + 1 - begin, kLongestLine));
}

bool tells_of_no_memory(const std::string& text) {
  std::string lower = text;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  for (const char* words :
       {"out of memory", "memoryerror", "bad_alloc", "outofmemory",
        "cannot allocate memory", "memory allocation"})
    if (lower.find(words) != lower.npos) return true;
  return false;
}

std::optional<EndFault> fault_of_end(const ProcessEnd& end,
                                     const std::string& error) {
  if (end.status == 0 && end.signal == 0) return std::nullopt;
  if (tells_of_no_memory(error))
    return EndFault{AnswerFault::kOutOfMemory,
                    "ran out of memory: " + end_words(end)};
  return EndFault{AnswerFault::kCrashed, end_words(end)};
}

}  // namespace beamgyro::internal
