// SPDX-License-Identifier: MIT
/// \file
/// What the classes of this library that hold much have in common.
#pragma once

#include <memory>
#include <utility>

namespace beamgyro {

/// Immutable content of a type that users do not see. Copies share it, and many
/// threads may use one at once.
template <class Content>
class Shared {
 public:
  explicit Shared(std::shared_ptr<const Content> content)
      : content_(std::move(content)) {}
  const Content& content() const { return *content_; }

 private:
  std::shared_ptr<const Content> content_;
};

}  // namespace beamgyro
