// SPDX-License-Identifier: MIT
#include "tests/validation/external/isolation_attacks.h"

#include <fmt/format.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "tests/validation/external/tested_run.h"
#include "validation/external/compensator_source.h"

namespace beamgyro::internal {
namespace {

constexpr unsigned kUser = 54321;  // of no one else

struct Attack {
  const char *name, *code;  // which raises when it does not work
};

// In Python. PARENT is the process that judges, FOLDER holds run.h5 and the
// script, ADDRESS and TEXT are memory of the parent.
constexpr Attack kAttacks[] = {
    {"recording", "open(FOLDER + '/run.h5', 'rb').read(1)"},
    {"folder", "os.listdir(FOLDER)"},
    {"command line", "open(f'/proc/{PARENT}/cmdline', 'rb').read(1)"},
    {"memory",
     "m = open(f'/proc/{PARENT}/mem', 'rb', buffering=0)\n"
     "    m.seek(ADDRESS)\n"
     "    assert m.read(len(TEXT)) == TEXT"},
    {"other memory",
     "b = ctypes.create_string_buffer(len(TEXT))\n"
     "    v = (ctypes.c_void_p * 2)(ctypes.addressof(b), len(TEXT))\n"
     "    w = (ctypes.c_void_p * 2)(ADDRESS, len(TEXT))\n"
     "    call('process_vm_readv', PARENT, v, 1, w, 1, 0)\n"
     "    assert b.raw == TEXT"},
    {"file in /tmp",
     "p = f'/tmp/beamgyro note {PARENT}'\n"
     "    open(p, 'w').close()\n"
     "    os.unlink(p)"},
    {"file beside", "open(FOLDER + '/note', 'w').close()"},
    {"link", "os.link(SELF, FOLDER + '/link')"},
    {"rename", "os.rename(SELF, SELF + 'x'); os.rename(SELF + 'x', SELF)"},
    {"System V memory",
     "n = call('shmget', PARENT, 4096, 0o1600)\n"
     "    call('shmctl', n, 0, None)"},
    {"System V queue",
     "n = call('msgget', PARENT, 0o1600)\n"
     "    call('msgctl', n, 0, None)"},
    {"POSIX queue",
     "q = f'/beamgyro{PARENT}'.encode()\n"
     "    call('mq_open', q, 0o102, 0o600, None)\n"
     "    libc.mq_unlink(q)"},
    {"key",  // to the keys of the process, as a session may have none
     "check(libc.syscall(ADD_KEY, b'user', b'beamgyro', b'x', 1, -2))"},
    {"time of a file", "os.utime(SELF, (1, 1))"},
    {"mode of a file", "os.chmod(SELF, 0o700)"},
    {"attribute of a file", "os.setxattr(SELF, 'user.note', b'x')"},
    {"flags of a file",
     "f = os.open(SELF, os.O_RDONLY)\n"
     "    a = array.array('l', [0])\n"
     "    fcntl.ioctl(f, 0x80086601, a)\n"
     "    fcntl.ioctl(f, 0x40086602, a)"},
    {"length of a file", "os.truncate(FOLDER + '/other.py', 3)"},
    {"length by opening",
     "os.close(os.open(FOLDER + '/other.py', os.O_RDONLY | os.O_TRUNC))"},
    {"abstract socket",
     "socket.socket(socket.AF_UNIX).bind(f'\\0beamgyro{PARENT}')"},
    {"UDP",
     "socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(\n"
     "        b'x', ('127.0.0.1', 9))"},
    {"limits of the parent",
     "resource.prlimit(PARENT, resource.RLIMIT_NOFILE)"},
    {"another process group",
     "p = os.fork()\n"
     "    if p == 0:\n"
     "        try: os.setsid(); os._exit(0)\n"
     "        except OSError: os._exit(1)\n"
     "    assert os.waitpid(p, 0)[1] == 0"},
};

constexpr const char* kHead = R"(
import array, ctypes, fcntl, os, resource, socket, sys
PARENT, ADDRESS, TEXT = {}, {}, b'{}'
FOLDER, ADD_KEY = '{}', {}
SELF = os.path.abspath(__file__)
libc = ctypes.CDLL(None, use_errno=True)
def check(n):
    if n < 0: raise OSError(ctypes.get_errno(), 'refused')
    return n
def call(name, *values):
    return check(getattr(libc, name)(*values))
works = 0
)";

std::string script(const std::filesystem::path& folder,
                   const std::string& memory) {
  std::string text =
      fmt::format(fmt::runtime(kHead), ::getpid(),
                  reinterpret_cast<std::uintptr_t>(memory.data()), memory,
                  folder.string(), SYS_add_key);
  // Addresses are longer than an int of C.
  text +=
      "libc.process_vm_readv.argtypes = [ctypes.c_int, ctypes.c_void_p, "
      "ctypes.c_ulong, ctypes.c_void_p, ctypes.c_ulong, ctypes.c_ulong]\n";
  for (std::size_t k = 0; k < std::size(kAttacks); ++k)
    text += fmt::format(
        "try:\n    {}\n    works |= 1 << {}\nexcept (OSError, AssertionError):"
        "\n    pass\n",
        kAttacks[k].code, k);
  return text + "next(sys.stdin)\nfor line in sys.stdin: print(works)\n";
}

}  // namespace

