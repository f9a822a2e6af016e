// SPDX-License-Identifier: MIT
#include "compensation/export_c.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "compensation/c_text.h"
#include "compensation/export_self_test.h"
#include "compensation/firmware_model.h"

namespace beamgyro {
namespace {

std::string array_text(const FirmwareArray& array) {
  std::string text;
  if (!array.comment.empty()) text = fmt::format("/* {} */\n", array.comment);
  text += fmt::format("static const float {}[{}] = {{", array.name,
                      array.values.size());
  std::size_t column = 80;
  for (const float value : array.values) {
    const std::string next = c_literal(value) + ",";
    if (column + next.size() + 1 > 78) {
      text += "\n ";
      column = 1;
    }
    text += " " + next;
    column += next.size() + 1;
  }
  return text + "\n};\n";
}

bool has_filter(const Input& input) {
  return input.kind == InputKind::kTemperatureLowpass ||
         input.kind == InputKind::kTemperatureRate;
}

// Text of one compensator, written part by part.
class Writer {
 public:
  Writer(const Compensator& compensator, const std::string& name)
      : c_(compensator), name_(name), model_(compensator) {
    for (const Input& input : c_.inputs) {
      filters_ += has_filter(input) ? 1 : 0;
      clock_ = clock_ || input.kind == InputKind::kSincePowerOn;
    }
    const std::string kind = kind_name(c_.bias);
    uses_inputs_ = kind != "none" && kind != "constant";
    if (!uses_inputs_) filters_ = 0;
    clock_ = clock_ && uses_inputs_;
  }

