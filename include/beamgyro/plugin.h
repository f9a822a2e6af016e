/* SPDX-License-Identifier: MIT
 *
 * A compensator as a shared library, for `beamgyro validate` and `beamgyro
 * compensate`. The library defines the first six functions below, in C or in
 * any language that can give functions C linkage:
 *
 *     cc -shared -fPIC mine.c -o mine.so
 *     beamgyro compensate ./mine.so run.h5 -o out.h5
 *
 * beamgyro loads it in a process of its own with limits of time and memory.
 * Functions may be called from several threads at once, but never with the same
 * instance: an instance needs no lock, and keeps its state in no global
 * variable.
 */
#ifndef BEAMGYRO_PLUGIN_H
#define BEAMGYRO_PLUGIN_H

#include <stdint.h>

/* Version of this interface. */
#define BEAMGYRO_PLUGIN_ABI 1

#if defined(_WIN32)
#define BEAMGYRO_PLUGIN_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define BEAMGYRO_PLUGIN_EXPORT __attribute__((visibility("default")))
#else
#define BEAMGYRO_PLUGIN_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Returns BEAMGYRO_PLUGIN_ABI. */
BEAMGYRO_PLUGIN_EXPORT uint32_t beamgyro_plugin_abi(void);

/* Returns the names of the measured variables that step() is given, between
 * commas, as in "rate,temperature": those of a recording, in its units. They
 * are rate (deg/s), temperature (degC), output (V), drive_frequency (Hz),
 * drive_voltage (V), quadrature (deg/s), status (bit 1: output saturated, bit
 * 2: drive loop not locked), and what else an imported log measured. */
BEAMGYRO_PLUGIN_EXPORT const char* beamgyro_plugin_signals(void);

/* Returns a new instance, or a null pointer when there is none to be had. */
BEAMGYRO_PLUGIN_EXPORT void* beamgyro_plugin_create(void);

/* Prepares the instance for a power-on. All that it has seen before is
 * forgotten. Samples then come about every `period` seconds. Returns 0, or
 * another number when it cannot work with this period. */
BEAMGYRO_PLUGIN_EXPORT int beamgyro_plugin_reset(void* instance, double period);

/* Returns the compensated rate [deg/s] of the next sample, at `time` [s] of the
 * recording. `signals` has one value for each name, in their order. Unpowered
 * samples are left out. */
BEAMGYRO_PLUGIN_EXPORT double beamgyro_plugin_step(void* instance, double time,
                                                   const double* signals);

/* Ends an instance. */
BEAMGYRO_PLUGIN_EXPORT void beamgyro_plugin_destroy(void* instance);

/* A library may define this one, too. Returns which runs it was trained on, so
 * that a validation on them is found out: pieces of a text that ends with a
 * null pointer. The text is a JSON object of the keys `files`,
 * `held_out_files`, `set` and `held_out_set` as in "training" of a compensator
 * file. What export writes has it. */
BEAMGYRO_PLUGIN_EXPORT const char* const* beamgyro_plugin_training(void);

#ifdef __cplusplus
}
#endif

#endif
