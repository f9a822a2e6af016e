/* SPDX-License-Identifier: MIT
   Exported code on an emulated Cortex-M4F as a command of beamgyro:

     beamgyro export gyro.json --format c -o firmware
     arm-none-eabi-gcc -O2 -mcpu=cortex-m4 -mthumb -mfloat-abi=hard \
       -mfpu=fpv4-sp-d16 -ffp-contract=off -Ifirmware \
       examples/plugins/cortex_m4.c firmware/gyro.c tests/firmware/start.c \
       -T tests/firmware/mps2_an386.ld -nostartfiles --specs=rdimon.specs \
       -o gyro.elf
     beamgyro compensate "cmd:qemu-system-arm -M mps2-an386 -display none \
       -serial none -monitor none -semihosting-config \
       enable=on,target=native -kernel gyro.elf" run.h5 -o out.h5

   The image reads and writes files of the computer that emulates it. Fill in
   more fields of the sample when the compensator reads more signals. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gyro.h"

enum { kLongestLine = 400 };

/* The number of the column called `name` in the line of names. */
static int column(const char* names, const char* name) {
  const size_t length = strlen(name);
  int k = 0;
  for (; *names != '\0'; ++names, ++k) {
    const size_t next = strcspn(names, ",\r\n");
    if (next == length && strncmp(names, name, length) == 0) return k;
    names += next;
    if (*names != ',') break;
  }
  return -1;
}

static double value(const char* line, int at) {
  for (; at > 0; --at) {
    line = strchr(line, ',');
    if (line == NULL) return 0.0;
    ++line;
  }
  return strtod(line, NULL);
}

int main(void) {
  static char line[kLongestLine], next[kLongestLine];
  FILE *in = fopen("/dev/stdin", "r"), *out = fopen("/dev/stdout", "w");
  gyro_state state;
  int rate, temperature, started = 0;
  if (in == NULL || out == NULL || !fgets(line, sizeof line, in)) return 1;
  rate = column(line, "rate");
  temperature = column(line, "temperature");
  if (rate < 0 || temperature < 0) return 1;
  /* The period is the step from the first sample to the second. */
  if (!fgets(line, sizeof line, in)) return 0;
  for (;;) {
    const int more = fgets(next, sizeof next, in) != NULL;
    gyro_sample sample;
    if (!started && more) {
      const double period = value(next, 0) - value(line, 0);
      if (gyro_init(&state, (float)period) != 0) return 1;
      started = 1;
    }
    if (!started && gyro_init(&state, 1.0f) != 0) return 1;
    started = 1;
    sample.rate_deg_per_s = (float)value(line, rate);
    sample.temperature_degC = (float)value(line, temperature);
    fprintf(out, "%.17g\n", (double)gyro_step(&state, &sample));
    if (!more) break;
    memcpy(line, next, sizeof line);
  }
  return fclose(out) == 0 ? 0 : 1;
}
