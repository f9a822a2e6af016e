/* SPDX-License-Identifier: MIT
 *
 * A library to load before others (LD_PRELOAD) that numbers the file-system
 * calls of a process on paths below a directory and lets one of them fail:
 *
 *   FAULT_PREFIX=DIR   only calls on DIR and what is below it are numbered
 *   FAULT_LOG=FILE     each of them is added to it as "NUMBER CALL PATH"
 *   FAULT_PIPES=1      only calls on pipes of the first process are numbered,
 *                      and those that make a pipe or a process, or wait
 *   FAULT_CALL=N       the call to strike, from 1
 *   FAULT_KIND=KIND    what happens to it:
 *     EIO, ENOSPC, EINTR   it does nothing and fails with this error; but
 *                          close() closes, as on Linux
 *     short                a read or write transfers half of what was asked
 *     torn                 half of a write is done, then the process is killed
 *     kill                 the process is killed before the call
 *
 * A call on a descriptor belongs to the path that this was opened with. What
 * the C library does within its own functions is not seen. */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum strike { kNone, kError, kShort, kTorn, kKill };

#define MOST_FILES 1024
#define LONGEST (2 * PATH_MAX)
static char prefix[PATH_MAX];
static size_t prefix_size;
static int log_file = -1;
static long struck_call;
static enum strike kind;
static int error_number;
static atomic_long calls;
static char *paths[MOST_FILES]; /* of the descriptors that are numbered */
static int strikes_pipes;

/* The function that would have been called without this library. */
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

__attribute__((constructor)) static void read_plan(void) {
  static const struct {
    const char *name;
    enum strike kind;
    int error;
  } kinds[] = {{"EIO", kError, EIO},     {"ENOSPC", kError, ENOSPC},
               {"EINTR", kError, EINTR}, {"short", kShort, 0},
               {"torn", kTorn, 0},       {"kill", kKill, 0}};
  const char *below = getenv("FAULT_PREFIX"), *log = getenv("FAULT_LOG");
  const char *number = getenv("FAULT_CALL"), *name = getenv("FAULT_KIND");
  if (getenv("FAULT_PIPES")) {
    strikes_pipes = 1;
    unsetenv("FAULT_PIPES"); /* not in processes that it starts */
    below = NULL;
  } else if (!below || strlen(below) >= sizeof prefix) {
    return;
  }
  if (below) strcpy(prefix, below);
  prefix_size = strlen(prefix);
  if (log) log_file = NEXT(open)(log, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (!number || !name) return;
  struck_call = atol(number);
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i)
    if (!strcmp(kinds[i].name, name)) {
      kind = kinds[i].kind;
      error_number = kinds[i].error;
    }
  if (kind == kNone) _exit(99);
}

static void die(void) {
  kill(getpid(), SIGKILL);
  for (;;) pause();
}

/* Whether `path`, relative to the directory open as `directory`, is numbered;
 * its absolute name goes to `full`, with links as they are. */
static int is_numbered(int directory, const char *path, char full[LONGEST]) {
  char link[64], base[PATH_MAX] = "";
  const int kept = errno;
  if (!prefix_size || !path) return 0;
  if (!strncmp(path, "/proc/self/fd/", 14)) { /* another name of a file */
    const ssize_t size = readlink(path, base, sizeof base - 1);
    base[size > 0 ? size : 0] = '\0';
    path = "";
  } else if (*path != '/') {
    if (directory == AT_FDCWD)
      strcpy(link, "/proc/self/cwd");
    else
      snprintf(link, sizeof link, "/proc/self/fd/%d", directory);
    const ssize_t size = readlink(link, base, sizeof base - 1);
    base[size > 0 ? size : 0] = '\0';
  }
  snprintf(full, LONGEST, "%s%s%s", base, *base && *path ? "/" : "", path);
  errno = kept;
  return !strncmp(full, prefix, prefix_size) &&
         (full[prefix_size] == '/' || full[prefix_size] == '\0');
}

/* Numbers a call and says what is to happen to it; errno is set for kError. */
static enum strike strike(const char *name, const char *full) {
  const int kept = errno;
  const long number = atomic_fetch_add(&calls, 1) + 1;
  if (log_file >= 0)
    dprintf(log_file, "%ld %s %s\n", number, name, full);
  errno = kept;
  if (number != struck_call) return kNone;
  if (kind == kKill) die();
  if (kind == kError) errno = error_number;
  return kind;
}

static enum strike strike_path(const char *name, int directory,
                               const char *path) {
  char full[LONGEST];
  return is_numbered(directory, path, full) ? strike(name, full) : kNone;
}

