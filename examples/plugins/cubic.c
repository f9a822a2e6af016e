/* SPDX-License-Identifier: MIT
   A cubic of the temperature as a plug-in in C. */
#include <beamgyro/plugin.h>
#include <stdlib.h>

/* Bias [deg/s] over x = temperature - 25 degC, of the nominal device. */
static const double bias[4] = {0.68417, -0.048258, 2.0124e-3, 3.1422e-5};

uint32_t beamgyro_plugin_abi(void) { return BEAMGYRO_PLUGIN_ABI; }

const char* beamgyro_plugin_signals(void) { return "rate,temperature"; }

/* Without a state any address will do. */
void* beamgyro_plugin_create(void) { return malloc(1); }

int beamgyro_plugin_reset(void* instance, double period) {
  (void)instance, (void)period;
  return 0;
}

double beamgyro_plugin_step(void* instance, double time,
                            const double* signals) {
  const double x = signals[1] - 25.0;
  (void)instance, (void)time;
  return signals[0] - (bias[0] + x * (bias[1] + x * (bias[2] + x * bias[3])));
}

void beamgyro_plugin_destroy(void* instance) { free(instance); }
