// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "api/validator.h"
#include "validation/bundle/bundle.h"

namespace beamgyro::internal {

/// What a bundle asks for.
struct BundledRequest {
  std::string compensator;
  ValidationOptions options;
};

/// Returns it, with the paths of the copies. Throws std::invalid_argument for
/// one that no call could make.
BundledRequest request_of(const Bundle& bundle);

/// Returns the bundle's content of a validation.
BundleContent bundle_content(const Validator& validator);

}  // namespace beamgyro::internal
