// SPDX-License-Identifier: MIT
#include "report/validation_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

namespace beamgyro::internal {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kClaimed = "claimed by the file";

/// JSON has no NaN and no infinity: the library writes null for them.
Json number(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json residual_json(const ResidualScores& scores) {
  return {{"blocks", scores.blocks},
          {"mean_deg_per_s", scores.mean},
          {"variance_deg2_per_s2", scores.variance},
          {"sigma_deg_per_s", scores.sigma},
          {"rms_deg_per_s", scores.rms},
          {"peak_to_peak_deg_per_s", scores.peak_to_peak},
          {"max_deg_per_s", scores.largest}};
}

Json scale_factor_json(const std::optional<ScaleFactor>& found) {
  if (!found) {
    return nullptr;
  }
  return {{"retained", found->retained},
          {"slope", found->slope},
          {"raw_slope", found->raw_slope}};
}

Json block_json(const std::optional<ReplayedBlock>& block) {
  if (!block) {
    return nullptr;
  }
  return {{"retained", block->retained},
          {"rate_deg_per_s", block->rate},
          {"temperature_degC", block->temperature},
          {"time_s", block->time}};
}

Json worst_json(const WorstBlocks& worst) {
  return {{"within_2_deg_per_s", block_json(worst.small)},
          {"beyond", block_json(worst.large)}};
}

/// Whether a replay moves every input that a rate may move.
bool moves_all(const std::optional<ReplayedScaleFactor>& replayed) {
  return replayed && replayed->fixed_inputs.empty() && replayed->worst.worse();
}

Json replayed_json(const ReplayedScaleFactor& replayed) {
  Json json = worst_json(replayed.worst);
  json["over_every_temperature"] = worst_json(replayed.over_temperature);
  json["temperatures_degC"] = {replayed.temperatures.lowest,
                               replayed.temperatures.highest};
  json["largest_rate_deg_per_s"] = replayed.full_scale;
  return json;
}

Json linearity_json(const std::optional<Linearity>& found) {
  if (!found) {
    return nullptr;
  }
  return {{"nonlinearity_ppm", found->nonlinearity},
          {"asymmetry_ppm", found->asymmetry},
          {"rates", found->rates}};
}

Json score_json(const Score& score) {
  Json json;
  json["run"] = score.run;
  json["in_sample"] = score.in_sample;
  json["samples"] = score.samples;
  json["not_finite"] = score.not_finite;
  json["saturated"] = score.saturated;
  json["residual"] = residual_json(score.residual);
  json["raw"] = residual_json(score.raw);
  json["cubic"] = score.baseline ? residual_json(*score.baseline) : Json();
  if (score.baseline) {
    json["cubic"]["source"] = kClaimed;
  }
  json["fitted_to_these_runs"] = {
      {"constant", residual_json(score.constant)},
      {"cubic", score.cubic ? residual_json(*score.cubic) : Json()}};
  json["worse_than"] = better_fits(score);
  json["percent_of_cubic"] = number(score.percent_of_cubic);
  const ReplayedScaleFactor replayed =
      score.replayed.value_or(ReplayedScaleFactor{});
  const bool moved = moves_all(score.replayed);
  json["scale_factor"] = {
      {"within_2_deg_per_s", scale_factor_json(score.small_rates)},
      {"every_rate", scale_factor_json(score.every_rate)},
      {"replayed_at_rest",
       moved ? Json(replayed.worst.worse()->retained) : Json()},
      {"replayed", moved ? replayed_json(replayed) : Json()},
      {"not_moved_by_replay", replayed.fixed_inputs},
      {"not_tested", replayed.untested}};
  json["linearity"] = linearity_json(score.linearity);
  json["raw_linearity"] = linearity_json(score.raw_linearity);
  json["white_noise_ratio"] = number(score.white_noise);
  return json;
}

std::string cell(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

std::optional<double> retained(const std::optional<ScaleFactor>& found) {
  return found ? std::optional(found->retained) : std::nullopt;
}

std::optional<double> slope(const std::optional<ScaleFactor>& found) {
  return found ? std::optional(found->slope) : std::nullopt;
}

std::string residual_cells(const ResidualScores& scores) {
  return fmt::format(" {:>11.4g} {:>9.4g} {:>9.4g}", scores.variance,
                     scores.sigma, scores.peak_to_peak);
}

/// Characters on a terminal: UTF-8 continuation bytes take no room.
std::size_t display_width(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, display_width(text)), ' ');
}

/// The name of a run in its column, or on a line of its own above the figures
/// when it is longer than that.
std::string row_name(const std::string& name, std::size_t width) {
  return display_width(name) <= width ? padded(name, width)
                                      : name + '\n' + std::string(width, ' ');
}

std::string residual_row(const ResidualScores& residual,
                         const std::optional<double>& percent) {
  return fmt::format("{} {:>9.4f} {:>9.4g} {:>9.4g} {:>9}\n",
                     residual_cells(residual), residual.mean, residual.rms,
                     residual.largest, cell(percent, "{:.4g}"));
}

std::optional<double> nonlinearity(const std::optional<Linearity>& found) {
  return found ? std::optional(found->nonlinearity) : std::nullopt;
}

std::string rate_row(const Score& score) {
  return fmt::format(" {:>11} {:>11} {:>11} {:>9}\n",
                     cell(retained(score.small_rates), "{:.6f}"),
                     cell(retained(score.every_rate), "{:.6f}"),
                     cell(slope(score.every_rate), "{:.6f}"),
                     cell(nonlinearity(score.linearity), "{:.4g}"));
}

std::string raw_rate_row(const Score& score) {
  const auto raw_slope = score.every_rate
                             ? std::optional(score.every_rate->raw_slope)
                             : std::nullopt;
  return fmt::format(" {:>11} {:>11} {:>11} {:>9}\n", "-", "-",
                     cell(raw_slope, "{:.6f}"),
                     cell(nonlinearity(score.raw_linearity), "{:.4g}"));
}

bool has_rates(const Score& score) {
  return score.small_rates || score.every_rate || score.linearity;
}

/// What the figures of recorded rates are, where there are any.
std::string rate_table(const Validation& validation, std::size_t width) {
  const Score& overall = validation.overall;
  if (!has_rates(overall) && std::ranges::none_of(validation.runs, has_rates))
    return {};
  std::string text = fmt::format(
      "scale factor of recorded rates\n{} {:>11} {:>11} {:>11} {:>9}\n",
      padded("run", width), "kept 2", "kept all", "slope", "NL ppm");
  for (const Score& score : validation.runs)
    if (has_rates(score)) text += row_name(score.run, width) + rate_row(score);
  return text + padded("overall", width) + rate_row(overall) +
         padded("raw", width) + raw_rate_row(overall) +
         "kept 2, kept all: scale factor retained within 2 deg/s and at every "
         "rate; slope: of the answer\nover the true rate; NL ppm: largest "
         "departure from a straight line, of the largest rate\n";
}

std::string replay_note(const ReplayedScaleFactor& replayed) {
  if (!replayed.fixed_inputs.empty()) {
    return fmt::format(
        "scale factor replayed: not tested, no replay moves {}\n",
        fmt::join(replayed.fixed_inputs, ", "));
  }
  const std::optional<ReplayedBlock> worse = replayed.worst.worse();
  if (!worse) {
    return "scale factor replayed: not tested\n";
  }
  return fmt::format(
      "scale factor replayed up to {:g} deg/s from {:.1f} to {:.1f} degC: "
      "{:.6f} in the worst block\n",
      replayed.full_scale, replayed.temperatures.lowest,
      replayed.temperatures.highest, worse->retained);
}

std::string notes(const Validation& validation) {
  const Score& overall = validation.overall;
  std::string text;
  if (overall.replayed) {
    text += replay_note(*overall.replayed);
  }
  if (overall.baseline) {
    text += fmt::format(
        "% cubic: percent of the variance that the cubic leaves, as {}\n",
        kClaimed);
  }
  if (overall.white_noise) {
    text += fmt::format("white noise at 1 s: {:.3g} of the raw rate's\n",
                        *overall.white_noise);
  }
  if (overall.saturated > 0) {
    text += fmt::format("saturated samples: {} of {}\n", overall.saturated,
                        overall.samples);
  }
  for (const Check& check : validation.checks) {
    text += fmt::format("{:<6} {}: {}\n", check.passed ? "passed" : "FAILED",
                        check.name, check.found);
  }
  return text + fmt::format("verdict: {}\n", verdict_text(validation.verdict));
}

void require_same_runs(const std::vector<Validation>& methods) {
  for (const Validation& method : methods) {
    if (!std::ranges::equal(method.runs, methods.front().runs, {}, &Score::run,
                            &Score::run)) {
      throw std::invalid_argument(fmt::format(
          "{}: scored on other runs than {}, a table compares methods on the "
          "same runs",
          method.method, methods.front().method));
    }
  }
}

}  // namespace

