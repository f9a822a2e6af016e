// SPDX-License-Identifier: MIT
#include "sim/scenario/scenario_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "config/config_node.h"
#include "config/file_error.h"
#include "config/units.h"
#include "sim/thermal/thermal_parameters.h"

namespace beamgyro::internal {
namespace {

// Unit of the numbers of a profile in files: value = file value x factor +
// offset. `range` limits the file value.
struct ProfileUnit {
  std::string csv_column;
  double factor, offset;
  Range range;
};

struct Knots {
  std::vector<double> time, value;
};

// Rows [t, value] with times that increase and values in range.
Knots read_rows(const ConfigTable& table, std::string_view key,
                const ProfileUnit& unit) {
  Knots knots;
  const auto rows = table.rows(key, 2);
  if (rows.empty()) table.fail(key, "[] is empty; expected at least one point");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t = rows[i][0], value = rows[i][1];
    if (!knots.time.empty() && t <= knots.time.back()) {
      table.fail(key, i,
                 fmt::format("time {} s does not come after {} s; expected "
                             "increasing times",
                             t, knots.time.back()));
    }
    if (!unit.range.contains(value)) {
      table.fail(key, i,
                 fmt::format("{} is out of range; expected {}", value,
                             text_of(unit.range)));
    }
    knots.time.push_back(t);
    knots.value.push_back(value * unit.factor + unit.offset);
  }
  return knots;
}

PiecewiseLinear profile_of(const CsvTable& csv, const ProfileUnit& unit) {
  std::vector<double> time = csv.column("time_s");
  std::vector<double> value = csv.column(unit.csv_column);
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (i > 0 && time[i] <= time[i - 1]) {
      throw std::invalid_argument(fmt::format(
          "{}: time_s {} does not come after {}; expected increasing times",
          csv.place(i), time[i], time[i - 1]));
    }
    if (!unit.range.contains(value[i])) {
      throw std::invalid_argument(
          fmt::format("{}: {} {} is out of range; expected {}", csv.place(i),
                      unit.csv_column, value[i], text_of(unit.range)));
    }
    value[i] = value[i] * unit.factor + unit.offset;
  }
  return {std::move(time), std::move(value)};
}

// The one key among `forms` that `table` holds.
std::string only_form(const ConfigTable& table,
                      const std::vector<std::string>& forms) {
  std::vector<std::string> present;
  for (const std::string& form : forms) {
    if (table.has(form)) present.push_back(form);
  }
  if (present.size() == 1) return present.front();
  if (present.empty()) {
    const std::vector<std::string> keys = table.keys();
    table.fail(forms[0],
               fmt::format("missing{}; expected one of {}",
                           keys.empty() ? ""
                                        : fmt::format(", beside {}",
                                                      fmt::join(keys, ", ")),
                           fmt::join(forms, ", ")));
  }
  table.fail(present[1], fmt::format("given beside {}; expected only one of {}",
                                     present[0], fmt::join(forms, ", ")));
}

// Reads `points = [[t_s, value], ...]`, with straight lines between the points.
PiecewiseLinear read_points(const ConfigTable& table, const ProfileUnit& unit) {
  Knots knots = read_rows(table, "points", unit);
  return {std::move(knots.time), std::move(knots.value)};
}

// Reads `steps = [[t_s, value], ...]`; each value is held until the next.
PiecewiseLinear read_steps(const ConfigTable& table, const ProfileUnit& unit) {
  const Knots steps = read_rows(table, "steps", unit);
  Knots knots{{steps.time[0]}, {steps.value[0]}};
  for (std::size_t i = 1; i < steps.time.size(); ++i) {
    knots.time.insert(knots.time.end(), 2, steps.time[i]);
    knots.value.push_back(steps.value[i - 1]);
    knots.value.push_back(steps.value[i]);
  }
  return {std::move(knots.time), std::move(knots.value)};
}

// The folder of profile files. Names are relative to `path`. A file that is in
// `tables` is not read again; `tables` may be null.
struct ProfileFolder {
  std::filesystem::path path;
  const ProfileTables* tables;
};

// Reads `file = "profile.csv"` with the columns time_s and `unit.csv_column`.
PiecewiseLinear read_profile_file(const ConfigTable& table,
                                  const ProfileUnit& unit,
                                  const ProfileFolder& folder) {
  const std::filesystem::path path = folder.path / table.text("file");
  if (folder.tables != nullptr) {
    const auto known = folder.tables->find(path.lexically_normal());
    if (known != folder.tables->end()) return profile_of(known->second, unit);
  }
  if (!std::filesystem::is_regular_file(status_of(path))) {
    table.fail("file", fmt::format("\"{}\" is no file; expected a CSV file",
                                   path.string()));
  }
  return profile_of(read_csv(path), unit);
}

