// SPDX-License-Identifier: MIT
#include "compensation/models/lookup_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "compensation/firmware/runtime.h"
#include "compensation/models/parameter_json.h"

namespace beamgyro::internal {

using Eigen::Index;

namespace {

// Points whose mean becomes an entry.
struct Group {
  double count = 0.0, x = 0.0, y = 0.0;

  void add(double at, double value) {
    count += 1.0;
    x += at;
    y += value;
  }
};

void check_points(Index points, double width) {
  if (!(width > 0.0) || points == 0)
    throw std::invalid_argument(
        fmt::format("table: {} points in bins of {} K, must be points in bins "
                    "wider than 0",
                    points, width));
}

LookupTable table_of(const std::vector<Group>& groups) {
  const auto size = static_cast<Index>(groups.size());
  LookupTable table{Eigen::ArrayXd(size), Eigen::ArrayXd(size)};
  Index k = 0;
  for (const Group& group : groups) {
    table.temperatures(k) = group.x / group.count;
    table.values(k++) = group.y / group.count;
  }
  return table;
}

}  // namespace

double LookupTable::at(double temperature) const {
  const Index last = temperatures.size() - 1;
  if (!(temperature > temperatures(0))) return values(0);
  if (!(temperature < temperatures(last))) return values(last);
  const auto above =
      std::upper_bound(temperatures.begin(), temperatures.end(), temperature);
  const Index k = above - temperatures.begin();
  const double share = (temperature - temperatures(k - 1)) /
                       (temperatures(k) - temperatures(k - 1));
  return values(k - 1) + share * (values(k) - values(k - 1));
}

Eigen::ArrayXd LookupTable::predict(
    const Eigen::Ref<const Eigen::ArrayXd>& x) const {
  return x.unaryExpr([this](double T) { return at(T); });
}

LookupTable fit_lookup_table(const Eigen::Ref<const Eigen::ArrayXd>& x,
                             const Eigen::Ref<const Eigen::ArrayXd>& y,
                             double width) {
  check_points(x.size(), width);
  std::map<double, Group> bins;
  for (Index k = 0; k < x.size(); ++k)
    bins[std::floor(x(k) / width)].add(x(k), y(k));
  std::vector<Group> groups;
  for (const auto& [number, bin] : bins) groups.push_back(bin);
  return table_of(groups);
}

LookupTable fit_table_at_soaks(const Eigen::Ref<const Eigen::ArrayXd>& x,
                               const Eigen::Ref<const Eigen::ArrayXd>& y,
                               double width) {
  check_points(x.size(), width);
  std::vector<Index> order(static_cast<std::size_t>(x.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, {}, [&](Index k) { return x(k); });
  std::vector<Group> soaks;
  double first = 0.0, last = 0.0;
  for (const Index k : order) {
    if (soaks.empty() || x(k) - last > width / 4.0) {
      soaks.emplace_back();
      first = x(k);
    }
    last = x(k);
    soaks.back().add(x(k), y(k));
    if (last - first > width)
      throw UndeterminedFit(fmt::format(
          "temperatures from {:.2f} to {:.2f} degC are a ramp, a table at "
          "soaks needs soaks within {} K; set rows.steady_K_per_min in the "
          "model file to leave out the rows of ramps",
          first, last, width));
  }
  return table_of(soaks);
}

nlohmann::ordered_json LookupTable::parameters() const {
  return {{"temperatures_degC", numbers_json(temperatures)},
          {"values_deg_per_s", numbers_json(values)}};
}

LookupTable LookupTable::read(const JsonNode& node, std::size_t) {
  return read_lookup_table(node, "values_deg_per_s");
}

void LookupTable::put_arrays(FirmwareArrays& arrays) const {
  arrays.add({"temperatures", "[degC]", singles(temperatures)});
  arrays.add({"values", "[deg/s]", singles(values)});
}

float LookupTable::firmware_value(const FirmwareArrays& arrays,
                                  std::span<const float> x) const {
  return runtime::table_at(arrays.data("temperatures"), arrays.data("values"),
                           arrays.count("values"), x[0]);
}

FirmwareCode LookupTable::firmware_code(std::size_t) const {
  return {{"table"},
          fmt::format("  return table_at(temperatures, values, {}, x[0]);\n",
                      values.size())};
}

LookupTable read_lookup_table(const JsonNode& node, const std::string& values,
                              const std::string& temperatures) {
  LookupTable table{read_array(node.at(temperatures)),
                    read_array(node.at(values))};
  const Eigen::Index n = table.temperatures.size();
  if (n < 1 || table.values.size() != n)
    node.at(values).fail(
        fmt::format("{} values for {} temperatures, must be as many and at "
                    "least 1",
                    table.values.size(), n));
  if (!(table.temperatures.tail(n - 1) > table.temperatures.head(n - 1)).all())
    node.at(temperatures).fail("must increase");
  return table;
}

}  // namespace beamgyro::internal
