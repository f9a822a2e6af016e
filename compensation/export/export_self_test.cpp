// SPDX-License-Identifier: MIT
#include "compensation/export/export_self_test.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "compensation/export/firmware_model.h"
#include "compensation/firmware/c_text.h"

namespace beamgyro::internal {
namespace {

// Values of an input in the self-test: low + span u, with u from a linear
// congruence.
struct GoldenRange {
  float low, span;
};

std::vector<GoldenRange> golden_ranges(const FittedCompensator& c,
                                       const FirmwareModel& model) {
  std::vector<GoldenRange> ranges(kFirmwareSignalCount, {-100.0f, 200.0f});
  const auto low = static_cast<float>(c.temperature_range.lowest);
  const auto high = static_cast<float>(c.temperature_range.highest);
  ranges[1] = {low - 5.0f, high - low + 10.0f};  // beyond both ends
  for (std::size_t i = 0; i < c.inputs.size(); ++i)
    for (std::size_t k = 2; k < kFirmwareSignalCount; ++k)
      if (c.inputs[i].column == kFirmwareSignals[k]) {
        const Scale& scale = c.bias.input_scales[i];
        const double centre =
            scale.centre -
            (k == kFirmwareDriveFrequency ? model.drive_frequency() : 0);
        ranges[k] = {static_cast<float>(centre - scale.half_width),
                     static_cast<float>(2.0 * scale.half_width)};
      }
  return ranges;
}

constexpr float kGoldenPeriods[] = {0.01f, 0.1f, 1.0f, 20.0f};  // [s]

std::vector<float> golden_answers(FirmwareModel& model,
                                  const std::vector<GoldenRange>& ranges) {
  std::uint32_t random = 1;
  std::vector<float> answers;
  for (int k = 0; k < kGoldenSamples; ++k) {
    if (k % (kGoldenSamples / 4) == 0)
      model.start(kGoldenPeriods[k / (kGoldenSamples / 4)]);
    FirmwareSample sample;
    for (std::size_t s = 0; s < kFirmwareSignalCount; ++s) {
      if (!model.reads(s)) continue;
      random = random * 1664525u + 1013904223u;
      sample.value[s] =
          ranges[s].low + ranges[s].span * (static_cast<float>(random >> 8) *
                                            (1.0f / 16777216.0f));
    }
    answers.push_back(model.step(sample));
    if (model.states_sigma()) answers.push_back(model.sigma());
  }
  return answers;
}

// One row of bits for every kGoldenStep answers. `each` of them belong to a
// sample; the bits are of number `which`.
std::string golden_text(const std::vector<float>& answers, std::size_t each = 1,
                        std::size_t which = 0) {
  std::string text;
  for (std::size_t k = 0; k < kGoldenSamples; k += kGoldenStep)
    text +=
        fmt::format("{}0x{:08x}u,", k / kGoldenStep % 6 == 0 ? "\n  " : " ",
                    std::bit_cast<std::uint32_t>(answers[each * k + which]));
  return text;
}

// The further array and lines of a compensator with a sigma.
std::string golden_sigma_text(const std::vector<float>& answers) {
  return fmt::format("static const uint32_t golden_sigma[{}] = {{{}\n}};\n",
                     kGoldenSamples / kGoldenStep, golden_text(answers, 2, 1));
}

std::string sigma_check_text(const std::string& name) {
  return fmt::format(
      R"(    answer = {0}_sigma(&state);
    memcpy(&bits, &answer, sizeof bits);
    crc = crc_with(crc, bits);
    if (k % {1} == 0 && bits != golden_sigma[k / {1}]) ++wrong;
)",
      name, kGoldenStep);
}

std::string fill_text(const FirmwareModel& model,
                      const std::vector<GoldenRange>& ranges) {
  std::string text;
  for (std::size_t s = 0; s < kFirmwareSignalCount; ++s)
    if (model.reads(s))
      text += fmt::format("    sample.{} = {} + {} * uniform();\n",
                          kFirmwareFields[s], c_literal(ranges[s].low),
                          c_literal(ranges[s].span));
  return text;
}

}  // namespace

std::string self_test_source(const FittedCompensator& compensator,
                             const std::string& name) {
  FirmwareModel model(compensator);
  const std::vector<GoldenRange> ranges = golden_ranges(compensator, model);
  const std::vector<float> answers = golden_answers(model, ranges);
  return fmt::format(
      R"(/* Runs {0} through {1} samples and compares with the bits expected: every
   {2}th answer, and the CRC-32 of all. Exit status 0 when they are equal. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "{0}.h"

static const uint32_t golden[{3}] = {{{4}
}};
{12}static const float periods[4] = {{{5}, {6}, {7}, {8}}}; /* [s] */

static uint32_t state_of_uniform = 1;

static float uniform(void) {{
  state_of_uniform = state_of_uniform * 1664525u + 1013904223u;
  return (float)(state_of_uniform >> 8) * (1.0f / 16777216.0f);
}}

static uint32_t crc_with(uint32_t crc, uint32_t bits) {{
  int byte, bit;
  for (byte = 0; byte < 4; ++byte) {{
    crc ^= (bits >> (8 * byte)) & 0xffu;
    for (bit = 0; bit < 8; ++bit)
      crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
  }}
  return crc;
}}

int main(void) {{
  {0}_state state;
  {0}_sample sample;
  uint32_t crc = 0xffffffffu;
  int k, wrong = 0;
  if ({0}_crc() != {0}_CRC) {{
    puts("{0}: the parameters are damaged");
    return 1;
  }}
  for (k = 0; k < {1}; ++k) {{
    float answer;
    uint32_t bits;
    if (k % {9} == 0 && {0}_init(&state, periods[k / {9}]) != 0) return 1;
{10}    answer = {0}_step(&state, &sample);
    memcpy(&bits, &answer, sizeof bits);
    crc = crc_with(crc, bits);
    if (k % {2} == 0 && bits != golden[k / {2}]) ++wrong;
{13}  }}
  if (wrong != 0 || ~crc != 0x{11:08x}u) {{
    printf("{0}: %d of {3} answers differ, crc %08lx. Compile with "
           "-ffp-contract=off and without -ffast-math\n", wrong,
           (unsigned long)~crc);
    return 1;
  }}
  puts("{0}: {1} answers equal to the last bit");
  return 0;
}}
)",
      name, kGoldenSamples, kGoldenStep, kGoldenSamples / kGoldenStep,
      golden_text(answers, model.states_sigma() ? 2 : 1),
      c_literal(kGoldenPeriods[0]), c_literal(kGoldenPeriods[1]),
      c_literal(kGoldenPeriods[2]), c_literal(kGoldenPeriods[3]),
      kGoldenSamples / 4, fill_text(model, ranges), crc32(answers),
      model.states_sigma() ? golden_sigma_text(answers) : "",
      model.states_sigma() ? sigma_check_text(name) : "");
}

}  // namespace beamgyro::internal
