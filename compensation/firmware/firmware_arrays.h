// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamgyro::internal {

/// A row of constants of exported code.
struct FirmwareArray {
  std::string name, comment;
  std::vector<float> values;
};

/// The constants of exported code, in the order in which it holds them.
class FirmwareArrays {
 public:
  void add(FirmwareArray array) { arrays_.push_back(std::move(array)); }

  const std::vector<FirmwareArray>& all() const { return arrays_; }

  /// Throws std::logic_error for a name that is not there.
  const std::vector<float>& values(std::string_view name) const;
  const float* data(std::string_view name) const { return values(name).data(); }
  int count(std::string_view name) const {
    return static_cast<int>(values(name).size());
  }

 private:
  std::vector<FirmwareArray> arrays_;
};

/// C code of a bias of scaled inputs x[0], x[1], ...
struct FirmwareCode {
  std::vector<std::string_view> sections;  // of the run-time that it calls
  std::string body;                        // of a function that returns float
};

/// The number in single precision. Throws std::invalid_argument for one that
/// does not fit it.
float single(double value);

template <class Numbers>
std::vector<float> singles(const Numbers& numbers) {
  std::vector<float> result;
  for (const double number : numbers) result.push_back(single(number));
  return result;
}

}  // namespace beamgyro::internal
