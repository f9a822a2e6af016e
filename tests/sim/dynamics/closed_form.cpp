// SPDX-License-Identifier: MIT
#include "tests/sim/dynamics/closed_form.h"

#include <cmath>

#include "tests/sim/dynamics/loop_response.h"

namespace beamgyro::internal {
namespace {

// Strength and direction of a patch: Theta_p = theta e^{i phi} (along, across).
struct Transducer {
  double strength;      // along its axis [N/V]
  double phase;         // phi_p [rad]
  double misalignment;  // eps_p [rad]
};

Transducer transducer(const Eigen::Vector2cd& coupling, int axis) {
  const Complex along = coupling(axis), across = coupling(1 - axis);
  const double sign = along.real() < 0 ? -1 : 1;
  return {sign * std::abs(along), std::arg(sign * along),
          (across / along).real()};
}

double phase_of_electronics(const ReadoutParameters& readout, double T) {
  const double dT = T - kCalibrationTemperature;
  return readout.phase_tc * dT + readout.phase_tc2 * dT * dT;
}

}  // namespace

ClosedForm closed_form(const ModalParameters& modal, const DriveLoop& loop,
                       double feedthrough, double omega) {
  const double m = modal.mass, g = modal.coriolis_mass / m;
  const double x_decay = modal.damping(0, 0) / (2 * m);
  const Transducer D = transducer(modal.coupling[kDrive], 0);
  const Transducer F = transducer(modal.coupling[kFeedback], 0);
  const Transducer R = transducer(modal.coupling[kReadout], 1);
  const double beta =
      2 * m * omega * feedthrough * x_decay / (D.strength * R.strength);

  ClosedForm f{};
  f.sense_decay = modal.damping(1, 1) / (2 * m);
  f.split = (modal.stiffness(1, 1) / m - omega * omega) / (2 * omega);
  f.sense_phase = std::atan(f.split / f.sense_decay);
  f.in_phase = (modal.damping(0, 1) / (2 * m) - D.misalignment * x_decay -
                R.misalignment * f.sense_decay - beta * f.split) /
               g;
  f.quadrature = (modal.stiffness(0, 1) / (2 * m * omega) -
                  R.misalignment * f.split + beta * f.sense_decay) /
                 g;
  const double amplitude = loop.feedback_amplitude / std::abs(F.strength);
  f.rate_amplitude =
      g * amplitude * R.strength / std::hypot(f.split, f.sense_decay);
  f.readout_phase = f.sense_phase + R.phase - F.phase;
  return f;
}

double closed_form_output(const TrimmedGyro& gyro, double T) {
  const ReadoutParameters& readout = gyro.device.readout;
  const auto at = [&](double temperature) {
    const ModalParameters modal = modal_at(gyro, temperature);
    return closed_form(modal, gyro.loop, readout.feedthrough,
                       beam_signal(gyro, modal, {}).drive_frequency);
  };
  const ClosedForm here = at(T), reference = at(kCalibrationTemperature);
  const double delta = here.readout_phase - reference.readout_phase +
                       phase_of_electronics(readout, T);
  const double gain = here.rate_amplitude / reference.rate_amplitude;
  const double dT = T - kCalibrationTemperature;
  const double offset = readout.offset_trim - reference.in_phase +
                        readout.offset_tc * dT + readout.offset_tc2 * dT * dT;
  return gain * (here.in_phase * std::cos(delta) +
                 here.quadrature * std::sin(delta)) +
         offset;
}

}  // namespace beamgyro::internal
