// SPDX-License-Identifier: MIT
#include "sim/dynamics/modal_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/sim/device/nominal_device.h"

namespace beamgyro::internal::modal_table_test {
namespace {

// The parameters that a point of the table stands for.
ModalParameters parameters_at(const TrimmedGyro& gyro, ModalTable& table,
                              double T) {
  const ModalChannels channels = table.at(T).value * gyro.beam.mass;
  ModalParameters modal = modal_at(gyro, T);
  modal.stiffness = stiffness_of(channels);
  modal.damping = damping_of(channels);
  for (const Patch patch : {kDrive, kFeedback, kReadout, kDamping})
    modal.coupling[patch] =
        coupling_of(channels, patch) *
        table.direction()[patch].cast<std::complex<double>>();
  return modal;
}

TEST(ModalTable, GivesTheOutputOfTheExactSolution) {
  const TrimmedGyro gyro = make_gyro(nominal_device());
  ModalTable table(gyro);
  double largest = 0;
  for (double T = 233.01; T < 334; T += 0.37) {
    const BeamSignal exact = beam_signal(gyro, T, {});
    const BeamSignal from_table =
        beam_signal(gyro, parameters_at(gyro, table, T), {});
    largest =
        std::max(largest, std::abs(exact.demodulated - from_table.demodulated));
  }
  EXPECT_LT(largest / kDegree, 1e-6);
}

TEST(ModalTable, SlopeIsThatOfItsValue) {
  ModalTable table(make_gyro(nominal_device()));
  for (const double T : {250.0, 261.13, 298.15, 311.9}) {
    constexpr double h = 1e-3;
    const ModalChannels slope =
        (table.at(T + h).value - table.at(T - h).value) / (2 * h);
    const ModalChannels found = table.at(T).slope;
    for (Eigen::Index i = 0; i < slope.size(); ++i)
      EXPECT_NEAR(found(i), slope(i), 1e-5 * std::abs(slope(i)) + 1e-9);
  }
}

TEST(ModalTable, RefusesABeamOutsideTheModel) {
  ModalTable table(make_gyro(nominal_device()));
  EXPECT_THROW(table.at(kColdestBeam - 1), std::runtime_error);
  EXPECT_THROW(table.at(kHottestBeam + 1), std::runtime_error);
  EXPECT_THROW(table.at(std::nan("")), std::runtime_error);
}

}  // namespace
}  // namespace beamgyro::internal::modal_table_test
