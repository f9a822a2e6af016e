/* SPDX-License-Identifier: MIT
 *
 * A library to load before others (LD_PRELOAD): the steady clock of the process
 * shows CLOCK_SPEED times the processor time that it has taken. So minutes pass
 * in a moment, and other processes do not change how much is done in them.
 * Waits for a condition until a time of this clock follow it; a sleep takes as
 * long as ever. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

#define SECOND 1000000000LL

static long long speed;

__attribute__((constructor)) static void read_speed(void) {
  const char *given = getenv("CLOCK_SPEED");
  if (given) speed = atoll(given);
}

static int real_clock(clockid_t clock, struct timespec *now) {
  static __typeof__(&clock_gettime) next;
  if (!next) next = (__typeof__(next))dlsym(RTLD_NEXT, "clock_gettime");
  return next(clock, now);
}

static long long read_clock(clockid_t clock) {
  struct timespec now;
  real_clock(clock, &now);
  return now.tv_sec * SECOND + now.tv_nsec;
}

static long long shown_time(void) {
  return read_clock(CLOCK_PROCESS_CPUTIME_ID) * speed;
}

static struct timespec timespec_of(long long time) {
  const struct timespec parts = {time / SECOND, time % SECOND};
  return parts;
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  if (!speed || clock != CLOCK_MONOTONIC) return real_clock(clock, now);
  *now = timespec_of(shown_time());
  return 0;
}

/* May end too early, when the process has had less than its time; the caller
 * looks at the clock and waits again. */
int pthread_cond_clockwait(pthread_cond_t *condition, pthread_mutex_t *mutex,
                           clockid_t clock, const struct timespec *until) {
  static __typeof__(&pthread_cond_clockwait) next;
  struct timespec end = *until;
  if (!next) next = (__typeof__(next))dlsym(RTLD_NEXT, "pthread_cond_clockwait");
  if (speed && clock == CLOCK_MONOTONIC) {
    const long long left =
        until->tv_sec * SECOND + until->tv_nsec - shown_time();
    end = timespec_of(read_clock(clock) + (left > 0 ? left / speed : 0));
  }
  return next(condition, mutex, clock, &end);
}
