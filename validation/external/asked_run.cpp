// SPDX-License-Identifier: MIT
#include "validation/external/asked_run.h"

namespace beamgyro::internal {
namespace {

thread_local const std::string* asked_run_name = nullptr;

}  // namespace

AskedRun::AskedRun(const std::string& name) : outer_(asked_run_name) {
  asked_run_name = &name;
}

AskedRun::~AskedRun() { asked_run_name = outer_; }

std::string AskedRun::name() {
  return asked_run_name == nullptr ? std::string() : *asked_run_name;
}

}  // namespace beamgyro::internal
