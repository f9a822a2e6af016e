// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "compensation/training/model_file.h"
#include "include/beamgyro/train.h"

namespace beamgyro {

struct Model::State {
  std::string name;
  internal::ModelSpec spec;
};

}  // namespace beamgyro
