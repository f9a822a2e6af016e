// SPDX-License-Identifier: MIT
#include "api/model_description.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "api/program_version.h"
#include "dataset/recording/signals.h"
#include "sim/campaign/draw_plan.h"

namespace beamgyro::internal {
namespace {

std::string attribute(std::string_view name, std::string_view value) {
  std::string text = fmt::format(" {}=\"", name);
  for (const char c : value) switch (c) {
      case '&':
        text += "&amp;";
        break;
      case '<':
        text += "&lt;";
        break;
      case '"':
        text += "&quot;";
        break;
      default:
        text += c;
    }
  return text + '"';
}

std::string xml_number(std::string_view name, double value, bool whole) {
  return whole ? fmt::format(" {}=\"{:.0f}\"", name, value)
               : fmt::format(" {}=\"{}\"", name, value);
}

// Names, units and words of a variable where it has none itself.
FmuVariable described(FmuVariable variable) {
  if (variable.reference >= kFirstKey) {
    variable.unit = units_of(
        std::string_view(variable.name).substr(0, variable.name.find('[')));
  } else if (variable.description.empty()) {
    const bool is_status = variable.reference == kStatus;
    const RecordedSignal* signal = find_recorded_signal(variable.name);
    variable.unit = is_status ? "1" : signal->units;
    variable.description =
        is_status ? "1 unpowered, 2 output saturated, 4 loop not locked, added"
                  : signal->long_name;
  }
  // Per unit of rate, where a reader would divide twice.
  if (variable.unit == "V/degree/s") variable.unit = "V/(degree/s)";
  if (variable.unit == "1") variable.unit.clear();
  return variable;
}

bool is_calculated(const FmuVariable& variable) {
  return variable.causality == Causality::kOutput ||
         variable.causality == Causality::kLocal;
}

const char* causality_name(Causality causality) {
  switch (causality) {
    case Causality::kIndependent:
      return "independent";
    case Causality::kParameter:
      return "parameter";
    case Causality::kInput:
      return "input";
    case Causality::kOutput:
      return "output";
    case Causality::kLocal:
      break;
  }
  return "local";
}

const char* variability_of(const FmuVariable& variable) {
  if (variable.causality == Causality::kParameter) return "fixed";
  return variable.type == VariableType::kReal ? "continuous" : "discrete";
}

const char* xml_type(VariableType type, FmiVersion version) {
  const bool is_2 = version == FmiVersion::k2;
  switch (type) {
    case VariableType::kReal:
      return is_2 ? "Real" : "Float64";
    case VariableType::kInteger:
      return is_2 ? "Integer" : "Int32";
    case VariableType::kBoolean:
      return "Boolean";
    case VariableType::kUnsigned64:
      break;
  }
  return "UInt64";
}

// Attributes that both versions give to every variable.
std::string common_attributes(const FmuVariable& variable) {
  return attribute("name", variable.name) +
         fmt::format(" valueReference=\"{}\"", variable.reference) +
         attribute("description", variable.description) +
         attribute("causality", causality_name(variable.causality)) +
         attribute("variability", variability_of(variable)) +
         (is_calculated(variable) ? attribute("initial", "calculated") : "");
}

// Attributes of its type: unit, range, start.
std::string type_attributes(const FmuVariable& variable) {
  std::string text;
  const bool whole = variable.type != VariableType::kReal;
  const bool is_boolean = variable.type == VariableType::kBoolean;
  if (!variable.unit.empty()) text += attribute("unit", variable.unit);
  if (!is_boolean && std::isfinite(variable.low))
    text += xml_number("min", variable.low, whole);
  if (!is_boolean && std::isfinite(variable.high))
    text += xml_number("max", variable.high, whole);
  if (variable.causality != Causality::kParameter &&
      variable.causality != Causality::kInput)
    return text;
  if (is_boolean)
    return text + attribute("start", variable.start != 0 ? "true" : "false");
  return text + xml_number("start", variable.start, whole);
}

std::string variable_element(const FmuVariable& variable, FmiVersion version) {
  const char* type = xml_type(variable.type, version);
  if (version == FmiVersion::k3)
    return fmt::format("    <{}{}{}/>\n", type, common_attributes(variable),
                       type_attributes(variable));
  return fmt::format("    <ScalarVariable{}><{}{}/></ScalarVariable>\n",
                     common_attributes(variable), type,
                     type_attributes(variable));
}

std::string unit_elements(const std::vector<FmuVariable>& variables) {
  std::set<std::string> units;
  for (const FmuVariable& variable : variables)
    if (!variable.unit.empty()) units.insert(variable.unit);
  std::string text;
  for (const std::string& unit : units)
    text += fmt::format("    {}\n", unit_definition(unit));
  return text;
}

// FMI 2.0 counts variables from 1, FMI 3.0 names their value references.
std::string structure_elements(const std::vector<FmuVariable>& variables,
                               FmiVersion version) {
  std::string outputs, unknowns;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (variables[i].causality != Causality::kOutput) continue;
    if (version == FmiVersion::k2) {
      outputs += fmt::format("      <Unknown index=\"{}\"/>\n", i + 1);
    } else {
      const std::uint32_t reference = variables[i].reference;
      outputs +=
          fmt::format("    <Output valueReference=\"{}\"/>\n", reference);
      unknowns += fmt::format("    <InitialUnknown valueReference=\"{}\"/>\n",
                              reference);
    }
  }
  if (version == FmiVersion::k3) return outputs + unknowns;
  return fmt::format(
      "    <Outputs>\n{0}    </Outputs>\n    <InitialUnknowns>\n{0}    "
      "</InitialUnknowns>\n",
      outputs);
}

std::string co_simulation_element(FmiVersion version) {
  const std::string name = attribute("modelIdentifier", kFmuIdentifier);
  if (version == FmiVersion::k3)
    return fmt::format(
        "<CoSimulation{} canHandleVariableCommunicationStepSize=\"true\" "
        "canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"/>",
        name);
  return fmt::format(
      "<CoSimulation{} canHandleVariableCommunicationStepSize=\"true\" "
      "canInterpolateInputs=\"true\" canNotUseMemoryManagementFunctions="
      "\"true\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\"/>",
      name);
}

}  // namespace

