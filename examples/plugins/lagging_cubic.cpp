// SPDX-License-Identifier: MIT
// A plug-in in C++ with a state: the cubic, and a term of the difference
// between the temperature and its low-pass.
#include <beamgyro/plugin.h>

#include <cmath>
#include <new>

namespace {

constexpr double kTimeConstant = 100.0;  // [s]

class Compensator {
 public:
  void reset(double period) {
    gain_ = 1.0 - std::exp(-period / kTimeConstant);
    started_ = false;
  }

  double compensated(double rate, double temperature) {
    if (!started_) slow_ = temperature;
    started_ = true;
    slow_ += gain_ * (temperature - slow_);
    const double x = temperature - 25.0;
    return rate - (0.66218 + x * (-0.048326 + x * (2.0176e-3 + x * 3.156e-5)) +
                   0.1755 * (temperature - slow_));
  }

 private:
  double gain_ = 1.0;  // of the low-pass, for one sample
  double slow_ = 0.0;  // [degC]
  bool started_ = false;
};

}  // namespace

uint32_t beamgyro_plugin_abi() { return BEAMGYRO_PLUGIN_ABI; }

const char* beamgyro_plugin_signals() { return "rate,temperature"; }

void* beamgyro_plugin_create() { return new (std::nothrow) Compensator; }

int beamgyro_plugin_reset(void* instance, double period) {
  static_cast<Compensator*>(instance)->reset(period);
  return 0;
}

double beamgyro_plugin_step(void* instance, double, const double* signals) {
  return static_cast<Compensator*>(instance)->compensated(signals[0],
                                                          signals[1]);
}

void beamgyro_plugin_destroy(void* instance) {
  delete static_cast<Compensator*>(instance);
}
