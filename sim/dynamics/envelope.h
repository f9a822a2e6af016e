// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "sim/dynamics/loop_electronics.h"
#include "sim/dynamics/modal_table.h"
#include "sim/dynamics/spurious_envelope.h"
#include "sim/thermal/thermal_ode.h"

namespace beamgyro::internal {

/// The slow manifold of two modes, second order (2.13), per mass:
///
///   U' = A U + B f - D f',   q = Re[U e^{i theta}], force Re[f e^{i theta}],
///   P = 2 i w + V,  S_0 = K - w^2 + i w V,  R = P^-1,
///   B = (1 + R R S_0) R,  A = -B S_0,  D = R R.
///
/// K [1/s2] is the stiffness with the centrifugal terms and without the Euler
/// force. V [1/s] is the force per velocity, damping and Coriolis. w = theta'.
class EnvelopePlant {
 public:
  EnvelopePlant(const Eigen::Matrix2d& stiffness,
                const Eigen::Matrix2d& velocity, double omega);

  const Eigen::Matrix2cd& from_amplitude() const { return a_; }
  const Eigen::Matrix2cd& from_force() const { return b_; }
  const Eigen::Matrix2cd& from_force_rate() const { return d_; }

  /// Returns v = R (f - S_0 U), U' of first order (2.11), and its derivatives
  /// by f, by U, by w, and by a parameter of which K and V have these
  /// derivatives.
  Eigen::Vector2cd first_order(const Eigen::Vector2cd& U,
                               const Eigen::Vector2cd& f) const {
    return r_ * (f - s_ * U);
  }
  const Eigen::Matrix2cd& first_order_from_force() const { return r_; }
  Eigen::Matrix2cd first_order_from_amplitude() const { return -r_ * s_; }
  Eigen::Vector2cd first_order_by_frequency(const Eigen::Vector2cd& U,
                                            const Eigen::Vector2cd& v) const;
  Eigen::Vector2cd first_order_by(const Eigen::Matrix2d& stiffness,
                                  const Eigen::Matrix2d& velocity,
                                  const Eigen::Vector2cd& U,
                                  const Eigen::Vector2cd& v) const;

  /// Derivatives of A, B and D by one parameter.
  struct Slope {
    Eigen::Matrix2cd A, B, D;
  };
  Slope by_frequency() const;
  /// Returns the derivatives by a parameter, given the derivatives of K and V
  /// by it.
  Slope by(const Eigen::Matrix2d& stiffness,
           const Eigen::Matrix2d& velocity) const;

 private:
  Slope slope(const Eigen::Matrix2cd& dP, const Eigen::Matrix2cd& dS) const;

  double omega_;
  Eigen::Matrix2d velocity_;
  Eigen::Matrix2cd r_, s_, a_, b_, d_;
};

/// Indices of the state vector of EnvelopeOde. A complex number takes two
/// entries, real part first. Amplitudes are divided by A_ref; signals are rates
/// [rad/s].
enum EnvelopeState {
  kAmplitude = 0,      // U = u/A_ref, complex X then Y
  kFeedback1 = 4,      // i_1, q_1
  kFeedback2 = 6,      // i_2, q_2
  kPllIntegral = 8,    // xi [rad/s]
  kAgcIntegral = 9,    // eta
  kReadout1 = 10,      // r after one pole w_f [rad/s]
  kReadout2 = 12,      // r after both
  kOutput1 = 14,       // z after one pole w_o
  kOutput2 = 16,       // z after both: rate and minus the quadrature
  kRebalance = 18,     // int r dt [rad], stays 0 in open loop
  kEnvelopeNodes = 20  // the state of ThermalOde, then Z of spurious modes
};

/// The beam in the loops of loop_electronics.h, as envelope and carrier have
/// it.
class LoopedBeam {
 public:
  explicit LoopedBeam(const TrimmedGyro& gyro);

  const LoopElectronics& loops() const { return loops_; }

  /// The couplings at a point of the modal table, or their slopes over
  /// temperature.
  struct Couplings {
    Eigen::Vector2cd drive, damping;        // Theta/(m A_ref) [1/(s2 V)]
    Eigen::RowVector2cd feedback, readout;  // U to U_F, and to charge [C]
  };

 protected:
  Couplings couplings(const ModalChannels& modal) const;
  Complex turn(double board_temperature) const;  // e^{i phi_el}

  /// Writes the rates of the states from kFeedback1 to kRebalance: of the
  /// demodulated feedback U_F, the readout r and the output z [rad/s].
  void put_loop_rates(const DriveSignals& drive, Complex U_F, Complex r,
                      Complex z, const Eigen::Ref<const Eigen::VectorXd>& y,
                      Eigen::Ref<Eigen::VectorXd> dydt) const;

  LoopElectronics loops_;
  ModalTable table_;
  double phase_tc_, phase_tc2_;
  double angular_gain_;

