// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>

#include "include/beamgyro/shared.h"

namespace beamgyro::internal {

/// Makes the classes that hold a Shared content. Users cannot.
struct SharedMaker {
  /// Returns an object of `Type` with this content, which is not null.
  template <class Type, class Content>
  static Type make(std::shared_ptr<Content> content) {
    return Type(std::shared_ptr<const Content>(std::move(content)));
  }
};

}  // namespace beamgyro::internal
