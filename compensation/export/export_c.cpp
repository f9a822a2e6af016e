// SPDX-License-Identifier: MIT
#include "compensation/export/export_c.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "compensation/export/export_header.h"
#include "compensation/export/export_plugin.h"
#include "compensation/export/firmware_model.h"
#include "compensation/firmware/c_text.h"
#include "compensation/firmware/runtime.h"
#include "config/option_message.h"

namespace beamgyro::internal {
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

FirmwareCode code_of(const FittedCompensator& c) {
  return std::visit(
      [&]<class Function>(const Function& f) -> FirmwareCode {
        if constexpr (Function::kInputUse == InputUse::kNone)
          return {};
        else
          return f.firmware_code(c.inputs.size());
      },
      c.bias.function);
}

// Where a sample has what an input reads.
std::string field_of(const Input& input) {
  for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
    if (reads_a_signal(input) && input.column == kFirmwareSignals[k])
      return fmt::format("sample->{}", kFirmwareFields[k]);
  return "T";
}

// Text of one compensator, written part by part.
class Writer {
 public:
  Writer(const FittedCompensator& compensator, const std::string& name,
         const FirmwareModel& model)
      : c_(compensator),
        name_(name),
        model_(model),
        parts_(c_),
        code_(code_of(c_)) {}

  std::string source(const std::vector<std::string>& warnings) const {
    std::string text = fmt::format(
        "/* See {0}.h. The same bits everywhere need a compiler that does not "
        "contract\n   a * b + c: gcc and clang want -ffp-contract=off, and "
        "never -ffast-math. */\n"
        "#include \"{0}.h\"\n\n#include <float.h>\n#include <string.h>\n\n"
        "#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0 && "
        "FLT_EVAL_METHOD != 16\n"
        "#error \"{0} needs float arithmetic in single precision "
        "(FLT_EVAL_METHOD 0); on x87: -msse2 -mfpmath=sse\"\n"
        "#endif\n\n",
        name_);
    text += warning_comments(warnings);
    for (const FirmwareArray& array : model_.arrays().all())
      text += array_text(array);
    text += "\n";
    text += runtime();
    if (parts_.uses_inputs)
      text += "static float bias_of(const float *x) {\n" + code_.body + "}\n\n";
    text += crc_function() + init_function();
    if (c_.sigma) text += sigma_functions();
    return text + step_function();
  }

 private:
  // Sections of the run-time that the code calls.
  std::string runtime() const {
    std::vector<std::string_view> called = code_.sections;
    if (parts_.filters > 0) called.insert(called.end(), {"exp", "lowpass"});
    if (parts_.plays > 0) called.push_back("play");
    if (parts_.clock) called.push_back("exp");
    if (parts_.reads_more) called.push_back("finite");
    if (c_.scale_factor) called.push_back("table");
    if (c_.sigma)
      called.insert(called.end(),
                    {"exp", "lowpass", "finite", "table", "root", "sigma"});
    called.push_back("crc");
    std::string text;
    for (const std::string_view section : runtime_sections())
      if (std::ranges::find(called, section) != called.end())
        text += runtime_text(section) + "\n";
    return text;
  }

  std::string crc_function() const {
    std::string text = fmt::format(
        "uint32_t {}_crc(void) {{\n  uint32_t crc = 0xffffffffu;\n", name_);
    for (const FirmwareArray& array : model_.arrays().all())
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
    if (parts_.clock) text += "  state->period = period;\n";
    int filter = 0;
    for (std::size_t i = 0; i < c_.inputs.size() && parts_.uses_inputs; ++i)
      if (has_filter(c_.inputs[i]))
        text += fmt::format(
            "  start_lowpass(state->filter[{}], period, time_constants[{}]);\n",
            filter++, i);
    if (c_.sigma)
      text +=
          "  state->sigma_period = period;\n"
          "  start_lowpass(state->sigma_filter, period, sigma_terms[3]);\n";
    return text + "  return 0;\n}\n\n";
  }

  std::string sigma_functions() const;

  std::string step_function() const;
  std::string input_lines() const;
  std::string finite_lines() const;

