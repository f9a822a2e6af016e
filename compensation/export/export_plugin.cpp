// SPDX-License-Identifier: MIT
#include "compensation/export/export_plugin.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "compensation/compensator/training_runs_json.h"
#include "compensation/firmware/c_text.h"
#include "include/beamgyro/plugin.h"

namespace beamgyro::internal {
namespace {

std::string filled_sample(const std::string& name, const FirmwareModel& model) {
  std::string text;
  int place = 0;
  for (std::size_t k = 0; k < kFirmwareSignalCount; ++k) {
    if (!model.reads(k)) continue;
    std::string value = fmt::format("signals[{}]", place++);
    if (k == kFirmwareDriveFrequency)
      value = fmt::format("({} - {}_DRIVE_FREQUENCY)", value, name);
    text +=
        fmt::format("  sample.{} = (float){};\n", kFirmwareFields[k], value);
  }
  return text;
}

std::string signal_names(const FirmwareModel& model) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
    if (model.reads(k)) names.emplace_back(kFirmwareSignals[k]);
  return fmt::format("{}", fmt::join(names, ","));
}

// Elements of an array of short literals: compilers need not take long ones.
std::string training_lines(const Provenance& provenance) {
  constexpr std::size_t kPiece = 64;  // characters
  nlohmann::ordered_json json;
  put_training_runs(provenance, json);
  const std::string all = json.dump(
      -1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  std::string lines;
  for (std::size_t k = 0; k < all.size(); k += kPiece)
    lines += fmt::format("    {},\n", c_string(all.substr(k, kPiece)));
  return lines;
}

}  // namespace

std::string plugin_source(const FittedCompensator& compensator,
                          const std::string& name, const FirmwareModel& model) {
  return fmt::format(
      R"(/* The firmware {0}.c as a plug-in of beamgyro, which has the functions of
   beamgyro/plugin.h:

     cc -shared -fPIC {0}.c {0}_plugin.c -o {0}.so
     beamgyro compensate ./{0}.so RUN.h5 -o OUT.h5

   -ffp-contract=off gives the bits of the self-test. Not for the firmware. */
#include <stdint.h>
#include <stdlib.h>

#include "{0}.h"

#ifdef __cplusplus
extern "C" {{
#endif

uint32_t beamgyro_plugin_abi(void);
const char *beamgyro_plugin_signals(void);
void *beamgyro_plugin_create(void);
int beamgyro_plugin_reset(void *instance, double period);
double beamgyro_plugin_step(void *instance, double time,
                            const double *signals);
void beamgyro_plugin_destroy(void *instance);
const char *const *beamgyro_plugin_training(void);

uint32_t beamgyro_plugin_abi(void) {{ return {1}; }}

const char *beamgyro_plugin_signals(void) {{
  return "{2}";
}}

void *beamgyro_plugin_create(void) {{ return malloc(sizeof({0}_state)); }}

int beamgyro_plugin_reset(void *instance, double period) {{
  return {0}_init(({0}_state *)instance, (float)period);
}}

double beamgyro_plugin_step(void *instance, double time,
                            const double *signals) {{
  {0}_sample sample;
  (void)time;
{3}  return (double){0}_step(({0}_state *)instance, &sample);
}}

void beamgyro_plugin_destroy(void *instance) {{ free(instance); }}

/* The runs that it was trained on. */
static const char *const training_runs[] = {{
{4}    NULL}};

const char *const *beamgyro_plugin_training(void) {{ return training_runs; }}

#ifdef __cplusplus
}}
#endif
)",
      name, BEAMGYRO_PLUGIN_ABI, signal_names(model),
      filled_sample(name, model), training_lines(compensator.provenance));
}

}  // namespace beamgyro::internal
