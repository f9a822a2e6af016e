// SPDX-License-Identifier: MIT
#include "compensation/export_c.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <iterator>
#include <vector>

#include "compensation/firmware_model.h"

namespace beamgyro {
namespace {

// Shortest decimal that reads back to the same single.
std::string literal(float value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text + "f";
}

std::string array_text(const FirmwareArray& array) {
  std::string text;
  if (!array.comment.empty()) text = fmt::format("/* {} */\n", array.comment);
  text += fmt::format("static const float {}[{}] = {{", array.name,
                      array.values.size());
  std::size_t column = 80;
  for (const float value : array.values) {
    const std::string next = literal(value) + ",";
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
    text += "/* One sample of the gyro. */\ntypedef struct {\n";
    for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
      if (model_.reads(k))
        text += fmt::format("  float {};\n", kFirmwareFields[k]);
    text += fmt::format("}} {}_sample;\n\n", name_);
    text += fmt::format(
        "typedef struct {{\n  float period;      /* [s] */\n  uint32_t "
        "samples;  /* since power-on */\n  int clamped;       /* whether the "
        "last temperature was out of range */\n{}}} {}_state;\n\n",
        filters_ > 0
            ? fmt::format("  float filter[{}][4]; /* low-passes */\n", filters_)
            : "",
        name_);
    text += fmt::format(
        "/* At every power-on. Samples then come every `period` seconds. 0, or "
        "-1 for a\n   period that is not above 0. */\n"
        "int {0}_init({0}_state *state, float period);\n\n"
        "/* Compensated rate [deg/s] of the next sample. */\n"
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
        "#include \"{0}.h\"\n\n#include <string.h>\n\n",
        name_);
    for (const FirmwareArray& array : model_.arrays())
      text += array_text(array);
    text += "\n" + runtime();
    return text + crc_function() + init_function() + step_function();
  }

  std::string self_test() const;

 private:
  std::string about() const {
    const Provenance& p = c_.provenance;
    std::string text = fmt::format(
        "/* Compensator of a gyro's drift: {}.\n   Compensated rate = (rate - "
        "bias){}.\n",
        p.method, c_.scale_factor ? " / scale factor" : "");
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
        "  if (!(period > 0.0f)) return -1;\n"
        "  memset(state, 0, sizeof *state);\n"
        "  state->period = period;\n",
        name_);
    int filter = 0;
    for (std::size_t i = 0; i < c_.inputs.size() && uses_inputs_; ++i)
      if (has_filter(c_.inputs[i]))
        text += fmt::format(
            "  lowpass_init(state->filter[{}], period, time_constants[{}]);\n",
            filter++, i);
    return text + "  return 0;\n}\n\n";
  }

  std::string step_function() const;
  std::string input_lines() const;
  std::string bias_lines() const;
  std::string network_lines() const;

  std::size_t layers() const {
    return std::get<BpNetwork>(c_.bias.function).layer_sizes().size();
  }