  const FittedCompensator& c_;
  const std::string& name_;
  const FirmwareModel& model_;
  const FirmwareParts parts_;
  const FirmwareCode code_;
};

std::string Writer::input_lines() const {
  std::string text;
  int filter = 0, play = 0;
  for (std::size_t i = 0; i < c_.inputs.size(); ++i) {
    const Input& input = c_.inputs[i];
    const std::string source = field_of(input);
    std::string value;
    switch (input.kind) {
      case InputKind::kColumn:
        value = source;
        break;
      case InputKind::kSincePowerOn:
        value =
            fmt::format("exp_minus(since_power_on / time_constants[{}])", i);
        break;
      case InputKind::kLowpass:
        value = fmt::format("{1} - lowpass_lag(state->filter[{0}], first, {1})",
                            filter++, source);
        break;
      case InputKind::kTemperatureRate:
        value = fmt::format(
            "lowpass_lag(state->filter[{}], first, T) / time_constants[{}]",
            filter++, i);
        break;
      case InputKind::kTemperaturePlay:
        value = fmt::format(
            "play_at(&state->play[{}], first, T, half_widths[{}])", play++, i);
        break;
    }
    text += fmt::format(
        "  x[{0}] = ({1} - centres_of_inputs[{0}]) * gains_of_inputs[{0}];\n",
        i, input.kind == InputKind::kColumn ? value : "(" + value + ")");
  }
  return text;
}

// Returns NaN for inputs that are not finite. The temperature was checked
// before.
std::string Writer::finite_lines() const {
  std::string text;
  for (std::size_t i = 0; i < c_.inputs.size(); ++i)
    if (reads_a_signal(c_.inputs[i]))
      text +=
          fmt::format("  if (!is_finite(x[{0}])) return x[{0}] - x[{0}];\n", i);
  return text;
}

std::string Writer::sigma_functions() const {
  std::string text = fmt::format(
      R"(static float next_sigma({0}_state *state, float T) {{
  const float since = (float)state->sigma_samples * state->sigma_period;
  const int first = !state->sigma_started;
  float on, lag, sigma;
  if (state->sigma_samples < 0xffffffffu) ++state->sigma_samples;
  if (!is_finite(T)) return T - T;
  if (T < {2}) T = {2};
  if (T > {3}) T = {3};
  state->sigma_started = 1;
  on = sigma_terms[0] * exp_minus(since / sigma_terms[1]);
  lag = lowpass_lag(state->sigma_filter, first, T);
  sigma = sigma_at(sigma_temperatures, sigmas, {1}, sigma_growth, T, on,
                   sigma_terms[2] * (lag / sigma_terms[3]));
)",
      name_, model_.arrays().count("sigmas"),
      c_literal(static_cast<float>(kSigmaTemperatures.lowest)),
      c_literal(static_cast<float>(kSigmaTemperatures.highest)));
  if (c_.scale_factor)
    text += fmt::format(
        "  if (T < range[0]) T = range[0];\n"
        "  if (T > range[1]) T = range[1];\n"
        "  sigma = sigma / table_at(scale_factor_temperatures, scale_factors, "
        "{}, T);\n",
        model_.arrays().count("scale_factors"));
  return text + fmt::format(
                    "  return sigma;\n}}\n\n"
                    "float {0}_sigma(const {0}_state *state) {{ return "
                    "state->sigma; }}\n\n",
                    name_);
}

std::string Writer::step_function() const {
  std::string text = fmt::format(
      "float {0}_step({0}_state *state, const {0}_sample *sample) {{\n", name_);
  text += "  float T = sample->temperature_degC, y;\n";
  if (parts_.uses_inputs)
    text += fmt::format("  float x[{}];\n", c_.inputs.size());
  if (parts_.follows_temperature())
    text += "  const int first = !state->started;\n";
  if (parts_.clock)
    text +=
        "  const float since_power_on = (float)state->samples * "
        "state->period;\n"
        "  if (state->samples < 0xffffffffu) ++state->samples;\n";
  if (c_.sigma) text += "  state->sigma = next_sigma(state, T);\n";
  text +=
      "  state->clamped = 0;\n"
      "  if (!(T >= range[0])) {\n"
      "    state->clamped = 1;\n"
      "    if (!(T >= -FLT_MAX)) return T - T;\n"
      "    T = range[0];\n"
      "  } else if (T > range[1]) {\n"
      "    state->clamped = 1;\n"
      "    if (T > FLT_MAX) return T - T;\n"
      "    T = range[1];\n"
      "  }\n";
  for (const Input& input : c_.inputs)
    if (parts_.uses_inputs && filters_a_signal(input))
      text += fmt::format("  if (!is_finite({0})) return {0} - {0};\n",
                          field_of(input));
  if (parts_.follows_temperature()) text += "  state->started = 1;\n";
  if (parts_.uses_inputs)
    text += input_lines() + finite_lines() + "  y = bias_of(x);\n";
  else
    text += std::holds_alternative<NoBias>(c_.bias.function)
                ? "  y = 0.0f;\n"
                : "  y = constant[0];\n";
  text += "  y = sample->rate_deg_per_s - (unit[0] + unit[1] * y);\n";
  if (c_.scale_factor)
    text += fmt::format(
        "  y = y / table_at(scale_factor_temperatures, scale_factors, {}, "
        "T);\n",
        model_.arrays().count("scale_factors"));
  return text + "  return y;\n}\n";
}

}  // namespace

ExportedC export_c(const FittedCompensator& compensator,
                   const std::string& name, bool force) {
  const FirmwareModel model(compensator);
  const ExportFindings found = findings_of(compensator);
  if (!force && !found.objections.empty())
    throw option_error("{}; {} exports it with this warning",
                       found.objections[0], NamedOption{"force"});
  const Writer writer(compensator, name, model);
  return {header_text(compensator, name, model, found),
          writer.source(found.objections), self_test_source(compensator, name),
          plugin_source(compensator, name, model), found.objections};
}

}  // namespace beamgyro::internal