  std::string header() const {
    std::string guard = name_ + "_H";
    std::transform(guard.begin(), guard.end(), guard.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    std::string text = fmt::format("#ifndef {0}\n#define {0}\n\n", guard);
    text += about();
    text +=
        "#include <stdint.h>\n\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n";
    text += fmt::format(
        "/* CRC-32 of the parameters. */\n#define {}_CRC "
        "0x{:08x}u\n\n",
        name_, model_.crc());
    if (model_.reads(kFirmwareDriveFrequency))
      text += fmt::format(
          "/* [Hz]; samples tell the change from it. */\n"
          "#define {}_DRIVE_FREQUENCY {}\n\n",
          name_, model_.drive_frequency());
    text += "/* One sample of the gyro. */\ntypedef struct {\n";
    for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
      if (model_.reads(k))
        text += fmt::format("  float {};\n", kFirmwareFields[k]);
    text += fmt::format("}} {}_sample;\n\n", name_);
    text += "typedef struct {\n";
    if (clock_)
      text +=
          "  float period;     /* [s] */\n"
          "  uint32_t samples; /* since power-on */\n";
    if (filters_ > 0)
      text += fmt::format(
          "  float filter[{}][5]; /* low-passes of the temperature */\n"
          "  int started;        /* they have their first temperature */\n",
          filters_);
    text += fmt::format(
        "  int clamped; /* the last temperature was out of range, or NaN */\n"
        "}} {}_state;\n\n",
        name_);
    text += fmt::format(
        "/* At every power-on. Samples then come every `period` seconds. 0, or "
        "-1 for a\n   period that is not above 0 or not finite. */\n"
        "int {0}_init({0}_state *state, float period);\n\n"
        "/* Compensated rate [deg/s] of the next sample; NaN when an input is, "
        "and filters\n   then wait for the next temperature. */\n"
        "float {0}_step({0}_state *state, const {0}_sample *sample);\n\n"
        "/* CRC-32 of the parameters as they lie in memory: {0}_CRC. */\n"
        "uint32_t {0}_crc(void);\n\n"
        "#ifdef __cplusplus\n}}\n#endif\n\n#endif\n",
        name_);
    return text;
  }

  std::string source() const {
    std::string text = fmt::format(
        "/* See {0}.h. The same bits everywhere need a compiler that does not "
        "contract\n   a * b + c: gcc and clang want -ffp-contract=off. */\n"
        "#include \"{0}.h\"\n\n#include <float.h>\n#include <string.h>\n\n",
        name_);
    for (const FirmwareArray& array : model_.arrays())
      text += array_text(array);
    text += "\n";
    text += runtime();
    if (uses_inputs_) text += bias_function();
    return text + crc_function() + init_function() + step_function();
  }

 private:
  std::string about() const {
    const Provenance& p = c_.provenance;
    std::string text = fmt::format(
        "/* Compensator of a gyro's drift: {}.\n   Compensated rate = (rate - "
        "bias){}.\n",
        c_comment(p.method), c_.scale_factor ? " / scale factor" : "");
    for (std::size_t i = 0; i < c_.inputs.size() && uses_inputs_; ++i)
      text += fmt::format("   x[{}]: {}\n", i, input_name(c_.inputs[i]));
    text += fmt::format(
        "   Valid from {:.2f} to {:.2f} degC; temperatures beyond are "
        "clamped.\n",
        c_.temperature_range.lowest, c_.temperature_range.highest);
    text += fmt::format("   Residual in training {:.4g} deg/s rms",
                        p.in_sample_rms);
    if (p.held_out_rms)
      text +=
          fmt::format(", on held-out runs {:.4g} deg/s rms", *p.held_out_rms);
    return text + ". */\n\n";
  }

  std::string runtime() const {
    std::string text;
    const std::string kind = kind_name(c_.bias);
    const auto add = [&](const char* section) {
      text += firmware_runtime(section) + "\n";
    };
    if (filters_ > 0 || clock_ || kind == "thermistor" || kind == "fuzzy")
      add("exp");
    if (filters_ > 0) add("lowpass");
    if (kind == "bp" && layers() > 2) add("tanh");
    if (kind == "polynomial" || kind == "spline" || kind == "thermistor" ||
        kind == "fuzzy")
      add(kind.c_str());
    if (kind == "table" || c_.scale_factor) add("table");
    add("crc");
    return text;
  }

  std::string crc_function() const {
    std::string text = fmt::format(
        "uint32_t {}_crc(void) {{\n  uint32_t crc = 0xffffffffu;\n", name_);
    for (const FirmwareArray& array : model_.arrays())
      text += fmt::format("  crc = crc_of(crc, {}, {});\n", array.name,
                          array.values.size());
    return text + "  return ~crc;\n}\n\n";
  }

  std::string init_function() const {
    std::string text = fmt::format(
        "int {0}_init({0}_state *state, float period) {{\n"
        "  if (!(period > 0.0f && period <= FLT_MAX)) return -1;\n"
        "  memset(state, 0, sizeof *state);\n",
        name_);
    if (clock_) text += "  state->period = period;\n";
    int filter = 0;
    for (std::size_t i = 0; i < c_.inputs.size() && uses_inputs_; ++i)
      if (has_filter(c_.inputs[i]))
        text += fmt::format(
            "  start_lowpass(state->filter[{}], period, time_constants[{}]);\n",
            filter++, i);
    return text + "  return 0;\n}\n\n";
  }

  std::string step_function() const;
  std::string input_lines() const;
  std::string bias_function() const;
  std::string network_lines() const;

  std::size_t layers() const {
    return std::get<BpNetwork>(c_.bias.function).layer_sizes().size();
  }

  const Compensator& c_;
  const std::string& name_;
  const FirmwareModel model_;
  int filters_ = 0;
  bool clock_ = false, uses_inputs_ = true;
};

std::string Writer::input_lines() const {
  std::string text;
  int filter = 0;
  for (std::size_t i = 0; i < c_.inputs.size(); ++i) {
    const Input& input = c_.inputs[i];
    std::string value = "T";
    switch (input.kind) {
      case InputKind::kColumn:
        for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
          if (input.column == kFirmwareSignals[k] && k != 1)
            value = fmt::format("sample->{}", kFirmwareFields[k]);
        break;
      case InputKind::kSincePowerOn:
        value =
            fmt::format("exp_minus(since_power_on / time_constants[{}])", i);
        break;
      case InputKind::kTemperatureLowpass:
        value = fmt::format("T - lowpass_lag(state->filter[{}], first, T)",
                            filter++);
        break;
      case InputKind::kTemperatureRate:
        value = fmt::format(
            "lowpass_lag(state->filter[{}], first, T) / time_constants[{}]",
            filter++, i);
        break;
    }
    text += fmt::format(
        "  x[{0}] = ({1} - centres_of_inputs[{0}]) * gains_of_inputs[{0}];\n",
        i, input.kind == InputKind::kColumn ? value : "(" + value + ")");
  }
  return text;
}

constexpr int kWrittenOut = 8;

// The weighted sum of one neuron: few terms are written out, so that no loop
// over them costs more than they do.
std::string sum_text(std::size_t layer, int terms, const std::string& from) {
  std::string text = fmt::format(
      "    const float *w = weights_{0} + o * {1};\n"
      "    float z = biases_{0}[o];\n",
      layer, terms);
  if (terms > kWrittenOut)
    return text +
           fmt::format("    for (i = 0; i < {}; ++i) z = z + w[i] * {}[i];\n",
                       terms, from);
  for (int i = 0; i < terms; ++i)
    text += fmt::format("    z = z + w[{0}] * {1}[{0}];\n", i, from);
  return text;
}

std::string Writer::network_lines() const {
  const std::vector<int>& sizes =
      std::get<BpNetwork>(c_.bias.function).layer_sizes();
  const std::size_t output = sizes.size() - 1;
  std::string arrays, text, from = "x";
  for (std::size_t k = 1; k < output; ++k) {
    text += fmt::format("  for (o = 0; o < {}; ++o) {{\n", sizes[k]) +
            sum_text(k, sizes[k - 1], from);
    from = fmt::format("a{}", k);
    if (k + 1 < output) {
      arrays += fmt::format("  float {}[{}];\n", from, sizes[k]);
      text += fmt::format("    {}[o] = tanh_of(z);\n  }}\n", from);
    } else {
      text += fmt::format("    y = y + weights_{}[o] * tanh_of(z);\n  }}\n",
                          output);
    }
  }
  if (output == 1)
    text = fmt::format(
        "  for (o = 0; o < {}; ++o) y = y + weights_1[o] * x[o];\n", sizes[0]);
  const bool loops = std::any_of(sizes.begin(), sizes.end() - 2,
                                 [](int terms) { return terms > kWrittenOut; });
  return fmt::format("  float y = biases_{}[0];\n{}  int {}o;\n", output,
                     arrays, loops ? "i, " : "") +
         text + "  return y;\n";
}

std::string Writer::bias_function() const {
  const std::string kind = kind_name(c_.bias);
  const auto count = [&](const char* name) {
    return model_.array(name).size();
  };
  std::string text;
  if (kind == "table")
    text = fmt::format("  return table_at(temperatures, values, {}, x[0]);\n",
                       count("values"));
  if (kind == "spline")
    text =
        fmt::format("  return spline_at(knots, values, seconds, {}, x[0]);\n",
                    count("values"));
  if (kind == "thermistor") text = "  return thermistor_at(network, x[0]);\n";
  if (kind == "fuzzy")
    text =
        fmt::format("  return fuzzy_of(centres, width[0], rules, {}, {}, x);\n",
                    count("centres"), c_.inputs.size());
  if (kind == "polynomial") {
    text = fmt::format("  float y = polynomial_of(coefficients, {}, x[0]);\n",
                       count("coefficients"));
    for (std::size_t j = 1; j < c_.inputs.size(); ++j)
      text += fmt::format("  y = y + slopes[{}] * x[{}];\n", j - 1, j);
    text += "  return y;\n";
  }
  if (kind == "bp") text = network_lines();
  return "static float bias_of(const float *x) {\n" + text + "}\n\n";
}

std::string Writer::step_function() const {
  std::string text = fmt::format(
      "float {0}_step({0}_state *state, const {0}_sample *sample) {{\n", name_);
  text += "  float T = sample->temperature_degC, y;\n";
  if (uses_inputs_) text += fmt::format("  float x[{}];\n", c_.inputs.size());
  if (filters_ > 0) text += "  const int first = !state->started;\n";
  if (clock_)
    text +=
        "  const float since_power_on = (float)state->samples * "
        "state->period;\n"
        "  if (state->samples < 0xffffffffu) ++state->samples;\n";
  text +=
      "  state->clamped = 0;\n"
      "  if (!(T >= range[0])) {\n"
      "    state->clamped = 1;\n"
      "    if (T != T) return T;\n"
      "    T = range[0];\n"
      "  } else if (T > range[1]) {\n"
      "    state->clamped = 1;\n"
      "    T = range[1];\n"
      "  }\n";
  if (filters_ > 0) text += "  state->started = 1;\n";
  if (uses_inputs_)
    text += input_lines() + "  y = bias_of(x);\n";
  else
    text +=
        kind_name(c_.bias) == "none" ? "  y = 0.0f;\n" : "  y = constant[0];\n";
  text += "  y = sample->rate_deg_per_s - (unit[0] + unit[1] * y);\n";
  if (c_.scale_factor)
    text += fmt::format(
        "  y = y / table_at(scale_factor_temperatures, scale_factors, {}, "
        "T);\n",
        model_.array("scale_factors").size());
  return text + "  return y;\n}\n";
}

}  // namespace

ExportedC export_c(const Compensator& compensator, const std::string& name) {
  const Writer writer(compensator, name);
  return {writer.header(), writer.source(),
          self_test_source(compensator, name)};
}

}  // namespace beamgyro
