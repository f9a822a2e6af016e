// SPDX-License-Identifier: MIT
#include "validation/external/refused_calls.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/fs.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace beamgyro::internal {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t kProcessor = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kProcessor = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t kProcessor = 0;  // none that is known
#endif
constexpr std::uint32_t kOtherNumbers = 0x40000000;  // x32 on x86-64

// Newer than the headers of Debian 12; alike on every processor.
constexpr long kChangeModeAt2 = 452, kSetAttributeAt = 463,
               kRemoveAttributeAt = 466, kSetFileAttributes = 469;

constexpr long kRefused[] = {
    // Attributes of files that are there.
    SYS_fchmod, SYS_fchmodat, kChangeModeAt2, SYS_fchown, SYS_fchownat,
    SYS_utimensat, SYS_truncate, SYS_setxattr, SYS_lsetxattr, SYS_fsetxattr,
    kSetAttributeAt, SYS_removexattr, SYS_lremovexattr, SYS_fremovexattr,
    kRemoveAttributeAt, kSetFileAttributes,
#ifdef SYS_chmod
    SYS_chmod, SYS_chown, SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat,
#endif
    // Memory and queues that outlast a process.
    SYS_shmget, SYS_shmat, SYS_shmctl, SYS_semget, SYS_semop, SYS_semtimedop,
    SYS_semctl, SYS_msgget, SYS_msgsnd, SYS_msgrcv, SYS_msgctl, SYS_mq_open,
    SYS_mq_unlink, SYS_add_key, SYS_request_key, SYS_keyctl,
    // Others: any network, and the ways round this list and the rules on files.
    SYS_socket, SYS_io_uring_setup, SYS_bpf, SYS_perf_event_open,
    SYS_open_by_handle_at, SYS_openat2,
    // Out of the process group, all of which is ended with its leader.
    SYS_setsid, SYS_setpgid};

// A call that is refused when argument number `argument`, with `mask`, has this
// value, or any other one.
struct RefusedUse {
  long call;
  std::uint32_t argument, mask, value;
  bool of_others = false;
};

constexpr std::uint32_t kAllBits = 0xffffffff;
constexpr std::uint32_t kEnableVerity = 0x40806685;
constexpr RefusedUse kRefusedUses[] = {
    // Empties a file that is opened to read.
    {SYS_openat, 2, O_TRUNC | O_ACCMODE, O_TRUNC | O_RDONLY},
#ifdef SYS_open
    {SYS_open, 1, O_TRUNC | O_ACCMODE, O_TRUNC | O_RDONLY},
#endif
    {SYS_ioctl, 1, kAllBits, FS_IOC_SETFLAGS},
    {SYS_ioctl, 1, kAllBits, FS_IOC32_SETFLAGS},
    {SYS_ioctl, 1, kAllBits, FS_IOC_SETVERSION},
    {SYS_ioctl, 1, kAllBits, FS_IOC32_SETVERSION},
    {SYS_ioctl, 1, kAllBits, FS_IOC_FSSETXATTR},
    {SYS_ioctl, 1, kAllBits, kEnableVerity},
    // Limits and priorities of other processes; 0 is the caller.
    {SYS_prlimit64, 0, kAllBits, 0, true},
    {SYS_sched_setaffinity, 0, kAllBits, 0, true},
    {SYS_sched_setparam, 0, kAllBits, 0, true},
    {SYS_sched_setscheduler, 0, kAllBits, 0, true},
    {SYS_sched_setattr, 0, kAllBits, 0, true},
    {SYS_setpriority, 1, kAllBits, 0, true},
    {SYS_ioprio_set, 1, kAllBits, 0, true}};

// Rights of root that stay: to read and to write files of other users.
constexpr std::uint32_t kKeptRights =
    1U << CAP_DAC_OVERRIDE | 1U << CAP_DAC_READ_SEARCH;

class CallFilter {
 public:
  CallFilter() {
    load(offsetof(seccomp_data, arch));
    skip_unless_equal(kProcessor, 1, 0);
    refuse();
    load(offsetof(seccomp_data, nr));
    instructions_.push_back(
        BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kOtherNumbers, 0, 1));
    refuse();
    for (const long call : kRefused) {
      skip_unless_equal(static_cast<std::uint32_t>(call), 0, 1);
      refuse();
    }
    for (const RefusedUse& use : kRefusedUses) add(use);
    instructions_.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }

  sock_fprog program() {
    return {static_cast<unsigned short>(instructions_.size()),
            instructions_.data()};
  }

 private:
  void load(std::size_t offset) {
    instructions_.push_back(
        BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)));
  }
  // Passes over so many instructions when the value loaded is this one, or not.
  void skip_unless_equal(std::uint32_t value, std::uint8_t if_equal,
                         std::uint8_t if_other) {
    instructions_.push_back(
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, if_equal, if_other));
  }
  void refuse() {
    instructions_.push_back(
        BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM));
  }
  // The lower half of an argument, which is all that these calls read.
  void add(const RefusedUse& use) {
    skip_unless_equal(static_cast<std::uint32_t>(use.call), 0, 5);
    load(offsetof(seccomp_data, args) + sizeof(std::uint64_t) * use.argument);
    instructions_.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, use.mask));
    if (use.of_others)
      skip_unless_equal(use.value, 1, 0);
    else
      skip_unless_equal(use.value, 0, 1);
    refuse();
    load(offsetof(seccomp_data, nr));
  }

  std::vector<sock_filter> instructions_;
};

[[noreturn]] void fail_to_refuse(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

void drop_rights_of_root() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, 2> rights{};
  if (::syscall(SYS_capget, &header, rights.data()) != 0)
    fail_to_refuse("the rights of root cannot be read");
  rights[0].effective &= kKeptRights;
  rights[0].permitted &= kKeptRights;
  rights[0].inheritable = 0;
  rights[1] = {};
  if (::syscall(SYS_capset, &header, rights.data()) != 0)
    fail_to_refuse("the rights of root cannot be given up");
}

}  // namespace

void refuse_calls() {
  if (kProcessor == 0)
    throw std::runtime_error(
        "no list of system calls is known for this processor");
  drop_rights_of_root();
  CallFilter filter;
  const sock_fprog program = filter.program();
  // Without it only root may set a filter, and programs with rights of their
  // own would regain them.
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    fail_to_refuse("the kernel takes no filter of system calls");
}

}  // namespace beamgyro::internal