std::vector<std::string> attack_names() {
  std::vector<std::string> names;
  for (const Attack& attack : kAttacks) names.emplace_back(attack.name);
  return names;
}

std::vector<std::string> working_attacks(const std::filesystem::path& directory,
                                         const ProcessLimits& limits,
                                         const std::string& memory) {
  const std::filesystem::path folder =
      directory / fmt::format("{}", ::getpid());
  std::filesystem::create_directory(folder);
  std::ofstream(folder / "run.h5") << "truth";
  std::ofstream(folder / "other.py") << "# of some length\n";
  std::ofstream(folder / "attack.py") << script(folder, memory);
  const auto command = open_tested_compensator(
      fmt::format("cmd:/usr/bin/python3 '{0}/attack.py' '{0}/other.py' "
                  "'{0}/run.h5'",
                  folder.string()),
      limits);
  const Answer answer = command->answer(tested_run(1.0));
  if (!answer.faults.empty()) throw std::runtime_error(answer.faults[0].words);
  const auto works = static_cast<unsigned long>(answer.rate[0]);
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::size(kAttacks); ++k)
    if ((works >> k & 1) != 0) names.emplace_back(kAttacks[k].name);
  return names;
}

std::string in_process(bool is_user, const std::function<std::string()>& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  const pid_t id = ::fork();
  if (id == 0) {
    std::string words;
    try {
      if (is_user && ::geteuid() == 0 &&
          (::setgid(kUser) != 0 || ::setuid(kUser) != 0))
        throw std::runtime_error("cannot become another user");
      if (is_user) ::prctl(PR_SET_DUMPABLE, 1);  // as any process of a user
      words = work();
    } catch (const std::exception& error) {
      words = error.what();
    }
    static_cast<void>(!::write(ends[1], words.data(), words.size()));
    ::_exit(0);
  }
  ::close(ends[1]);
  std::string words;
  std::array<char, 4096> bytes{};
  for (ssize_t n = 0; (n = ::read(ends[0], bytes.data(), bytes.size())) > 0;)
    words.append(bytes.data(), static_cast<std::size_t>(n));
  ::close(ends[0]);
  ::waitpid(id, nullptr, 0);
  return words;
}

void lose_landlock(int error) {
  constexpr std::uint32_t kFirst = 444, kLast = 446;
  std::array<sock_filter, 5> filter = {
      {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
       BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kFirst, 0, 2),
       BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kLast, 1, 0),
       BPF_STMT(BPF_RET | BPF_K,
                SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error)),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  const sock_fprog program{filter.size(), filter.data()};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
    throw std::runtime_error("no filter");
}

}  // namespace beamgyro::internal
