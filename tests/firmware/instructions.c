/* SPDX-License-Identifier: MIT */
/* Instructions of one step of the compensator `net`, without the call's own
   branch, and of its bias alone. SysTick counts cycles of 40 ns; under QEMU's
   -icount shift=0 every instruction takes 1 ns. */
#include <stdint.h>
#include <stdio.h>

#include "net.c"

enum { kSteps = 10000, kInstructionsPerTick = 40 };

#define SYSTICK_CONTROL (*(volatile uint32_t*)0xe000e010u)
#define SYSTICK_RELOAD (*(volatile uint32_t*)0xe000e014u)
#define SYSTICK_VALUE (*(volatile uint32_t*)0xe000e018u)

static float no_step(net_state* state, const net_sample* sample) {
  (void)state;
  return sample->rate_deg_per_s;
}

static float no_bias(const float* x) { return x[0]; }

static float (*volatile step)(net_state*, const net_sample*);
static float (*volatile bias)(const float*);
static volatile float answer;

static uint32_t ticks_of_steps(void) {
  net_state state;
  net_sample sample = {1.0f, 0.0f};
  uint32_t before;
  int k;
  net_init(&state, 0.1f);
  before = SYSTICK_VALUE;
  for (k = 0; k < kSteps; ++k) {
    sample.temperature_degC = 20.0f + 1e-3f * (float)(k % 1000);
    answer = step(&state, &sample);
  }
  return (before - SYSTICK_VALUE) & 0xffffffu;
}

static uint32_t ticks_of_biases(void) {
  float x[3] = {0.1f, -0.2f, 0.3f};
  const uint32_t before = SYSTICK_VALUE;
  int k;
  for (k = 0; k < kSteps; ++k) {
    x[0] = 1e-4f * (float)k;
    answer = bias(x);
  }
  return (before - SYSTICK_VALUE) & 0xffffffu;
}

static void print(const char* what, uint32_t with, uint32_t without) {
  printf("%s %lu\n", what,
         (unsigned long)((with - without) * kInstructionsPerTick / kSteps));
}

int main(void) {
  uint32_t with, without;
  SYSTICK_RELOAD = 0xffffffu;
  SYSTICK_VALUE = 0;
  SYSTICK_CONTROL = 5; /* runs from the core's clock */
  step = net_step;
  with = ticks_of_steps();
  step = no_step;
  without = ticks_of_steps();
  print("step", with, without);
  bias = bias_of;
  with = ticks_of_biases();
  bias = no_bias;
  without = ticks_of_biases();
  print("bias", with, without);
  return 0;
}
