// SPDX-License-Identifier: MIT
#include "compensation/export/export_sdf.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace beamgyro::internal {
namespace {

std::string comment_text(std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != text.npos;)
    text.erase(at, 1);
  return text;
}

}  // namespace

std::string sdf_sensor(const std::string& name, char axis,
                       const SdfNoise& noise,
                       const std::vector<std::string>& remarks) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<sensor name=\"{}\" type=\"imu\">\n", name);
  for (const std::string& remark : remarks)
    text += fmt::format("  <!-- {} -->\n", comment_text(remark));
  const bool is_quantised = noise.resolution > kSdfLeastPrecision;
  text += fmt::format(
      "  <update_rate>{:.9g}</update_rate>\n"
      "  <imu>\n    <angular_velocity>\n      <{}>\n"
      "        <noise type=\"{}\">\n",
      noise.update_rate, axis,
      is_quantised ? "gaussian_quantized" : "gaussian");
  const auto element = [&](std::string_view called, double value) {
    text += fmt::format("          <{0}>{1:.9g}</{0}>\n", called, value);
  };
  element("mean", noise.mean);
  element("stddev", noise.angle_random_walk * std::sqrt(noise.update_rate));
  element("bias_mean", 0);
  element("bias_stddev", noise.turn_on);
  element("dynamic_bias_stddev", noise.rate_random_walk);
  element("dynamic_bias_correlation_time", noise.walk_correlation);
  if (is_quantised) element("precision", noise.resolution);
  return text + fmt::format(
                    "        </noise>\n      </{}>\n    </angular_velocity>\n"
                    "  </imu>\n</sensor>\n",
                    axis);
}

}  // namespace beamgyro::internal
