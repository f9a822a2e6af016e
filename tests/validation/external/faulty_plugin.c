/* SPDX-License-Identifier: MIT
   A plug-in of beamgyro/plugin.h that corrects 0.01 deg/s/K, with one fault
   planted: FAULT is one of the numbers below. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "include/beamgyro/plugin.h"

#define NONE 0
#define CRASHES 1
#define ABORTS 2
#define EXITS 3
#define HANGS 4
#define USES_NO_MEMORY 5
#define ANSWERS_NAN 6
#define KEEPS_STATE 7
#define OTHER_VERSION 8
#define WANTS_TRUTH 9
#define REFUSES_PERIOD 10
#define RECURSES 11
#define IS_SLOW 12
#define PRINTS 13
#define LACKS_A_FUNCTION 14
#define LEAKS 15
#define CRASHES_WHEN_LOADED 16
#define WANTS_MORE 17
#define HANGS_WHEN_LOADED 18
#define STATES_ITS_TRAINING 19
#define STATES_NONSENSE 20
#define EXITS_WHEN_LOADED 21
#define WANTS_NOTHING 22
#define WANTS_MANY 23
#define TELLS_WITHOUT_END 24

#define MANY 20000

#define FAULTY_SAMPLE 700

typedef struct {
  long samples;
  double kept;
} Instance;

#if FAULT == CRASHES_WHEN_LOADED
__attribute__((constructor)) static void crash(void) {
  *(volatile int *)8 = 1;
}
#endif

#if FAULT == EXITS_WHEN_LOADED
__attribute__((constructor)) static void leave(void) { _exit(0); }
#endif

#if FAULT == TELLS_WITHOUT_END
__attribute__((constructor)) static void tell(void) {
  static const char text[1 << 16];
  for (;;)
    for (int descriptor = 3; descriptor < 16; ++descriptor)
      if (write(descriptor, text, sizeof text) < 0) continue;
}
#endif

#if FAULT == WANTS_MANY
static const char *many(void) {
  static char names[12 * MANY + 32] = "rate";
  for (int k = 1; k < MANY; ++k) strcpy(names + 4 + 12 * (k - 1), ",temperature");
  return names;
}
#endif

uint32_t beamgyro_plugin_abi(void) {
  return FAULT == OTHER_VERSION ? 77 : BEAMGYRO_PLUGIN_ABI;
}

const char *beamgyro_plugin_signals(void) {
  if (FAULT == HANGS_WHEN_LOADED)
    for (;;) sleep(1);
  if (FAULT == WANTS_TRUTH) return "rate,true_rate";
  if (FAULT == WANTS_NOTHING) return "";
#if FAULT == WANTS_MANY
  return many();
#endif
  if (FAULT == WANTS_MORE) return "rate,magnetic_field";
  return "rate,temperature";
}

void *beamgyro_plugin_create(void) { return calloc(1, sizeof(Instance)); }

int beamgyro_plugin_reset(void *instance, double period) {
  Instance *state = instance;
  state->samples = 0;
  if (FAULT != KEEPS_STATE) state->kept = 0.0;
  return FAULT == REFUSES_PERIOD && period > 0.0 ? -1 : 0;
}

static double recursion(double x) {
  volatile double deeper[1000];
  deeper[0] = x;
  return recursion(deeper[0] + 1.0) + deeper[0];
}

static double faulty(double rate) {
  if (FAULT == CRASHES) *(volatile int *)8 = 1;
  if (FAULT == ABORTS) abort();
  if (FAULT == EXITS) exit(0);
  if (FAULT == HANGS)
    for (;;) {
    }
  if (FAULT == USES_NO_MEMORY) *(volatile char *)malloc((size_t)8 << 30) = 1;
  if (FAULT == ANSWERS_NAN) return NAN;
  if (FAULT == RECURSES) return recursion(rate);
  return rate;
}

#if FAULT != LACKS_A_FUNCTION
double beamgyro_plugin_step(void *instance, double time,
                            const double *signals) {
  Instance *state = instance;
  double rate = signals[0] - 0.01 * signals[1];
  (void)time;
  if (FAULT == KEEPS_STATE) rate -= state->kept;
  state->kept += 1e-6 * signals[0];
  if (FAULT == IS_SLOW) usleep(12000);
  if (FAULT == PRINTS) printf("sample %ld\n", state->samples);
  if (FAULT == LEAKS)
    for (volatile char *leak = malloc(1 << 20);; leak = malloc(1 << 20))
      *leak = 1;
  if (state->samples++ == FAULTY_SAMPLE) return faulty(rate);
  return rate;
}
#endif

void beamgyro_plugin_destroy(void *instance) { free(instance); }

#if FAULT == STATES_ITS_TRAINING
static const char *const training[] = {
    "{\"files\": [{\"name\": \"a.h5\", \"sha2",
    "56\": \"0123\"}], \"held_out_files\": []}", NULL};
#elif FAULT == STATES_NONSENSE
static const char *const training[] = {"trained well", NULL};
#endif
#if FAULT == STATES_ITS_TRAINING || FAULT == STATES_NONSENSE
const char *const *beamgyro_plugin_training(void) { return training; }
#endif
