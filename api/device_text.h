// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "include/beamgyro/device.h"

namespace beamgyro::internal {

/// The text of a device file whose values are replaced one by one, each with a
/// comment that says where it comes from.
class DeviceText {
 public:
  /// `origin` is the comment of a key that keeps its value: "as nominal.toml".
  /// Comments of the base are dropped. Throws std::invalid_argument, naming
  /// `name` and the line, for a value that goes on in the next line.
  DeviceText(const std::string& text, const std::string& name,
             const std::string& origin);

  /// Returns the numbers of "table.key"; none where there is no such key.
  std::vector<double> numbers(const std::string& key) const;
  double number(const std::string& key) const { return numbers(key).at(0); }

  /// Replaces a value; a key that the base lacks ends its table, which the base
  /// has.
  void set(const std::string& key, double value, const std::string& comment);
  void set(const std::string& key, const std::vector<double>& values,
           const std::string& comment);

  /// Multiplies the numbers of a key; without the key nothing happens.
  void scale(const std::string& key, double factor, const std::string& comment);

  /// Returns the file, with these lines as comments at its begin.
  std::string text(const std::vector<std::string>& heading) const;
  /// Returns the device that this file describes.
  Device device(const std::vector<std::string>& heading = {}) const {
    return Device::parse(text(heading), "the device of these figures");
  }

 private:
  struct Line {
    std::string table, key, value, comment;  // without a key: a heading
  };
  Line* find(const std::string& key);
  const Line* find(const std::string& key) const;
  void put(const std::string& key, const std::string& value,
           const std::string& comment);

  std::vector<Line> lines_;
};

}  // namespace beamgyro::internal