nlohmann::ordered_json to_json(const Validation& validation) {
  Json json;
  json["method"] = validation.method;
  json["verdict"] = validation.passed() ? "pass" : "fail";
  json["words"] = verdict_text(validation.verdict);
  json["passed"] = validation.passed();
  json["corrects_scale_factor"] = validation.corrects_scale_factor;
  json["warnings"] = validation.warnings;
  json["checks"] = Json::array();
  for (const Check& check : validation.checks) {
    json["checks"].push_back({{"name", check.name},
                              {"passed", check.passed},
                              {"value", nullptr},
                              {"limit", nullptr},
                              {"words", check.found}});
  }
  json["overall"] = score_json(validation.overall);
  json["runs"] = Json::array();
  for (const Score& score : validation.runs) {
    json["runs"].push_back(score_json(score));
  }
  return json;
}

std::string table(const Validation& validation) {
  constexpr std::size_t kWidest = 27;  // leaves 100 columns for the table
  std::size_t width = display_width("overall");
  for (const Score& score : validation.runs) {
    const std::size_t needed = display_width(score.run);
    if (needed <= kWidest) width = std::max(width, needed);
  }
  std::string text = fmt::format(
      "{}: residual in 60 s blocks [deg/s]\n{} {:>11} {:>9} {:>9} {:>9} {:>9} "
      "{:>9} {:>9}\n",
      validation.method, padded("run", width), "variance", "1-sigma", "p-p",
      "mean", "rms", "max", "% cubic");
  for (const Score& score : validation.runs) {
    text += row_name(score.run, width) +
            residual_row(score.residual, score.percent_of_cubic);
  }
  const Score& overall = validation.overall;
  text += padded("overall", width) +
          residual_row(overall.residual, overall.percent_of_cubic);
  text += padded("raw", width) + residual_row(overall.raw, {});
  text +=
      "variance [(deg/s)^2] and 1-sigma are about the mean, rms and max about "
      "zero; p-p: peak to peak;\nraw: without a compensator\n";
  return text + rate_table(validation, width) + notes(validation);
}

std::string table(const std::vector<Validation>& methods) {
  std::string text;
  if (methods.empty()) {
    return text;
  }
  require_same_runs(methods);
  std::size_t width = display_width("uncompensated");
  for (const Validation& method : methods) {
    width = std::max(width, display_width(method.method));
  }
  text = fmt::format("{} {:>11} {:>9} {:>9} {:>9} {:>11} {:>11}  {}\n",
                     padded("method", width), "variance", "1-sigma", "p-p",
                     "% cubic", "SF +-2", "SF all", "verdict");
  text += padded("uncompensated", width) +
          residual_cells(methods.front().overall.raw) +
          fmt::format(" {:>9} {:>11} {:>11}\n", "-", "-", "-");
  for (const Validation& method : methods) {
    const Score& overall = method.overall;
    text += padded(method.method, width) + residual_cells(overall.residual) +
            fmt::format(" {:>9} {:>11} {:>11}  {}\n",
                        cell(overall.percent_of_cubic, "{:.4g}"),
                        cell(retained(overall.small_rates), "{:.5f}"),
                        cell(retained(overall.every_rate), "{:.5f}"),
                        verdict_text(method.verdict));
  }
  return text;
}

}  // namespace beamgyro::internal