std::string model_description(const PackedDevice& device, FmiVersion version,
                              const std::string& name) {
  std::vector<FmuVariable> variables;
  for (const FmuVariable& variable : fmu_variables(device, version))
    variables.push_back(described(variable));
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  const bool is_2 = version == FmiVersion::k2;
  text += fmt::format(
      "<fmiModelDescription fmiVersion=\"{}\"{}{}{}{}{}{}>\n",
      is_2 ? "2.0" : "3.0", attribute("modelName", name),
      attribute(is_2 ? "guid" : "instantiationToken", device.token()),
      attribute("description",
                fmt::format("vibrating-beam piezo gyro, {} fidelity",
                            device.fidelity() == StepFidelity::kEnvelope
                                ? "envelope"
                                : "quasi-static")),
      attribute("version", kProgramVersion),
      attribute("generationTool", std::string("beamgyro ") + kProgramVersion),
      attribute("variableNamingConvention", "structured"));
  text += fmt::format("  {}\n", co_simulation_element(version));
  text += fmt::format("  <UnitDefinitions>\n{}  </UnitDefinitions>\n",
                      unit_elements(variables));
  text +=
      "  <LogCategories><Category name=\"logStatusError\"/></LogCategories>\n"
      "  <DefaultExperiment startTime=\"0\" stopTime=\"10\" "
      "stepSize=\"0.01\"/>\n  <ModelVariables>\n";
  for (const FmuVariable& variable : variables)
    text += variable_element(variable, version);
  text += fmt::format(
      "  </ModelVariables>\n  <ModelStructure>\n{}  </ModelStructure>\n"
      "</fmiModelDescription>\n",
      structure_elements(variables, version));
  return text;
}

}  // namespace beamgyro::internal
