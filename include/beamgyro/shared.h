// SPDX-License-Identifier: MIT
/// \file
/// What the classes of this library that hold much have in common.
#pragma once

#include <memory>
#include <utility>

#include "beamgyro/visibility.h"

namespace BEAMGYRO_PUBLIC beamgyro {

namespace internal {
struct SharedMaker;
}

/// Immutable content of a type that users do not see. Copies share it, and many
/// threads may use one at once. There is always content: none is made of a null
/// pointer, and one that was moved from keeps its own.
template <class Content>
class Shared {
 public:
  Shared(const Shared&) = default;  // instead of a move, too
  Shared& operator=(const Shared&) = default;
  ~Shared() = default;
  const Content& content() const { return *content_; }

 private:
  friend struct internal::SharedMaker;
  explicit Shared(std::shared_ptr<const Content> content)
      : content_(std::move(content)) {}

  std::shared_ptr<const Content> content_;
};

}  // namespace beamgyro