 private:
  double amplitude_;       // A_ref [m]
  double mass_amplitude_;  // m A_ref [kg m]
};

/// The coefficients of the envelope's equations at one beam temperature, motion
/// of the case and board temperature.
struct EnvelopeCoefficients {
  LoopedBeam::Couplings couplings;
  Eigen::Matrix2d stiffness, velocity;  // of EnvelopePlant
  Complex turn;                         // e^{i phi_el}
  double turn_slope;                    // d phi_el / dT_board [rad/K]
};

/// The physical quantities that a state of EnvelopeOde stands for.
struct EnvelopeMoment {
  Eigen::Vector2cd U;
  double i1, q1, i2, q2;
  DriveSignals drive;
  double error_rate;      // e_A' [1/s]
  double voltage_rate;    // V_D' [V/s]
  Complex r1, r2, z;      // [rad/s]
  Complex V_B, V_B_rate;  // [V] [V/s]
  Eigen::Vector2cd force, force_rate;
};

/// Below this amplitude the slope of |i + jq| is taken as 0.
inline constexpr double kNoAmplitude = 1e-12;

/// Inputs of the gyro at one moment.
struct EnvelopeInputs {
  CaseMotion motion;
  ThermalSurroundings surroundings;
  bool powered = false;
  double time = 0;  // of a unit with memory, since the run began [s]
};

/// The differential equation of the envelope run: the amplitudes of both modes
/// on their slow manifold (2.13, see EnvelopePlant), the loops of
/// loop_electronics.h and the thermal network (4.1) as one system. The force is
/// f = (Theta_D V_D + Theta_B V_B)/(m A_ref), to which spurious modes add
/// theirs (SpuriousEnvelope). Without power the amplitudes and the states of
/// the electronics stay as they are. Not safe for use by two threads at once.
class EnvelopeOde : public LoopedBeam {
 public:
  /// `memory`, which must outlive the object, is null for a unit without.
  EnvelopeOde(const TrimmedGyro& gyro, const DriveHeating& heating,
              const ModalMemory* memory = nullptr);

  Eigen::Index size() const { return first_spurious() + 2 * spurious_.count(); }

  /// Index of Z of the first spurious mode, complex; each takes two states.
  Eigen::Index first_spurious() const {
    return kEnvelopeNodes + thermal_.size();
  }
  Eigen::Index spurious_modes() const { return spurious_.count(); }

  /// Returns the state with every node at `temperature` [K] and everything else
  /// at rest.
  Eigen::VectorXd at_rest(double temperature) const;

  void rate(const EnvelopeInputs& inputs,
            const Eigen::Ref<const Eigen::VectorXd>& y,
            Eigen::Ref<Eigen::VectorXd> dydt);

  /// Writes the Jacobian d(dy/dt)_i / dy_j.
  void jacobian(const EnvelopeInputs& inputs,
                const Eigen::Ref<const Eigen::VectorXd>& y,
                Eigen::Ref<Eigen::MatrixXd> slope);

 private:
  using State = Eigen::Ref<const Eigen::VectorXd>;

  ModalTable::Point modal_at(double time, double beam_temperature);
  SpuriousEnvelope spurious_envelope(double time, const State& y,
                                     const EnvelopeMoment& m);
  EnvelopeCoefficients coefficients(const ModalChannels& modal,
                                    const CaseMotion& motion,
                                    double board_temperature) const;
  EnvelopeMoment moment(const EnvelopeCoefficients& now,
                        const Eigen::Ref<const Eigen::VectorXd>& y) const;

  void add_loop_slopes(const EnvelopeCoefficients& now, const EnvelopeMoment& m,
                       const EnvelopePlant& plant,
                       Eigen::Ref<Eigen::MatrixXd> slope) const;
  void add_readout_slopes(const EnvelopeCoefficients& now,
                          Eigen::Ref<Eigen::MatrixXd> slope) const;
  void add_rebalance_slopes(const EnvelopeCoefficients& now,
                            const EnvelopePlant& plant,
                            Eigen::Ref<Eigen::MatrixXd> slope) const;
  void add_temperature_slopes(const ModalChannels& modal_slope,
                              const EnvelopeCoefficients& now,
                              const EnvelopeMoment& m,
                              const EnvelopePlant& plant,
                              Eigen::Ref<Eigen::MatrixXd> slope) const;
  void add_spurious_slopes(const SpuriousEnvelope& spurious,
                           const ModalChannels& modal_slope,
                           const EnvelopeCoefficients& now,
                           const EnvelopeMoment& m, const EnvelopePlant& plant,
                           Eigen::Ref<Eigen::MatrixXd> slope) const;

  SpuriousOscillators spurious_;
  const ModalMemory* memory_;
  std::size_t memory_interval_ = 0;
  ThermalOde thermal_;
};

/// Returns the local error of each state that matters as much as one of 1 rad/s
/// in the output: 1e-6 of the drive amplitude moves the output of a unit with a
/// quadrature of some 100 deg/s by 2e-6 rad/s, and so on.
Eigen::VectorXd envelope_error_weights(const TrimmedGyro& gyro,
                                       const EnvelopeOde& ode);

}  // namespace beamgyro::internal
