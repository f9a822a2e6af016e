// SPDX-License-Identifier: MIT
#include <array>

#include "sim/dynamics/complex_form.h"
#include "sim/dynamics/envelope.h"

namespace beamgyro::internal {
namespace {

using Eigen::Index;
using Eigen::Vector2cd;
using State = Eigen::Ref<const Eigen::VectorXd>;
using Matrix = Eigen::Ref<Eigen::MatrixXd>;

// d(complex at row)/d(complex at column) of z' = factor z.
void put_block(Matrix& J, Index row, Index column, Complex factor) {
  J(row, column) = J(row + 1, column + 1) = factor.real();
  J(row + 1, column) = factor.imag();
  J(row, column + 1) = -factor.imag();
}

// The same, added.
void add_block(Matrix& J, Index row, Index column, Complex factor) {
  J(row, column) += factor.real();
  J(row + 1, column + 1) += factor.real();
  J(row + 1, column) += factor.imag();
  J(row, column + 1) -= factor.imag();
}

// d(complex at row)/d(real at column).
void add_column(Matrix& J, Index row, Index column, Complex slope) {
  J(row, column) += slope.real();
  J(row + 1, column) += slope.imag();
}

void add_amplitude_column(Matrix& J, Index column, const Vector2cd& slope) {
  add_column(J, kAmplitude, column, slope(0));
  add_column(J, kAmplitude + 2, column, slope(1));
}

// Slopes of what the loops make by one of the states i_1 .. eta.
struct DriveSlope {
  double phase_error = 0, frequency = 0, amplitude_error = 0;
  double integral_rate = 0, voltage = 0, voltage_rate = 0;
};

// By i_1, q_1, i_2, q_2, xi, eta.
std::array<DriveSlope, 6> drive_slopes(const LoopElectronics& loops,
                                       const EnvelopeMoment& m) {
  std::array<DriveSlope, 6> by;
  const double a = m.drive.amplitude, wf = loops.demodulator_corner;
  if (a > kNoAmplitude) {
    const std::array<double, 2> inner = {m.i2, m.q2}, outer = {m.i1, m.q1};
    const std::array<double, 2> phase = {m.q2 / (a * a), -m.i2 / (a * a)};
    for (std::size_t k = 0; k < 2; ++k) {
      const double along = inner[k] / a;  // da/d inner
      by[k].voltage_rate = -loops.agc_proportional * wf * along;
      DriveSlope& s = by[2 + k];
      s.phase_error = m.drive.detection.gain * phase[k] +
                      m.drive.detection.slope * along * m.drive.phase;
      s.amplitude_error = -along;
      s.voltage = -loops.agc_proportional * along;
      s.voltage_rate =
          loops.agc_proportional *
              (-wf * (outer[k] - 2 * inner[k]) / a - m.error_rate * along / a) -
          loops.agc_integral * along;
    }
  }
  by[4].frequency = 1;
  by[5].voltage = 1;
  for (DriveSlope& s : by) {
    s.frequency += loops.pll_proportional * s.phase_error;
    s.integral_rate = loops.agc_integral * s.amplitude_error;
    if (m.drive.limited) s.integral_rate -= loops.agc_tracking * s.voltage;
    const double scale = m.drive.limited ? 0 : loops.nominal_voltage;
    s.voltage *= scale;
    s.voltage_rate *= scale;
  }
  return by;
}

}  // namespace

void EnvelopeOde::jacobian(const EnvelopeInputs& inputs, const State& y,
                           Matrix slope) {
  slope.setZero();
  const auto nodes = y.segment(kEnvelopeNodes, thermal_.size());
  thermal_.jacobian(inputs.surroundings, inputs.powered, nodes,
                    slope.block(kEnvelopeNodes, kEnvelopeNodes, thermal_.size(),
                                thermal_.size()));
  if (!inputs.powered) return;
  const ModalTable::Point modal = modal_at(inputs.time, nodes(kBeam));
  const EnvelopeCoefficients now =
      coefficients(modal.value, inputs.motion, nodes(kBoard));
  EnvelopeMoment m = moment(now, y);
  const EnvelopePlant plant(now.stiffness, now.velocity, m.drive.frequency);
  if (spurious_.count() > 0) {
    const SpuriousEnvelope spurious = spurious_envelope(inputs.time, y, m);
    m.force += spurious.force();
    m.force_rate += spurious.force_rate();
    add_spurious_slopes(spurious, modal.slope, now, m, plant, slope);
  }
  add_loop_slopes(now, m, plant, slope);
  add_readout_slopes(now, slope);
  if (loops_.rebalance) add_rebalance_slopes(now, plant, slope);
  add_temperature_slopes(modal.slope, now, m, plant, slope);
}

// Amplitudes and the drive's loops by their own states.
void EnvelopeOde::add_loop_slopes(const EnvelopeCoefficients& now,
                                  const EnvelopeMoment& m,
                                  const EnvelopePlant& plant,
                                  Matrix slope) const {
  const double wf = loops_.demodulator_corner;
  for (Index i = 0; i < 2; ++i) {
    const Index column = kAmplitude + 2 * i;
    for (Index j = 0; j < 2; ++j)
      add_block(slope, kAmplitude + 2 * j, column,
                plant.from_amplitude()(j, i));
    const Complex h = now.couplings.feedback(i);
    slope(kFeedback1, column) = wf * h.real();
    slope(kFeedback1, column + 1) = -wf * h.imag();
    slope(kFeedback1 + 1, column) = -wf * h.imag();
    slope(kFeedback1 + 1, column + 1) = -wf * h.real();
    slope(kFeedback1 + i, kFeedback1 + i) = -wf;
    slope(kFeedback2 + i, kFeedback1 + i) = wf;
    slope(kFeedback2 + i, kFeedback2 + i) = -wf;
  }
  const EnvelopePlant::Slope by_w = plant.by_frequency();
  const Vector2cd per_w =
      by_w.A * m.U + by_w.B * m.force - by_w.D * m.force_rate;
  const Vector2cd per_V = plant.from_force() * now.couplings.drive;
  const Vector2cd per_V_rate = -plant.from_force_rate() * now.couplings.drive;
  const Complex readout_per_V =
      wf * loops_.feedthrough * now.turn / loops_.charge_axis;
  Index column = kFeedback1;
  for (const DriveSlope& by : drive_slopes(loops_, m)) {
    add_amplitude_column(slope, column,
                         per_w * by.frequency + per_V * by.voltage +
                             per_V_rate * by.voltage_rate);
    add_column(slope, kReadout1, column, readout_per_V * by.voltage);
    slope(kPllIntegral, column) += loops_.pll_integral * by.phase_error;
    slope(kAgcIntegral, column) += by.integral_rate;
    ++column;
  }
}

void EnvelopeOde::add_readout_slopes(const EnvelopeCoefficients& now,
                                     Matrix slope) const {
  const double wf = loops_.demodulator_corner, wo = loops_.output_corner;
  const Complex gain = wf * now.turn / loops_.charge_axis;
  for (Index i = 0; i < 2; ++i) {
    put_block(slope, kReadout1, kAmplitude + 2 * i,
              gain * now.couplings.readout(i));
  }
  put_block(slope, kReadout1, kReadout1, -wf);
  put_block(slope, kReadout2, kReadout1, wf);
  put_block(slope, kReadout2, kReadout2, -wf);
  put_block(slope, kOutput1, kReadout2, wo);
  put_block(slope, kOutput1, kOutput1, -wo);
  put_block(slope, kOutput2, kOutput1, wo);
  put_block(slope, kOutput2, kOutput2, -wo);
}

void EnvelopeOde::add_rebalance_slopes(const EnvelopeCoefficients& now,
                                       const EnvelopePlant& plant,
                                       Matrix slope) const {
  const double wf = loops_.demodulator_corner, wo = loops_.output_corner;
  const double integral = loops_.rebalance_integral;
  const Complex proportional = loops_.rebalance_proportional;
  put_block(slope, kRebalance, kReadout2, 1);
  put_block(slope, kOutput1, kRebalance, -wo * integral);
  put_block(slope, kOutput1, kReadout2, -wo * proportional);
  const Complex axis = loops_.voltage_axis * std::conj(now.turn);
  const Vector2cd per_V = plant.from_force() * now.couplings.damping * axis;
  const Vector2cd per_V_rate =
      -plant.from_force_rate() * now.couplings.damping * axis;
  const Vector2cd by_r1 = -per_V_rate * (wf * proportional);
  const Vector2cd by_r2 =
      -per_V * proportional - per_V_rate * (integral - wf * proportional);
  for (Index i = 0; i < 2; ++i) {
    const Index row = kAmplitude + 2 * i;
    put_block(slope, row, kReadout1, by_r1(i));
    put_block(slope, row, kReadout2, by_r2(i));
    put_block(slope, row, kRebalance, -per_V(i) * integral);
  }
}

void EnvelopeOde::add_temperature_slopes(const ModalChannels& modal_slope,
                                         const EnvelopeCoefficients& now,
                                         const EnvelopeMoment& m,
                                         const EnvelopePlant& plant,
                                         Matrix slope) const {
  const double wf = loops_.demodulator_corner;
  const Index beam = kEnvelopeNodes + Index{kBeam};
  const Index board = kEnvelopeNodes + Index{kBoard};
  const Couplings per_K = couplings(modal_slope);
  const EnvelopePlant::Slope by_T =
      plant.by(stiffness_of(modal_slope), damping_of(modal_slope));
  add_amplitude_column(
      slope, beam,
      by_T.A * m.U + by_T.B * m.force - by_T.D * m.force_rate +
          plant.from_force() *
              (per_K.drive * m.drive.voltage + per_K.damping * m.V_B) -
          plant.from_force_rate() *
              (per_K.drive * m.voltage_rate + per_K.damping * m.V_B_rate));
  const Complex U_F = per_K.feedback * m.U;
  slope(kFeedback1, beam) += wf * U_F.real();
  slope(kFeedback1 + 1, beam) += -wf * U_F.imag();
  const Complex charge_per_K = per_K.readout * m.U;
  const Complex gain = wf * now.turn / loops_.charge_axis;
  add_column(slope, kReadout1, beam, gain * charge_per_K);

  const Complex charge =
      (now.couplings.readout * m.U)(0) + loops_.feedthrough * m.drive.voltage;
  add_column(slope, kReadout1, board, gain * charge * kI * now.turn_slope);
  const Complex turning = -kI * now.turn_slope;  // of V_B
  add_amplitude_column(
      slope, board,
      plant.from_force() * now.couplings.damping * (turning * m.V_B) -
          plant.from_force_rate() * now.couplings.damping *
              (turning * m.V_B_rate));
}

// What spurious modes add: their own rows and columns, and what they do to the
// amplitudes through the rate of change of their force.
void EnvelopeOde::add_spurious_slopes(const SpuriousEnvelope& spurious,
                                      const ModalChannels& modal_slope,
                                      const EnvelopeCoefficients& now,
                                      const EnvelopeMoment& m,
                                      const EnvelopePlant& plant,
                                      Matrix slope) const {
  using Amplitudes = SpuriousEnvelope::Amplitudes;
  const Index n = spurious_.count(), first = first_spurious();
  const SpuriousEnvelope::Couplings c = spurious.couplings();
  const Vector2cd v = plant.first_order(m.U, m.force);
  const Eigen::MatrixX2cd by_force =
      c.rates_by_v * plant.first_order_from_force();
  const auto add_modes = [&](Index column, const Amplitudes& rates) {
    for (Index i = 0; i < n; ++i)
      add_column(slope, first + 2 * i, column, rates(i));
  };
  const auto add_both = [&](Index column, const SpuriousEnvelope::Slope& by,
                            const Vector2cd& v_slope, double factor) {
    add_amplitude_column(slope, column,
                         -factor * plant.from_force_rate() * by.force_rate);
    add_modes(column, factor * (by.rates + c.rates_by_v * v_slope));
  };

  const Eigen::Matrix2cd amplitude_by_U =
      -plant.from_force_rate() * c.force_rate_by_U;
  const Eigen::Matrix2Xcd amplitude_by_Z =
      plant.from_force() * c.force_by_Z -
      plant.from_force_rate() * c.force_rate_by_Z;
  const Eigen::MatrixX2cd rates_by_U =
      c.rates_by_U + c.rates_by_v * plant.first_order_from_amplitude();
  Eigen::MatrixXcd rates_by_Z = by_force * c.force_by_Z;
  rates_by_Z.diagonal() += c.rates_by_own;
  for (Index j = 0; j < 2; ++j) {
    const Index row = kAmplitude + 2 * j;
    for (Index i = 0; i < 2; ++i)
      add_block(slope, row, kAmplitude + 2 * i, amplitude_by_U(j, i));
    for (Index i = 0; i < n; ++i) {
      add_block(slope, row, first + 2 * i, amplitude_by_Z(j, i));
      add_block(slope, first + 2 * i, row, rates_by_U(i, j));
    }
  }
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      add_block(slope, first + 2 * i, first + 2 * j, rates_by_Z(i, j));

  const SpuriousEnvelope::Slope by_w = spurious.by_frequency(v);
  const Vector2cd v_by_w = plant.first_order_by_frequency(m.U, v);
  const Amplitudes by_V = by_force * now.couplings.drive;
  Index column = kFeedback1;
  for (const DriveSlope& by : drive_slopes(loops_, m)) {
    add_both(column, by_w, v_by_w, by.frequency);
    add_modes(column++, by.voltage * by_V);
  }

  const Couplings per_K = couplings(modal_slope);
  const Vector2cd v_by_T =
      plant.first_order_by(stiffness_of(modal_slope), damping_of(modal_slope),
                           m.U, v) +
      plant.first_order_from_force() *
          (per_K.drive * m.drive.voltage + per_K.damping * m.V_B);
  add_both(kEnvelopeNodes + Index{kBeam}, spurious.by_temperature(v, false),
           v_by_T, 1);
  add_both(kEnvelopeNodes + Index{kHousing}, spurious.by_temperature(v, true),
           Vector2cd::Zero(), 1);
  if (!loops_.rebalance) return;
  add_modes(kEnvelopeNodes + Index{kBoard},
            by_force * now.couplings.damping * (-kI * now.turn_slope * m.V_B));
  const Amplitudes by_z = by_force * now.couplings.damping *
                          (loops_.voltage_axis * std::conj(now.turn));
  for (Index i = 0; i < n; ++i) {
    add_block(slope, first + 2 * i, kReadout2,
              -by_z(i) * loops_.rebalance_proportional);
    add_block(slope, first + 2 * i, kRebalance,
              -by_z(i) * loops_.rebalance_integral);
  }
}

}  // namespace beamgyro::internal
