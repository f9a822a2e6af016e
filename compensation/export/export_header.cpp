// SPDX-License-Identifier: MIT
#include "compensation/export/export_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

#include "compensation/export/export_findings.h"
#include "compensation/firmware/c_text.h"

namespace beamgyro::internal {
namespace {

constexpr std::size_t kWidth = 79;

// One paragraph of a comment, its lines after the first indented.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string result, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > kWidth) {
      result += line + "\n";
      line = "  ";
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return result + line;
}

std::string about(const FittedCompensator& c, const FirmwareParts& parts,
                  double difference) {
  const Provenance& p = c.provenance;
  std::string text = fmt::format(
      "/* Compensator of a gyro's drift: {}.\n   Compensated rate = (rate - "
      "bias){}.\n",
      c_comment(p.method), c.scale_factor ? " / scale factor" : "");
  for (std::size_t i = 0; i < c.inputs.size() && parts.uses_inputs; ++i)
    text += fmt::format("   x[{}]: {}\n", i, input_name(c.inputs[i]));
  text += fmt::format(
      "   Valid from {:.2f} to {:.2f} degC; temperatures beyond are "
      "clamped.\n",
      c.temperature_range.lowest, c.temperature_range.highest);
  text +=
      fmt::format("   Residual in training {:.4g} deg/s rms", p.in_sample_rms);
  if (p.held_out_rms)
    text += fmt::format(", on held-out runs {:.4g} deg/s rms", *p.held_out_rms);
  text += fmt::format(
      ".\n   Largest difference from the workbench over that range: {:.2g} "
      "deg/s. */\n",
      difference);
  if (!c.sigma_not_known.empty())
    text += wrapped(fmt::format("/* States no sigma: {}. */",
                                c_comment(c.sigma_not_known))) +
            "\n";
  return text + warning_comments(p.warnings);
}

std::string macros(const std::string& name, const FirmwareModel& model,
                   const FirmwareDifference& difference) {
  const std::vector<float>& range = model.arrays().values("range");
  std::string text = fmt::format(
      "/* CRC-32 of the parameters. */\n#define {0}_CRC 0x{1:08x}u\n\n"
      "/* [degC], seen in training. */\n"
      "#define {0}_TEMPERATURE_LOWEST {2}\n#define {0}_TEMPERATURE_HIGHEST {3}"
      "\n\n"
      "/* Largest difference [deg/s] from the workbench, met at sample "
      "periods [s]\n   between these. */\n"
      "#define {0}_DIFFERENCE {4}\n"
      "#define {0}_PERIOD_SHORTEST {5}\n#define {0}_PERIOD_LONGEST {6}\n\n",
      name, model.crc(), c_literal(range[0]), c_literal(range[1]),
      c_literal(static_cast<float>(difference.rate)),
      c_literal(*std::ranges::min_element(kComparedPeriods)),
      c_literal(*std::ranges::max_element(kComparedPeriods)));
  if (model.states_sigma())
    text += fmt::format(
        "/* The same of {0}_sigma. */\n#define {0}_SIGMA_DIFFERENCE {1}\n\n",
        name, c_literal(static_cast<float>(difference.sigma)));
  if (model.reads(kFirmwareDriveFrequency))
    text += fmt::format(
        "/* [Hz]; samples hold the difference from it. */\n"
        "#define {}_DRIVE_FREQUENCY {}\n\n",
        name, model.drive_frequency());
  return text;
}

std::string structures(const std::string& name, const FirmwareModel& model,
                       const FirmwareParts& parts) {
  std::string text = "/* One sample of the gyro. */\ntypedef struct {\n";
  for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
    if (model.reads(k))
      text += fmt::format("  float {};\n", kFirmwareFields[k]);
  text += fmt::format("}} {}_sample;\n\ntypedef struct {{\n", name);
  if (parts.clock)
    text +=
        "  float period;     /* [s] */\n"
        "  uint32_t samples; /* since power-on */\n";
  if (parts.filters > 0)
    text +=
        fmt::format("  float filter[{}][5]; /* low-passes */\n", parts.filters);
  if (parts.plays > 0)
    text += fmt::format(
        "  float play[{}];      /* play operators of the temperature */\n",
        parts.plays);
  if (parts.follows_temperature())
    text += "  int started;        /* they have their first temperature */\n";
  if (model.states_sigma())
    text +=
        "  float sigma; /* of the last rate [deg/s] */\n"
        "  float sigma_period, sigma_filter[5];\n"
        "  uint32_t sigma_samples;\n"
        "  int sigma_started;\n";
  return text +
         fmt::format(
             "  int clamped; /* the last temperature was out of range, or not "
             "finite */\n}} {}_state;\n\n",
             name);
}

std::string sigma_function(const std::string& name) {
  return fmt::format(
      "/* 1-sigma [deg/s] of the bias of the rate that {0}_step returned last; "
      "NaN after\n   a temperature that is NaN or infinite. It takes the "
      "temperature as measured,\n   not clamped. */\n"
      "float {0}_sigma(const {0}_state *state);\n\n",
      name);
}

std::string functions(const std::string& name) {
  return fmt::format(
      "/* At every power-on. Samples then come every `period` seconds. 0, or "
      "-1 for a\n   period that is not above 0 or not finite. */\n"
      "int {0}_init({0}_state *state, float period);\n\n"
      "/* Compensated rate [deg/s] of the next sample; NaN when an input is "
      "NaN or\n   infinite. Filters then wait for the next finite temperature. "
      "*/\n"
      "float {0}_step({0}_state *state, const {0}_sample *sample);\n\n"
      "/* CRC-32 of the parameters as they lie in memory: {0}_CRC. */\n"
      "uint32_t {0}_crc(void);\n\n",
      name);
}

}  // namespace

bool has_filter(const Input& input) {
  return input.kind == InputKind::kLowpass ||
         input.kind == InputKind::kTemperatureRate;
}

bool has_play(const Input& input) {
  return input.kind == InputKind::kTemperaturePlay;
}

FirmwareParts::FirmwareParts(const FittedCompensator& c) {
  uses_inputs = reads_inputs(c.bias);
  if (!uses_inputs) return;
  for (const Input& input : c.inputs) {
    filters += has_filter(input) ? 1 : 0;
    plays += has_play(input) ? 1 : 0;
    clock = clock || input.kind == InputKind::kSincePowerOn;
    reads_more = reads_more || reads_a_signal(input);
  }
}

std::string header_text(const FittedCompensator& compensator,
                        const std::string& name, const FirmwareModel& model,
                        const ExportFindings& found) {
  const FirmwareParts parts(compensator);
  std::string guard = name + "_H";
  std::ranges::transform(guard, guard.begin(), [](unsigned char c) {
    return static_cast<char>(std::toupper(c));
  });
  return fmt::format("#ifndef {0}\n#define {0}\n\n", guard) +
         warning_comments(found.objections) +
         about(compensator, parts, found.difference.rate) +
         "\n#include <stdint.h>\n\n#ifdef __cplusplus\nextern \"C\" "
         "{\n#endif\n\n" +
         macros(name, model, found.difference) +
         structures(name, model, parts) + functions(name) +
         (model.states_sigma() ? sigma_function(name) : "") +
         "#ifdef __cplusplus\n}\n#endif\n\n#endif\n";
}

std::string warning_comments(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings)
    text +=
        wrapped(fmt::format("/* WARNING: {}. */", c_comment(warning))) + "\n";
  return text;
}

}  // namespace beamgyro::internal
