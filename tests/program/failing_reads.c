/* SPDX-License-Identifier: MIT
 *
 * Loaded before other libraries (LD_PRELOAD), lets read number READ_FAILS of
 * the files whose names end in .h5 fail with an input/output error. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static atomic_long reads;

static int fails(int file) {
  char link[64], path[PATH_MAX];
  const char *number = getenv("READ_FAILS");
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path);
  if (!number || size < 3 || memcmp(path + size - 3, ".h5", 3) != 0) return 0;
  if (atomic_fetch_add(&reads, 1) + 1 != atol(number)) return 0;
  errno = EIO;
  return 1;
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

ssize_t read(int file, void *bytes, size_t size) {
  return fails(file) ? -1 : NEXT(read)(file, bytes, size);
}

ssize_t pread(int file, void *bytes, size_t size, off_t place) {
  return fails(file) ? -1 : NEXT(pread)(file, bytes, size, place);
}

ssize_t pread64(int file, void *bytes, size_t size, off64_t place) {
  return fails(file) ? -1 : NEXT(pread64)(file, bytes, size, place);
}
