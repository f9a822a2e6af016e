// SPDX-License-Identifier: MIT
#include "validation/external/landlock.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

#include "dataset/files/open_file.h"

namespace beamgyro::internal {
namespace {

// From linux/landlock.h of Linux 6.15; Debian 12 has that of Linux 6.1.
constexpr long kCreateRuleset = 444, kAddRule = 445, kRestrictSelf = 446;
constexpr std::uint32_t kAskVersion = 1;
constexpr int kRuleBelowPath = 1;

struct RulesetAttributes {
  std::uint64_t files, network, scopes;
};

struct [[gnu::packed]] PathRule {
  std::uint64_t rights;
  std::int32_t parent;
};

constexpr std::uint64_t kExecute = 1 << 0, kWriteFile = 1 << 1,
                        kReadFile = 1 << 2, kReadFolder = 1 << 3,
                        kMakeCharacter = 1 << 6, kMakeBlock = 1 << 11,
                        kTruncate = 1 << 14, kDeviceControl = 1 << 15;
constexpr std::uint64_t kOfFiles =
    kExecute | kWriteFile | kReadFile | kTruncate | kDeviceControl;

// The first rights of each version, that is all of the versions before.
constexpr std::array<int, 8> kFileRights = {0, 13, 14, 15, 15, 16, 16, 16};
constexpr int kWithNetwork = 4, kWithScopes = 6;
constexpr std::uint64_t kBindAndConnect = 3, kSocketsAndSignals = 3;

std::string landlock_words(int error) {
  switch (error) {
    case ENOSYS:
      return "the kernel has no Landlock, which Linux 5.13 and later can have";
    case EOPNOTSUPP:
      return "the kernel was started without Landlock";
    case EPERM:
      return "Landlock is refused here, as some containers do";
    default:
      return std::string("Landlock fails: ") + std::strerror(error);
  }
}

[[noreturn]] void fail_landlock() {
  throw std::runtime_error(landlock_words(errno));
}

int version_of_kernel() {
  const long version = ::syscall(kCreateRuleset, nullptr, 0, kAskVersion);
  if (version < 0) fail_landlock();
  return static_cast<int>(version);
}

class Ruleset {
 public:
  explicit Ruleset(int version)
      : handled_((std::uint64_t{1}
                  << kFileRights.at(static_cast<std::size_t>(version))) -
                 1),
        file_(made(version)) {}

  // Allows what is there.
  void allow(const std::filesystem::path& path, std::uint64_t rights) {
    const int descriptor = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    if (descriptor < 0) return;
    const OpenFile opened(descriptor);
    struct stat about {};
    if (::fstat(descriptor, &about) != 0) return;
    if (!S_ISDIR(about.st_mode)) rights &= kOfFiles;
    const PathRule rule{rights & handled_, descriptor};
    if (::syscall(kAddRule, file_.descriptor(), kRuleBelowPath, &rule, 0) != 0)
      fail_landlock();
  }

  void restrict_this_process() const {
    if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
        ::syscall(kRestrictSelf, file_.descriptor(), 0) != 0)
      fail_landlock();
  }

  std::uint64_t handled() const { return handled_; }

 private:
  OpenFile made(int version) const {
    const RulesetAttributes attributes{
        handled_, version >= kWithNetwork ? kBindAndConnect : 0,
        version >= kWithScopes ? kSocketsAndSignals : 0};
    const long descriptor =
        ::syscall(kCreateRuleset, &attributes, sizeof attributes, 0);
    if (descriptor < 0) fail_landlock();
    return OpenFile(static_cast<int>(descriptor));
  }

  std::uint64_t handled_;
  OpenFile file_;
};

}  // namespace

void restrict_files(const std::vector<std::filesystem::path>& readable,
                    const std::filesystem::path& folder, int highest) {
  const int version = std::min({version_of_kernel(), highest, kNewestLandlock});
  Ruleset rules(version);
  const std::uint64_t read = kReadFile | kReadFolder;
  for (const std::filesystem::path& path : readable)
    rules.allow(path, read | kExecute);
  for (const char* path :
       {"/dev/zero", "/dev/urandom", "/sys/devices/system/cpu", "/proc/cpuinfo",
        "/proc/meminfo", "/proc/self"})
    rules.allow(path, read);
  rules.allow("/dev/null", read | kWriteFile | kTruncate | kDeviceControl);
  // All but devices, and to move files in from elsewhere.
  rules.allow(folder, rules.handled() & ~(kMakeCharacter | kMakeBlock));
  rules.restrict_this_process();
}

}  // namespace beamgyro::internal
