// SPDX-License-Identifier: MIT
#include "report/ci_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

namespace beamgyro::internal {
namespace {

// What was decided on one limit, comparison or check, or on the whole.
struct Case {
  std::string_view result;  // "pass", "fail", "undecided", "not tested"
  std::string name;
  std::optional<Estimate> value = {};
  std::string_view unit = {};
  std::string limit = {};  // in words
  std::string words = {};  // one sentence

  bool fails() const { return result == "fail" || result == "undecided"; }
  bool is_skipped() const { return result == "not tested"; }
};

struct Suite {
  const char* name;
  std::vector<Case> cases;
};

std::vector<Case> cases_of_limits(const ValidationResult& result) {
  std::vector<Case> cases;
  for (const auto& [limit, decision] : result.limits) {
    const Metric* metric = find_metric(limit.metric);
    const auto own = std::ranges::find(result.own_metrics, limit.metric,
                                       &OwnMetricResult::name);
    std::string_view unit = "1";
    if (metric != nullptr)
      unit = metric->unit;
    else if (own != result.own_metrics.end())
      unit = own->unit;
    cases.push_back({verdict_name(decision.result), limit.metric,
                     decision.compared, limit.relative_to.empty() ? unit : "1",
                     text_of(limit), decision.words});
  }
  return cases;
}

std::vector<Case> cases_of_comparisons(const ValidationResult& result) {
  std::vector<Case> cases;
  for (const ResidualComparison& one : result.comparisons) {
    if (!one.is_required) continue;
    const PairedResidual& found = one.found;
    const std::string_view decided = found.is_better() ? "pass"
                                     : std::isfinite(found.half_width)
                                         ? "fail"
                                         : "undecided";
    Estimate gain{found.gain};
    if (std::isfinite(found.half_width))
      gain.interval = {found.gain - found.half_width,
                       found.gain + found.half_width};
    cases.push_back({decided, "better_than_" + one.with, gain, "1",
                     "at least 0",
                     fmt::format("It leaves {:.3g} of {:.3g} deg/s rms.",
                                 found.rms, found.other_rms)});
  }
  return cases;
}

std::vector<Case> cases_of_checks(const ValidationResult& result) {
  std::vector<Case> cases;
  for (const CheckResult& check : result.checks)
    cases.push_back(
        {check.outcome == CheckOutcome::kPassed   ? "pass"
         : check.outcome == CheckOutcome::kFailed ? "fail"
                                                  : "not tested",
         check.name,
         check.value ? std::optional(Estimate{*check.value}) : std::nullopt, "",
         check.limit ? fmt::format("{:g}", *check.limit) : "", check.words});
  return cases;
}

// What was not worse has passed; without an interval nothing was tested.
std::vector<Case> cases_of_earlier(const ValidationResult& result) {
  std::vector<Case> cases;
  if (!result.earlier) return cases;
  for (const MetricChange& one : result.earlier->metrics)
    cases.push_back({one.change == Change::kWorse     ? "fail"
                     : one.change == Change::kUnknown ? "not tested"
                                                      : "pass",
                     "earlier_" + std::string(one.metric->name), one.own,
                     one.metric->unit, "",
                     fmt::format("It was {:.6g} in {}.", one.other.value,
                                 result.earlier->name)});
  for (const std::string& name : result.earlier->lost)
    cases.push_back({"fail",
                     "earlier_passed_" + name,
                     {},
                     "",
                     "",
                     fmt::format("It passed in {}.", result.earlier->name)});
  return cases;
}

std::vector<Suite> suites_of(const ValidationResult& result) {
  std::vector<Suite> suites{
      {"limits", cases_of_limits(result)},
      {"comparisons", cases_of_comparisons(result)},
      {"checks", cases_of_checks(result)},
      {"earlier", cases_of_earlier(result)},
      {"verdict",
       {{verdict_name(result.verdict), "verdict", {}, "", "", result.words}}}};
  std::erase_if(suites, [](const Suite& suite) { return suite.cases.empty(); });
  return suites;
}

// Text that XML 1.0 may hold within quotes. Bytes that are not UTF-8 and
// characters that XML has none for become U+FFFD.
std::string xml_text(std::string_view raw) {
  const std::string text = nlohmann::json::parse(nlohmann::json(raw).dump(
      -1, ' ', false, nlohmann::json::error_handler_t::replace));
  std::string safe;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (c == '\n' || c == '\t' || c == '\r')
      safe += fmt::format("&#{};", static_cast<int>(c));
    else if (static_cast<unsigned char>(c) < 0x20)
      safe += "\xEF\xBF\xBD";
    else if (text.compare(k, 3, "\xEF\xBF\xBE") == 0 ||
             text.compare(k, 3, "\xEF\xBF\xBF") == 0) {
      safe += "\xEF\xBF\xBD";
      k += 2;
    } else
      safe += c;
  }
  return safe;
}

std::string attribute(const char* name, std::string_view value) {
  return fmt::format(" {}=\"{}\"", name, xml_text(value));
}

// "0.105 deg/s [0.0996, 0.11], at most 0.1"
std::string found_words(const Case& one) {
  std::string text;
  if (one.value) {
    text = fmt::format("{:.6g}", one.value->value);
    if (!one.unit.empty() && one.unit != "1")
      text += fmt::format(" {}", one.unit);
    if (one.value->interval)
      text += fmt::format(" [{:.6g}, {:.6g}]", one.value->interval->low,
                          one.value->interval->high);
  }
  if (!one.limit.empty())
    text += fmt::format("{}{}", text.empty() ? "" : ", ", one.limit);
  return text;
}

std::string case_xml(const Case& one, const std::string& place,
                     bool is_of_limits) {
  // A metric may have several limits.
  const std::string name = is_of_limits ? one.name + " " + one.limit : one.name;
  std::string xml =
      fmt::format("    <testcase{}{} time=\"0\">\n",
                  attribute("classname", place), attribute("name", name));
  const std::string found = found_words(one);
  if (one.fails())
    xml += fmt::format("      <failure{}{}>{}</failure>\n",
                       attribute("type", one.result),
                       attribute("message", one.words), xml_text(found));
  else if (one.is_skipped())
    xml += fmt::format("      <skipped{}/>\n", attribute("message", one.words));
  else if (!found.empty())
    xml += fmt::format("      <system-out>{}</system-out>\n", xml_text(found));
  return xml + "    </testcase>\n";
}

std::string properties_xml(const ResultProvenance& from) {
  std::string xml = "    <properties>\n";
  for (const auto& [name, value] :
       {std::pair<const char*, std::string>{"beamgyro_version",
                                            from.program_version},
        {"git_revision", from.git_revision},
        {"device", from.device},
        {"qualification", from.qualification},
        {"specification", from.specification}})
    xml += fmt::format("      <property{}{}/>\n", attribute("name", name),
                       attribute("value", value));
  return xml + "    </properties>\n";
}

}  // namespace

