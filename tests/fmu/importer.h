// SPDX-License-Identifier: MIT
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fmu/variables.h"

namespace beamgyro::internal {

constexpr int kOk = 0, kError = 3;  // the standard's numbers

/// The binary of FMUs, loaded as a master of simulations does.
class FmuBinary {
 public:
  FmuBinary() : handle_(dlopen(BEAMGYRO_FMU, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw std::runtime_error(dlerror());
  }
  ~FmuBinary() { dlclose(handle_); }
  FmuBinary(const FmuBinary&) = delete;
  FmuBinary& operator=(const FmuBinary&) = delete;

  bool has(const std::string& name) const {
    return dlsym(handle_, name.c_str()) != nullptr;
  }
  /// Calls a function with arguments as wide as those of the standard. The
  /// sanitizer would want the very types of the binary's own source.
  template <class Answer = int, class... Arguments>
#ifdef __clang__
  __attribute__((no_sanitize("function")))
#endif
  Answer
  call(const char* name, Arguments... arguments) const {
    void* const function = dlsym(handle_, name);
    if (function == nullptr) throw std::runtime_error(dlerror());
    return reinterpret_cast<Answer (*)(Arguments...)>(function)(arguments...);
  }

 private:
  void* handle_;
};

inline const FmuBinary& binary() {
  static const FmuBinary loaded;
  return loaded;
}

/// An FMU that is unpacked: its resources, its token, its variables.
class UnpackedFmu {
 public:
  UnpackedFmu(const std::string& device, FmiVersion version,
              const std::string& folder = "resources",
              const std::string& overrides = "",
              const std::string& fidelity = "quasistatic")
      : folder_(
            std::filesystem::path(::testing::TempDir()) /
            ::testing::UnitTest::GetInstance()->current_test_info()->name() /
            device / folder),
        text_(text_of(std::string(BEAMGYRO_SCENARIOS) + "/devices/" + device +
                      ".toml")),
        packed_(text_, overrides, fidelity),
        variables_(fmu_variables(packed_, version)) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / kPackedDevice) << text_;
    std::ofstream(folder_ / kPackedOverrides) << overrides;
    std::ofstream(folder_ / kPackedFidelity) << fidelity;
  }

  std::string folder() const { return folder_.string() + "/"; }
  std::string uri() const {
    std::string escaped;
    for (const char c : folder_.string())
      escaped += c == ' ' ? std::string("%20") : std::string(1, c);
    return "file://" + escaped;
  }
  const PackedDevice& device() const { return packed_; }
  const std::string& token() const { return packed_.token(); }
  const std::vector<FmuVariable>& variables() const { return variables_; }
  std::uint32_t reference(const std::string& name) const {
    const auto found = std::ranges::find(variables_, name, &FmuVariable::name);
    if (found == variables_.end()) throw std::runtime_error(name);
    return found->reference;
  }
  /// The references of all reals that are calculated.
  std::vector<std::uint32_t> signals() const {
    std::vector<std::uint32_t> references;
    for (const FmuVariable& v : variables_)
      if (v.type == VariableType::kReal && (v.causality == Causality::kOutput ||
                                            v.causality == Causality::kLocal))
        references.push_back(v.reference);
    return references;
  }

 private:
  static std::string text_of(const std::string& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  std::filesystem::path folder_;
  std::string text_;
  PackedDevice packed_;
  std::vector<FmuVariable> variables_;
};

/// What the logger of FMI 2.0 was given, as printf would print it.
using Messages = std::vector<std::string>;
inline void log_as_printf(void* environment, const char* /*instance*/,
                          int /*status*/, const char* /*category*/,
                          const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  char text[4096];
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  static_cast<Messages*>(environment)->push_back(text);
}
struct Callbacks2 {
  void (*logger)(void*, const char*, int, const char*, const char*,
                 ...) = log_as_printf;
  void* (*allocate)(std::size_t, std::size_t) = nullptr;
  void (*free)(void*) = nullptr;
  void (*finished)(void*, int) = nullptr;
  void* environment = nullptr;
};

/// An instance of FMI 2.0.
class Instance2 {
 public:
  Messages messages;

  explicit Instance2(const UnpackedFmu& fmu) : fmu_(&fmu) {
    callbacks_.environment = &messages;
    component = binary().call<void*>(
        "fmi2Instantiate", "gyro", 1, fmu.token().c_str(), fmu.uri().c_str(),
        static_cast<const Callbacks2*>(&callbacks_), 0, 0);
    if (component == nullptr) throw std::runtime_error(messages.at(0));
  }
  ~Instance2() {
    try {
      binary().call<void>("fmi2FreeInstance", component);
    } catch (const std::exception&) {  // the binary has no such function
      std::abort();
    }
  }
  Instance2(const Instance2&) = delete;
  Instance2& operator=(const Instance2&) = delete;

  template <class... Arguments>
  int call(const char* name, Arguments... arguments) {
    return binary().call(name, component, arguments...);
  }
  int set_up(double start = 0) {
    return call("fmi2SetupExperiment", 0, 0.0, start, 0, 0.0);
  }
  int start() {
    return set_up() + call("fmi2EnterInitializationMode") +
           call("fmi2ExitInitializationMode");
  }
  int set(const std::string& name, double value) {
    const std::uint32_t reference = fmu_->reference(name);
    return call("fmi2SetReal", &std::as_const(reference), std::size_t{1},
                &std::as_const(value));
  }
  int set_integer(const std::string& name, std::int32_t value) {
    const std::uint32_t reference = fmu_->reference(name);
    return call("fmi2SetInteger", &std::as_const(reference), std::size_t{1},
                &std::as_const(value));
  }
  int set_boolean(const std::string& name, int value) {
    const std::uint32_t reference = fmu_->reference(name);
    return call("fmi2SetBoolean", &std::as_const(reference), std::size_t{1},
                &std::as_const(value));
  }
  int step(double time, double size) {
    return call("fmi2DoStep", time, size, 0);
  }
  std::vector<double> get(const std::vector<std::uint32_t>& references) {
    std::vector<double> values(references.size(), -1);
    EXPECT_EQ(call("fmi2GetReal", references.data(), references.size(),
                   values.data()),
              kOk);
    return values;
  }
  std::vector<double> signals() { return get(fmu_->signals()); }
  /// The serialised state.
  std::string bytes() {
    void* state = nullptr;
    std::size_t size = 0;
    EXPECT_EQ(call("fmi2GetFMUstate", &state), kOk);
    EXPECT_EQ(call("fmi2SerializedFMUstateSize", state, &size), kOk);
    std::string bytes(size, '\0');
    EXPECT_EQ(call("fmi2SerializeFMUstate", state, bytes.data(), size), kOk);
    EXPECT_EQ(call("fmi2FreeFMUstate", &state), kOk);
    EXPECT_EQ(state, nullptr);
    return bytes;
  }
  int restore(const std::string& bytes) {
    void* state = nullptr;
    int answer =
        call("fmi2DeSerializeFMUstate", bytes.data(), bytes.size(), &state);
    if (answer == kOk) answer = call("fmi2SetFMUstate", state);
    if (state != nullptr) call("fmi2FreeFMUstate", &state);
    return answer;
  }

  void* component = nullptr;

 private:
  const UnpackedFmu* fmu_;
  Callbacks2 callbacks_;
};

}  // namespace beamgyro::internal
