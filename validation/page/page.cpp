// SPDX-License-Identifier: MIT
#include "validation/page/page.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace beamgyro::internal {
namespace {

constexpr std::string_view kPageTemplate =
#include "validation/page/page_text.h"
    ;
// Longer than a compiler has to take.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Woverlength-strings"
constexpr std::string_view kChartJs =
#include "validation/page/chart_js_text.h"
    ;
#pragma GCC diagnostic pop

// What the template holds in place of the two.
constexpr std::string_view kChartJsMark = "/* CHART.JS */";
constexpr std::string_view kResultMark = "{\"RESULT\": null}";

/// JSON that ends no script element and is plain ASCII. A byte that is not
/// UTF-8 becomes U+FFFD.
std::string script_json(const nlohmann::ordered_json& value) {
  const std::string plain =
      value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  std::string safe;
  safe.reserve(plain.size());
  for (const char c : plain)
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  return safe;
}

/// Splits `text` at `mark`, which it holds once.
std::pair<std::string_view, std::string_view> split_at(std::string_view text,
                                                       std::string_view mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos ||
      text.find(mark, at + 1) != std::string_view::npos)
    throw std::logic_error("page.html must hold once: " + std::string(mark));
  return {text.substr(0, at), text.substr(at + mark.size())};
}

}  // namespace

std::string page_of(const nlohmann::ordered_json& result) {
  const auto [head, rest] = split_at(kPageTemplate, kChartJsMark);
  const auto [middle, tail] = split_at(rest, kResultMark);
  std::string page(head);
  page += kChartJs;
  page += middle;
  page += script_json(result);
  page += tail;
  return page;
}

}  // namespace beamgyro::internal