static enum strike strike_file(const char *name, int file) {
  const int has_path = file >= 0 && file < MOST_FILES && paths[file];
  return has_path ? strike(name, paths[file]) : kNone;
}

static int remember(int file, int directory, const char *path) {
  char full[LONGEST];
  if (file < 0 || file >= MOST_FILES) return file;
  free(paths[file]);
  paths[file] = is_numbered(directory, path, full) ? strdup(full) : NULL;
  return file;
}

static void forget(int file) {
  if (file < 0 || file >= MOST_FILES) return;
  free(paths[file]);
  paths[file] = NULL;
}

#define MODE(flags)                                       \
  mode_t mode = 0;                                        \
  if ((flags) & (O_CREAT | __O_TMPFILE)) {                \
    va_list list;                                         \
    va_start(list, flags);                                \
    mode = va_arg(list, mode_t);                          \
    va_end(list);                                         \
  }

#define OPEN(name)                                                     \
  int name(const char *path, int flags, ...) {                         \
    MODE(flags)                                                        \
    if (strike_path("open", AT_FDCWD, path) == kError) return -1;      \
    return remember(NEXT(name)(path, flags, mode), AT_FDCWD, path);    \
  }
OPEN(open)
OPEN(open64)

#define OPENAT(name)                                                   \
  int name(int directory, const char *path, int flags, ...) {          \
    MODE(flags)                                                        \
    if (strike_path("open", directory, path) == kError) return -1;     \
    return remember(NEXT(name)(directory, path, flags, mode),          \
                    directory, path);                                  \
  }
OPENAT(openat)
OPENAT(openat64)

/* openat2() has no function of its own in the C library. */
long syscall(long number, ...) {
  long a[6];
  va_list list;
  va_start(list, number);
  for (int i = 0; i < 6; ++i) a[i] = va_arg(list, long);
  va_end(list);
  const int is_open = number == SYS_openat2;
  const int directory = (int)a[0];
  const char *path = (const char *)a[1];
  if (is_open && strike_path("open", directory, path) == kError) return -1;
  const long result =
      NEXT(syscall)(number, a[0], a[1], a[2], a[3], a[4], a[5]);
  return is_open ? remember((int)result, directory, path) : result;
}

#define FOPEN(name)                                                    \
  FILE *name(const char *path, const char *mode) {                     \
    if (strike_path("open", AT_FDCWD, path) == kError) return NULL;    \
    FILE *file = NEXT(name)(path, mode);                               \
    if (file) remember(fileno(file), AT_FDCWD, path);                  \
    return file;                                                       \
  }
FOPEN(fopen)
FOPEN(fopen64)

DIR *opendir(const char *path) {
  if (strike_path("opendir", AT_FDCWD, path) == kError) return NULL;
  DIR *directory = NEXT(opendir)(path);
  if (directory) remember(dirfd(directory), AT_FDCWD, path);
  return directory;
}
int closedir(DIR *directory) {
  forget(dirfd(directory));
  return NEXT(closedir)(directory);
}
struct dirent *readdir(DIR *directory) {
  if (strike_file("readdir", dirfd(directory)) == kError) return NULL;
  return NEXT(readdir)(directory);
}
struct dirent64 *readdir64(DIR *directory) {
  if (strike_file("readdir", dirfd(directory)) == kError) return NULL;
  return NEXT(readdir64)(directory);
}

#define PART(how, size) ((how) == kShort && (size) > 1 ? (size) / 2 : (size))

ssize_t read(int file, void *bytes, size_t size) {
  const enum strike how = strike_file("read", file);
  if (how == kError) return -1;
  return NEXT(read)(file, bytes, PART(how, size));
}
ssize_t write(int file, const void *bytes, size_t size) {
  const enum strike how = strike_file("write", file);
  if (how == kError) return -1;
  if (how == kTorn) NEXT(write)(file, bytes, size / 2), die();
  return NEXT(write)(file, bytes, PART(how, size));
}
#define PREAD(name)                                                    \
  ssize_t name(int file, void *bytes, size_t size, off_t place) {      \
    const enum strike how = strike_file("read", file);                 \
    if (how == kError) return -1;                                      \
    return NEXT(name)(file, bytes, PART(how, size), place);            \
  }
PREAD(pread)
PREAD(pread64)
#define PWRITE(name)                                                   \
  ssize_t name(int file, const void *bytes, size_t size, off_t place) { \
    const enum strike how = strike_file("write", file);                \
    if (how == kError) return -1;                                      \
    if (how == kTorn) NEXT(name)(file, bytes, size / 2, place), die(); \
    return NEXT(name)(file, bytes, PART(how, size), place);            \
  }
