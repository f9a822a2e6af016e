// SPDX-License-Identifier: MIT
#include "validation/specification/specification_file.h"

namespace beamgyro::internal {

const SpecificationFile& default_specification() {
  static const SpecificationFile kDefault = parse_specification_file(
#include "validation/specification/default_text.h"
      , "specs/default.toml");
  return kDefault;
}

}  // namespace beamgyro::internal