  const Compensator& c_;
  const std::string& name_;
  mutable FirmwareModel model_;  // its state serves the golden samples
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
        value = fmt::format(
            "exp_minus((float)state->samples * state->period / "
            "time_constants[{}])",
            i);
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

std::string Writer::network_lines() const {
  const std::vector<int>& sizes =
      std::get<BpNetwork>(c_.bias.function).layer_sizes();
  std::string text, from = "x";
  for (std::size_t k = 1; k < sizes.size(); ++k) {
    const bool last = k + 1 == sizes.size();
    const std::string to = last ? "y" : fmt::format("a{}[o]", k);
    text += fmt::format(
        "  for (o = 0; o < {0}; ++o) {{\n"
        "    float z = biases_{1}[o];\n"
        "    for (i = 0; i < {2}; ++i) z = z + weights_{1}[o * {2} + i] * "
        "{3}[i];\n"
        "    {4} = {5};\n  }}\n",
        sizes[k], k, sizes[k - 1], from, to, last ? "z" : "tanh_of(z)");
    from = fmt::format("a{}", k);
  }
  return text;
}

std::string Writer::bias_lines() const {
  const std::string kind = kind_name(c_.bias);
  const auto count = [&](const char* name) {
    return model_.array(name).size();
  };
  if (kind == "none") return "  y = 0.0f;\n";
  if (kind == "constant") return "  y = constant[0];\n";
  if (kind == "table")
    return fmt::format("  y = table_at(temperatures, values, {}, x[0]);\n",
                       count("values"));
  if (kind == "spline")
    return fmt::format("  y = spline_at(knots, values, seconds, {}, x[0]);\n",
                       count("values"));
  if (kind == "thermistor") return "  y = thermistor_at(network, x[0]);\n";
  if (kind == "fuzzy")
    return fmt::format("  y = fuzzy_of(centres, width[0], rules, {}, {}, x);\n",
                       count("centres"), c_.inputs.size());
  if (kind == "polynomial") {
    std::string text =
        fmt::format("  y = polynomial_of(coefficients, {}, x[0]);\n",
                    count("coefficients"));
    for (std::size_t j = 1; j < c_.inputs.size(); ++j)
      text += fmt::format("  y = y + slopes[{}] * x[{}];\n", j - 1, j);
    return text;
  }
  return network_lines();
}

std::string Writer::step_function() const {
  std::string text = fmt::format(
      "float {0}_step({0}_state *state, const {0}_sample *sample) {{\n", name_);
  text += "  float T = sample->temperature_degC, y;\n";
  if (uses_inputs_) text += fmt::format("  float x[{}];\n", c_.inputs.size());
  if (filters_ > 0) text += "  const int first = state->samples == 0;\n";
  if (const auto* network = std::get_if<BpNetwork>(&c_.bias.function)) {
    const std::vector<int>& sizes = network->layer_sizes();
    for (std::size_t k = 1; k + 1 < sizes.size(); ++k)
      text += fmt::format("  float a{}[{}];\n", k, sizes[k]);
    text += "  int i, o;\n";
  }
  text +=
      "  state->clamped = !(T >= range[0]) || T > range[1];\n"
      "  if (!(T >= range[0])) T = range[0];\n"
      "  if (T > range[1]) T = range[1];\n";
  if (uses_inputs_) text += input_lines();
  text += "  if (state->samples < 0xffffffffu) ++state->samples;\n";
  text += bias_lines();
  text += "  y = sample->rate_deg_per_s - (unit[0] + unit[1] * y);\n";
  if (c_.scale_factor)
    text += fmt::format(
        "  y = y / table_at(scale_factor_temperatures, scale_factors, {}, "
        "T);\n",
        model_.array("scale_factors").size());
  return text + "  return y;\n}\n";
}

// What the self-test feeds: low + span u, u from a linear congruence.
struct GoldenRange {
  float low, span;
};

std::vector<GoldenRange> golden_ranges(const Compensator& c) {
  std::vector<GoldenRange> ranges(kFirmwareSignalCount, {-100.0f, 200.0f});
  const auto low = static_cast<float>(c.temperature_range.lowest);
  const auto high = static_cast<float>(c.temperature_range.highest);
  ranges[1] = {low - 5.0f, high - low + 10.0f};  // beyond both ends
  for (std::size_t i = 0; i < c.inputs.size(); ++i)
    for (std::size_t k = 2; k < kFirmwareSignalCount; ++k)
      if (c.inputs[i].column == kFirmwareSignals[k]) {
        const Scale& scale = c.bias.input_scales[i];
        ranges[k] = {static_cast<float>(scale.centre - scale.half_width),
                     static_cast<float>(2.0 * scale.half_width)};
      }
  return ranges;
}

constexpr float kGoldenPeriods[] = {0.01f, 0.1f, 1.0f, 20.0f};  // [s]

std::string Writer::self_test() const {
  const std::vector<GoldenRange> ranges = golden_ranges(c_);
  std::uint32_t random = 1;
  std::vector<float> answers;
  for (int k = 0; k < kGoldenSamples; ++k) {
    if (k % (kGoldenSamples / 4) == 0)
      model_.start(kGoldenPeriods[k / (kGoldenSamples / 4)]);
    FirmwareSample sample;
    for (std::size_t s = 0; s < kFirmwareSignalCount; ++s) {
      if (!model_.reads(s)) continue;
      random = random * 1664525u + 1013904223u;
      sample.value[s] =
          ranges[s].low + ranges[s].span * (static_cast<float>(random >> 8) *
                                            (1.0f / 16777216.0f));
    }
    answers.push_back(model_.step(sample));
  }
  std::string golden;
  for (int k = 0; k < kGoldenSamples; k += kGoldenStep)
    golden += fmt::format(
        "{}0x{:08x}u,", k / kGoldenStep % 6 == 0 ? "\n  " : " ",
        std::bit_cast<std::uint32_t>(answers[static_cast<std::size_t>(k)]));
  std::string fill;
  for (std::size_t s = 0; s < kFirmwareSignalCount; ++s)
    if (model_.reads(s))
      fill += fmt::format("    sample.{} = {} + {} * uniform();\n",
                          kFirmwareFields[s], literal(ranges[s].low),
                          literal(ranges[s].span));
  return fmt::format(
      R"(/* Runs {0} through {1} samples and compares with the bits expected: every
   {2}th answer, and the CRC-32 of all. Exit status 0 when they are equal. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "{0}.h"

static const uint32_t golden[{3}] = {{{4}
}};
static const float periods[4] = {{{5}, {6}, {7}, {8}}}; /* [s] */

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
  }}
  if (wrong != 0 || ~crc != 0x{11:08x}u) {{
    printf("{0}: %d of {3} answers differ, crc %08lx\n", wrong,
           (unsigned long)~crc);
    return 1;
  }}
  puts("{0}: {1} answers equal to the last bit");
  return 0;
}}
)",
      name_, kGoldenSamples, kGoldenStep, kGoldenSamples / kGoldenStep, golden,
      literal(kGoldenPeriods[0]), literal(kGoldenPeriods[1]),
      literal(kGoldenPeriods[2]), literal(kGoldenPeriods[3]),
      kGoldenSamples / 4, fill, crc32(answers));
}

}  // namespace

ExportedC export_c(const Compensator& compensator, const std::string& name) {
  const Writer writer(compensator, name);
  return {writer.header(), writer.source(), writer.self_test()};
}

std::string c_identifier(const std::string& text) {
  std::string name;
  for (const unsigned char c : text)
    name += std::isalnum(c) != 0 && c < 0x80 ? static_cast<char>(c) : '_';
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0)
    name.insert(0, "c_");
  return name;
}

}  // namespace beamgyro
