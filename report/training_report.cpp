// SPDX-License-Identifier: MIT
#include "report/training_report.h"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <variant>

namespace beamgyro::internal {
namespace {

std::string shown(const std::optional<double>& value) {
  return value ? fmt::format("{:.6f}", *value) : "-";
}

void print_equation_one(const BiasModel& model, const char* label,
                        std::string& text) {
  const EquationOne equation = equation_one(model);
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: F({:g} degC) = {:.6g} deg/s", label,
                 kReferenceTemperature, equation.bias_at_reference);
  if (equation.bias_at_reference == 0.0) {
    text += ", relative to which equation (1) has no coefficients\n";
    return;
  }
  for (std::size_t i = 0; i < equation.coefficients.size(); ++i) {
    fmt::format_to(out, ", a{} = {:.6g}/K", i + 1, equation.coefficients[i]);
    if (i > 0) fmt::format_to(out, "^{}", i + 1);
  }
  text += '\n';
}

// Why a restart ended is said where it is not what the chosen one ended by,
// which has a line of its own.
void print_restarts(const TrainResult& result, std::string& text) {
  auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < result.restarts.size(); ++k) {
    const TrainSummary& summary = result.restarts[k];
    const bool is_other =
        summary.stop_reason != result.restarts[result.chosen].stop_reason;
    fmt::format_to(out,
                   "restart {}{}: {} epochs, best {}, rms in-sample {:.6f}, "
                   "held-out {} deg/s{}{}\n",
                   k + 1, k == result.chosen ? " (kept)" : "", summary.epochs,
                   summary.best_epoch, summary.in_sample_rms,
                   shown(summary.held_out_rms), is_other ? ";\n  " : "",
                   is_other ? sentence(summary.stop_reason) : "");
  }
}

// One line for each group.
void print_groups(const CrossValidated& cv, std::string& text) {
  for (std::size_t k = 0; k < cv.group_rms.size(); ++k)
    fmt::format_to(std::back_inserter(text),
                   "{} {}: rms {:.6f} deg/s unseen, of a constant {:.6f}\n",
                   cv.by, k + 1, cv.group_rms[k], cv.constant_group_rms[k]);
}

// Straight lines, or that the rows have none.
std::string lines_text(const FittedCompensator& compensator) {
  if (!compensator.straight_lines)
    return "straight lines between soaks: none, the rows hold no two soaks\n";
  const Provenance& source = compensator.provenance;
  return fmt::format(
      "straight lines between {} soaks: rms in-sample {}, held-out {} deg/s\n",
      compensator.straight_lines->temperatures.size(),
      shown(source.lines_in_sample_rms), shown(source.lines_held_out_rms));
}

}  // namespace

std::string training_report(const TrainResult& result, bool every_group) {
  const Provenance& source = result.compensator.provenance;
  std::string text =
      fmt::format("{}, {} rows, {} held-out rows\n", source.method, result.rows,
                  result.held_out_rows);
  auto out = std::back_inserter(text);
  for (const std::string& choice : source.choices)
    fmt::format_to(out, "choice: {}\n", choice);
  if (std::holds_alternative<BpNetwork>(result.compensator.bias.function))
    print_restarts(result, text);
  fmt::format_to(out, "stopped: {}\n", source.stop_reason);
  fmt::format_to(out, "rms in-sample {:.6f}, held-out {} deg/s\n",
                 source.in_sample_rms, shown(source.held_out_rms));
  if (const auto& cv = source.cross_validated) {
    if (every_group) print_groups(*cv, text);
    fmt::format_to(out,
                   "rms cross-validated over {} {}s {:.6f} +- {:.6f} deg/s, of "
                   "a constant {:.6f} deg/s\n",
                   cv->groups, cv->by, cv->rms, cv->standard_error,
                   cv->constant_rms);
  }
  fmt::format_to(out, "cubic: rms in-sample {:.6f}, held-out {} deg/s\n",
                 source.baseline_in_sample_rms,
                 shown(source.baseline_held_out_rms));
  text += lines_text(result.compensator);
  fmt::format_to(out, "constant: rms in-sample {:.6f}, held-out {} deg/s\n",
                 source.constant_in_sample_rms,
                 shown(source.constant_held_out_rms));
  print_equation_one(result.compensator.baseline, "cubic", text);
  for (const std::string& remark : result.sigma_remarks)
    fmt::format_to(out, "{}\n", remark);
  return text;
}

}  // namespace beamgyro::internal