std::string junit_report(const ValidationResult& result) {
  const std::vector<Suite> suites = suites_of(result);
  std::size_t tests = 0, failures = 0;
  std::string body;
  for (const Suite& suite : suites) {
    const auto fails = std::ranges::count_if(suite.cases, &Case::fails);
    tests += suite.cases.size();
    failures += static_cast<std::size_t>(fails);
    body += fmt::format(
        "  <testsuite{} tests=\"{}\" failures=\"{}\" errors=\"0\" "
        "skipped=\"{}\" time=\"0\">\n{}",
        attribute("name", suite.name), suite.cases.size(), fails,
        std::ranges::count_if(suite.cases, &Case::is_skipped),
        properties_xml(result.provenance));
    const std::string place = result.compensator.name + "." + suite.name;
    for (const Case& one : suite.cases)
      body += case_xml(one, place, suite.name == std::string_view("limits"));
    body += "  </testsuite>\n";
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites{} tests=\"{}\" "
      "failures=\"{}\" errors=\"0\" time=\"0\">\n{}</testsuites>\n",
      attribute("name", "beamgyro validate " + result.compensator.name), tests,
      failures, body);
}

std::string line_report(const ValidationResult& result) {
  std::string lines;
  const auto number = [](double value) { return fmt::format("{:.6g}", value); };
  for (const Suite& suite : suites_of(result))
    for (const Case& one : suite.cases) {
      const bool has_ends = one.value && one.value->interval;
      std::string words = one.words;
      for (const char c : {'\t', '\n'}) std::ranges::replace(words, c, ' ');
      lines += fmt::format("{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n", one.result,
                           one.name, one.value ? number(one.value->value) : "",
                           has_ends ? number(one.value->interval->low) : "",
                           has_ends ? number(one.value->interval->high) : "",
                           one.unit == "1" ? "" : one.unit, one.limit, words);
    }
  return lines;
}

}  // namespace beamgyro::internal
