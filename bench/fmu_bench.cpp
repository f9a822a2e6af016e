// SPDX-License-Identifier: MIT
#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "fmu/variables.h"

namespace beamgyro::internal {
namespace {

template <class Function>
Function* function(const char* name) {
  static void* const binary = dlopen(BEAMGYRO_FMU, RTLD_NOW | RTLD_LOCAL);
  return reinterpret_cast<Function*>(dlsym(binary, name));
}

// What a master does in a step of 1 ms: it sets the rate, steps, and reads six
// measured signals. `step` of stepper_bench.cpp is the engine alone.
void fmu_step(benchmark::State& state, const std::string& device) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("fmu_bench_" + device);
  fs::create_directories(folder);
  std::ifstream file(std::string(BEAMGYRO_SCENARIOS) + "/devices/" + device +
                     ".toml");
  std::ostringstream text;
  text << file.rdbuf();
  std::ofstream(folder / kPackedDevice) << text.str();
  std::ofstream(folder / kPackedOverrides) << "";
  std::ofstream(folder / kPackedFidelity) << "quasistatic";
  const std::string token = PackedDevice(text.str(), "").token();
  void* const gyro =
      function<void*(const char*, const char*, const char*, bool, bool, bool,
                     bool, const std::uint32_t*, std::size_t, void*, void*,
                     void*)>("fmi3InstantiateCoSimulation")(
          "gyro", token.c_str(), folder.c_str(), false, false, false, false,
          nullptr, 0, nullptr, nullptr, nullptr);
  const auto set = function<int(void*, const std::uint32_t*, std::size_t,
                                const double*, std::size_t)>("fmi3SetFloat64");
  const auto get = function<int(void*, const std::uint32_t*, std::size_t,
                                double*, std::size_t)>("fmi3GetFloat64");
  const auto step =
      function<int(void*, double, double, bool, bool*, bool*, bool*, double*)>(
          "fmi3DoStep");
  const std::uint32_t noise_rate = kNoiseRate, rate = kFirstInput;
  std::uint32_t outputs[6];
  for (std::uint32_t i = 0; i < 6; ++i) outputs[i] = kFirstSignal + i;
  const double ticks = 1000;  // [Hz]
  set(gyro, &noise_rate, 1, &ticks, 1);
  function<int(void*, bool, double, double, bool, double)>(
      "fmi3EnterInitializationMode")(gyro, false, 0, 0, false, 0);
  function<int(void*)>("fmi3ExitInitializationMode")(gyro);
  double time = 0, k = 0, shown[6] = {};
  bool event = false, end = false, early = false;
  for (auto _ : state) {
    const double turning = 50 * std::sin(0.001 * ++k);  // [deg/s]
    set(gyro, &rate, 1, &turning, 1);
    if (step(gyro, time, 1e-3, true, &event, &end, &early, &time) != 0) {
      state.SkipWithError("a step failed");
      break;
    }
    get(gyro, &outputs[0], 6, &shown[0], 6);
    benchmark::DoNotOptimize(shown[0]);
  }
  function<void(void*)>("fmi3FreeInstance")(gyro);
  fs::remove_all(folder);
}

BENCHMARK_CAPTURE(fmu_step, nominal, "nominal");
BENCHMARK_CAPTURE(fmu_step, lifelike, "lifelike");

}  // namespace
}  // namespace beamgyro::internal