PWRITE(pwrite)
PWRITE(pwrite64)

int close(int file) {
  const enum strike how = strike_file("close", file);
  const int kept = errno;
  forget(file);
  const int result = NEXT(close)(file);
  if (how != kError) return result;
  errno = kept;
  return -1;
}

int pipe2(int ends[2], int flags) {
  if (strikes_pipes && strike("pipe", "pipe") == kError) return -1;
  const int result = NEXT(pipe2)(ends, flags);
  for (int k = 0; result == 0 && strikes_pipes && k < 2; ++k)
    if (ends[k] < MOST_FILES) forget(ends[k]), paths[ends[k]] = strdup("pipe");
  return result;
}
int poll(struct pollfd *waits, nfds_t count, int timeout) {
  if (strikes_pipes && strike("poll", "pipe") == kError) return -1;
  return NEXT(poll)(waits, count, timeout);
}
int posix_spawnp(pid_t *id, const char *file,
                 const posix_spawn_file_actions_t *actions,
                 const posix_spawnattr_t *attributes, char *const words[],
                 char *const variables[]) {
  if (strikes_pipes && strike("spawn", "process") == kError)
    return error_number;
  return NEXT(posix_spawnp)(id, file, actions, attributes, words, variables);
}

/* A call on one descriptor, and one on one path. */
#define ON_FILE(called, name, parameters, arguments, file)             \
  int name parameters {                                                \
    if (strike_file(called, file) == kError) return -1;                \
    return NEXT(name) arguments;                                       \
  }
#define ON_PATH(called, name, parameters, arguments, directory, path)  \
  int name parameters {                                                \
    if (strike_path(called, directory, path) == kError) return -1;     \
    return NEXT(name) arguments;                                       \
  }
ON_FILE("fsync", fsync, (int file), (file), file)
ON_FILE("fsync", fdatasync, (int file), (file), file)
ON_FILE("flock", flock, (int file, int how), (file, how), file)
ON_FILE("ftruncate", ftruncate, (int file, off_t n), (file, n), file)
ON_FILE("ftruncate", ftruncate64, (int file, off_t n), (file, n), file)
ON_FILE("fchmod", fchmod, (int file, mode_t mode), (file, mode), file)
ON_FILE("stat", fstat, (int file, struct stat *to), (file, to), file)
ON_FILE("stat", fstat64, (int file, struct stat64 *to), (file, to), file)
ON_PATH("stat", stat, (const char *path, struct stat *to), (path, to),
        AT_FDCWD, path)
ON_PATH("stat", stat64, (const char *path, struct stat64 *to), (path, to),
        AT_FDCWD, path)
ON_PATH("stat", lstat, (const char *path, struct stat *to), (path, to),
        AT_FDCWD, path)
ON_PATH("stat", lstat64, (const char *path, struct stat64 *to), (path, to),
        AT_FDCWD, path)
ON_PATH("stat", fstatat,
        (int directory, const char *path, struct stat *to, int flags),
        (directory, path, to, flags), directory, path)
ON_PATH("statvfs", statvfs, (const char *path, struct statvfs *to), (path, to),
        AT_FDCWD, path)
ON_PATH("access", access, (const char *path, int mode), (path, mode), AT_FDCWD,
        path)
ON_PATH("access", faccessat,
        (int directory, const char *path, int mode, int flags),
        (directory, path, mode, flags), directory, path)
ON_PATH("rename", rename, (const char *path, const char *to), (path, to),
        AT_FDCWD, path)
ON_PATH("rename", renameat,
        (int directory, const char *path, int there, const char *to),
        (directory, path, there, to), directory, path)
ON_PATH("link", link, (const char *path, const char *to), (path, to), AT_FDCWD,
        to)
ON_PATH("link", linkat,
        (int directory, const char *path, int there, const char *to, int flags),
        (directory, path, there, to, flags), there, to)
ON_PATH("unlink", unlink, (const char *path), (path), AT_FDCWD, path)
ON_PATH("unlink", unlinkat, (int directory, const char *path, int flags),
        (directory, path, flags), directory, path)
ON_PATH("unlink", remove, (const char *path), (path), AT_FDCWD, path)
ON_PATH("mkdir", mkdir, (const char *path, mode_t mode), (path, mode), AT_FDCWD,
        path)
ON_PATH("mkdir", mkdirat, (int directory, const char *path, mode_t mode),
        (directory, path, mode), directory, path)
ON_PATH("rmdir", rmdir, (const char *path), (path), AT_FDCWD, path)
ON_PATH("chmod", chmod, (const char *path, mode_t mode), (path, mode), AT_FDCWD,
        path)