constexpr double kHour = 3600;               // [s]
constexpr Range kAge{0, 1e6, false, false};  // [h], 114 years
constexpr double kLargestRecording = 5e7;    // samples, 12 GB at work

const ProfileUnit kAmbient{"temperature_degC", 1, kZeroCelsius,
                           kMaterialTemperatures};

// Higher frequencies of a motion are outside of the validity of the models.
constexpr Range kMotionFrequency{0, 1e3, true, false};  // [Hz]

// How the motion about or along one axis is written.
struct MotionKeys {
  ProfileUnit unit;
  std::string suffix;  // of constant_, amplitude_, offset_, rms_
};
const MotionKeys kRate{{"rate_deg_per_s", kDegree, 0, between(-1e4, 1e4)},
                       "deg_per_s"};
const MotionKeys kAcceleration{
    {"acceleration_g", kStandardGravity, 0, between(-1e3, 1e3)}, "g"};

Fidelity read_fidelity(const ConfigTable& root) {
  const std::string name =
      root.choice("fidelity", {"quasistatic", "envelope", "carrier"});
  if (name == "envelope") return Fidelity::kEnvelope;
  if (name == "carrier") return Fidelity::kCarrier;
  return Fidelity::kQuasistatic;
}

bool is_after(double t, double before) {
  return t > before && !is_same_time(t, before);
}

std::vector<PowerInterval> read_power(const ConfigTable& power) {
  if (!power.has("on_s") && !power.has("off_s")) return {{.on = 0}};
  const std::vector<double> on = power.numbers("on_s");
  const std::vector<double> off =
      power.has("off_s") ? power.numbers("off_s") : std::vector<double>();
  if (on.empty()) power.fail("on_s", "[] is empty; expected a time in s");
  if (off.size() > on.size() || off.size() + 1 < on.size()) {
    power.fail(off.empty() ? "on_s" : "off_s",
               fmt::format("{} times off for {} times on; expected one off "
                           "after each on, the last may be missing",
                           off.size(), on.size()));
  }
  std::vector<PowerInterval> intervals;
  for (std::size_t i = 0; i < on.size(); ++i) {
    if (i > 0 && !is_after(on[i], off[i - 1])) {
      power.fail("on_s", i,
                 fmt::format("{} s does not come after off_s = {} s; expected "
                             "on and off in turn",
                             on[i], off[i - 1]));
    }
    if (i < off.size() && !is_after(off[i], on[i])) {
      power.fail("off_s", i,
                 fmt::format("{} s does not come after on_s = {} s; expected "
                             "on and off in turn",
                             off[i], on[i]));
    }
    intervals.push_back({on[i], i < off.size()
                                    ? off[i]
                                    : std::numeric_limits<double>::infinity()});
  }
  return intervals;
}

// Hold at each temperature, ramp to the next at a constant rate.
PiecewiseLinear read_soaks(const ConfigTable& soaks, const ProfileUnit& unit,
                           std::vector<double>& ends) {
  const std::vector<double> levels =
      soaks.numbers("temperatures_degC", unit.range);
  if (levels.empty()) {
    soaks.fail("temperatures_degC",
               "[] is empty; expected at least one temperature in degC");
  }
  const double hold = soaks.number("hold_s", positive());
  const double ramp = soaks.number("ramp_K_per_min", positive()) / 60;
  std::vector<double> time, value;
  double t = 0;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (i > 0) t += std::abs(levels[i] - levels[i - 1]) / ramp;
    for (const double end : {t, t + hold}) {
      // Two soaks at one temperature: the second starts where the first ends.
      if (!time.empty() && end == time.back() &&
          value.back() == levels[i] + unit.offset) {
        continue;
      }
      time.push_back(end);
      value.push_back(levels[i] + unit.offset);
    }
    t += hold;
    ends.push_back(t);
  }
  return {std::move(time), std::move(value)};
}

PiecewiseLinear read_ambient(const ConfigTable& ambient,
                             const ProfileFolder& folder,
                             std::vector<double>& soak_ends) {
  const std::string form =
      only_form(ambient, {"constant_degC", "points", "soaks", "file"});
  const double offset = ambient.number_or("offset_K", 0, between(-100, 100));
  const ProfileUnit unit{
      kAmbient.csv_column, kAmbient.factor, kAmbient.offset + offset,
      between(kAmbient.range.low - offset, kAmbient.range.high - offset)};
  if (form == "points") return read_points(ambient, unit);
  if (form == "soaks")
    return read_soaks(ambient.table("soaks"), unit, soak_ends);
  if (form == "file") return read_profile_file(ambient, unit, folder);
  return PiecewiseLinear::constant(ambient.number(form, unit.range) +
                                   unit.offset);
}

// What the unit has been through before the run.
std::optional<PiecewiseLinear> read_history(
    const std::optional<ConfigTable>& history) {
  if (!history) return {};
  only_form(*history, {"points"});
  return read_points(*history, kAmbient);
}

