// SPDX-License-Identifier: MIT
#include "sim/campaign/distribution_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace beamgyro::internal {
namespace {

using Kind = Distribution::Kind;

constexpr std::array<std::string_view, 5> kForms = {
    "normal", "uniform", "lognormal", "discrete", "poisson"};
// Below this share the inverse of the distribution function has too few digits.
constexpr double kSmallestShare = 1e-6;

std::string form_of(const ConfigTable& table, std::string_view key,
                    const ConfigTable& distribution) {
  const std::vector<std::string> keys = distribution.keys();
  const auto known = [](const std::string& name) {
    return std::find(kForms.begin(), kForms.end(), name) != kForms.end();
  };
  if (keys.size() == 1 && known(keys[0])) return keys[0];
  const bool nested =
      !keys.empty() && std::none_of(keys.begin(), keys.end(), known);
  table.fail(
      key, fmt::format("no distribution; expected one of {{ normal, "
                       "uniform, lognormal, discrete, poisson = {{ .. }} }}{}",
                       nested ? ", and a dotted key in quotes" : ""));
}

void read_ends(const ConfigTable& form, Distribution& d) {
  if (const auto low = form.optional_number("low")) d.low = *low;
  if (const auto high = form.optional_number("high")) d.high = *high;
  if (!(d.low < d.high)) {
    form.fail("high", fmt::format("{} is not above low = {}; expected low < "
                                  "high",
                                  d.high, d.low));
  }
}

void require_share(const ConfigTable& form, const Distribution& d) {
  if (share_inside(d) < kSmallestShare) {
    form.fail(form.has("low") ? "low" : "high",
              "less than a millionth of the values lie between low and high; "
              "expected ends nearer to the centre");
  }
}

Distribution read_continuous(const ConfigTable& form, Kind kind) {
  Distribution d;
  d.kind = kind;
  if (kind == Kind::kNormal) {
    d.centre = form.number("mean");
    d.sigma = form.number("sigma", positive());
  } else if (kind == Kind::kLognormal) {
    d.centre = form.number("median", positive());
    d.sigma = form.number("sigma", {0, 10, true, false});
    d.low = 0;
    d.either_sign = form.flag_or("either_sign", false);
  } else {
    d.low = form.number("low");
    d.high = form.number("high");
  }
  read_ends(form, d);
  if (kind != Kind::kUniform) require_share(form, d);
  return d;
}

FileDistribution read_discrete(const ConfigTable& form) {
  FileDistribution result;
  const ConfigNode& values = form.value("values");
  if (values.kind != ConfigNode::Kind::kArray || values.children.empty()) {
    form.fail("values",
              fmt::format("{} is wrong here; expected an array of at least one "
                          "value",
                          text_of(values)));
  }
  result.values = values.children;
  std::vector<double> weights(result.values.size(), 1);
  if (form.has("weights"))
    weights = form.numbers("weights", weights.size(), non_negative());
  if (std::all_of(weights.begin(), weights.end(),
                  [](double weight) { return weight == 0; })) {
    form.fail("weights", "all are 0; expected one above 0");
  }
  result.distribution = discrete(weights);
  return result;
}

// The counts from 0 to `high`, as choices.
FileDistribution read_poisson(const ConfigTable& form) {
  constexpr long kMost = 1000;
  const double mean = form.number("mean", {0, 100, true, false});
  const long high = form.integer("high", 1, kMost);
  FileDistribution result;
  result.distribution = discrete(poisson_weights(mean, static_cast<int>(high)));
  for (long k = 0; k <= high; ++k) {
    ConfigNode count;
    count.kind = ConfigNode::Kind::kInteger;
    count.integer = k;
    result.values.push_back(count);
  }
  return result;
}

}  // namespace

FileDistribution read_distribution(const ConfigTable& table,
                                   std::string_view key) {
  const ConfigTable distribution = table.table(key);
  const std::string form = form_of(table, key, distribution);
  const ConfigTable keys = distribution.table(form);
  if (form == "poisson") return read_poisson(keys);
  if (form == "discrete") return read_discrete(keys);
  const Kind kind = form == "normal"    ? Kind::kNormal
                    : form == "uniform" ? Kind::kUniform
                                        : Kind::kLognormal;
  return {read_continuous(keys, kind), {}};
}

}  // namespace beamgyro::internal
