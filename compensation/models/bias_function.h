// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <stdexcept>

#include "compensation/firmware/firmware_arrays.h"
#include "dataset/files/json_node.h"

namespace beamgyro::internal {

/// How many inputs a kind of bias function reads.
enum class InputUse { kNone, kOne, kAny };

// A kind of bias function F, one of the alternatives of BiasModel::function,
// has
//
//   static constexpr const char* kKind;    its name in compensator files
//   static constexpr InputUse kInputUse;
//   Eigen::ArrayXd predict(x) const;       one sample per row of x, which is
//                                          one column where it reads one input
//   nlohmann::ordered_json parameters() const;
//   static F read(const JsonNode& parameters, std::size_t inputs);
//   void put_arrays(FirmwareArrays&) const;       constants of exported code
//   float firmware_value(const FirmwareArrays&, std::span<const float> x)
//   const; FirmwareCode firmware_code(std::size_t inputs) const;
//
// parameters() throws std::runtime_error for a number that is not finite,
// read() as JsonNode, put_arrays() as single(). firmware_code() does, operation
// by operation, what firmware_value() does. A function that reads no input has
// neither of the two: its value is the one number of its array, or 0 without.

/// The rows do not determine the parameters of a fit. Fits to some of the rows
/// may end so though a fit to all of them does not.
class UndeterminedFit : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace beamgyro::internal