SineSignal read_sine(const ConfigTable& sine, const MotionKeys& keys) {
  const auto& [column, factor, zero, range] = keys.unit;
  return {
      .offset = sine.number_or("offset_" + keys.suffix, 0, range) * factor,
      .amplitude = sine.number("amplitude_" + keys.suffix, range) * factor,
      .frequency = sine.number("frequency_Hz", kMotionFrequency),
      .phase = sine.number_or("phase_rad", 0),
  };
}

RandomRate read_random(const ConfigTable& random, const MotionKeys& keys,
                       double duration) {
  const RandomRate rate{
      .rms = random.number("rms_" + keys.suffix,
                           {0, keys.unit.range.high, true, false}) *
             keys.unit.factor,
      .bandwidth = random.number("bandwidth_Hz", kMotionFrequency),
  };
  if (16 * rate.bandwidth * duration > kLargestRecording / 10) {
    random.fail("bandwidth_Hz",
                fmt::format("{} Hz over {} s needs more than {:g} support "
                            "points; expected a lower bandwidth",
                            rate.bandwidth, duration, kLargestRecording / 10));
  }
  return rate;
}

RateProfile read_motion(const std::optional<ConfigTable>& axis,
                        const MotionKeys& keys, const ProfileFolder& folder,
                        double duration) {
  if (!axis) return PiecewiseLinear::constant(0);
  const std::string constant = "constant_" + keys.suffix;
  const std::string form =
      only_form(*axis, {constant, "points", "steps", "sine", "random", "file"});
  if (form == "points") return read_points(*axis, keys.unit);
  if (form == "steps") return read_steps(*axis, keys.unit);
  if (form == "sine") return read_sine(axis->table("sine"), keys);
  if (form == "random")
    return read_random(axis->table("random"), keys, duration);
  if (form == "file") return read_profile_file(*axis, keys.unit, folder);
  return PiecewiseLinear::constant(axis->number(form, keys.unit.range) *
                                   keys.unit.factor);
}

std::optional<ConfigTable> axis_table(const ConfigTable& root,
                                      std::string_view key) {
  const std::size_t dot = key.find('.');
  if (dot == key.npos) return root.optional_table(key);
  return root.table_or_empty(key.substr(0, dot))
      .optional_table(key.substr(dot + 1));
}

}  // namespace

ScenarioPlan read_scenario(const ConfigDocument& document,
                           const ProfileTables* profiles) {
  const ConfigTable& root = document.root();
  const ProfileFolder folder{document.path().parent_path(), profiles};
  ScenarioPlan scenario;
  scenario.name = root.text("name");
  scenario.description = root.text_or("description", "");
  scenario.device_file = folder.path / root.text("device");
  scenario.fidelity = read_fidelity(root);
  scenario.duration = root.number("duration_s", positive());
  scenario.output_rate =
      root.number("output_rate_Hz",
                  {0, highest_output_rate(scenario.fidelity), true, false});
  const double samples = scenario.duration * scenario.output_rate;
  if (samples > kLargestRecording || sample_count(scenario) == 0) {
    root.fail("duration_s",
              fmt::format("{} s at {} Hz makes {:.6g} samples; expected 1 to "
                          "{:g}",
                          scenario.duration, scenario.output_rate,
                          std::floor(samples), kLargestRecording));
  }
  scenario.seed = static_cast<std::uint64_t>(
      root.integer("seed", 0, std::numeric_limits<long>::max()));
  const ConfigTable age = root.table_or_empty("age");
  scenario.has_age = age.has("hours");
  scenario.age = age.number_or("hours", 0, kAge) * kHour;
  scenario.powered = read_power(root.table_or_empty("power"));
  scenario.ambient =
      read_ambient(root.table("ambient"), folder, scenario.soak_ends);
  scenario.history = read_history(root.optional_table("history"));
  scenario.stirred = root.table_or_empty("chamber").flag_or("stirred", false);
  for (std::size_t i = 0; i < kCaseAxisCount; ++i)
    scenario.motion[i] = read_motion(axis_table(root, kCaseAxes[i].key),
                                     i < kAccelerationX ? kRate : kAcceleration,
                                     folder, scenario.duration);
  scenario.noise_enabled =
      root.table_or_empty("noise").flag_or("enabled", true);
  return scenario;
}

std::vector<std::filesystem::path> profile_files(
    const ConfigDocument& document) {
  std::vector<std::filesystem::path> files;
  const auto add = [&](std::string_view table) {
    const ConfigNode* file = document.value(fmt::format("{}.file", table));
    if (file != nullptr)
      files.push_back(document.path().parent_path() / file->text);
  };
  add("ambient");
  for (const AxisNames& axis : kCaseAxes) add(axis.key);
  return files;
}

}  // namespace beamgyro::internal
