// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "sim/numerics/ode.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::cvode_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd vector_of(std::initializer_list<double> values) {
  VectorXd vector(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), vector.begin());
  return vector;
}

constexpr double kDecay = 0.5;  // [1/s]
const OdeRhs kDecayRate = [](double, const auto& y, auto dydt) {
  dydt = -kDecay * y;
};

struct SensorFault : std::exception {
  const char* what() const noexcept override { return "sensor fault"; }
};

TEST(Cvode, FollowsExponentialDecay) {
  Cvode ode(kDecayRate, 0.0, vector_of({2.0, -3.0}),
            {.relative_tolerance = 1e-10});
  for (const double t : {0.5, 3.0, 7.0}) {
    const VectorXd& y = ode.advance_to(t);
    // Tolerance: the local one times the number of steps, some hundreds.
    EXPECT_NEAR(y(0), 2.0 * std::exp(-kDecay * t), 1e-7) << "t = " << t;
    EXPECT_NEAR(y(1), -3.0 * std::exp(-kDecay * t), 1e-7) << "t = " << t;
    EXPECT_EQ(ode.time(), t);
  }
}

TEST(Cvode, ErrorFallsWithTheTolerance) {
  const auto error = [](double tolerance) {
    Cvode ode(kDecayRate, 0.0, vector_of({1.0}),
              {.relative_tolerance = tolerance,
               .absolute_tolerance = vector_of({1e-16})});
    return std::abs(ode.advance_to(10.0)(0) - std::exp(-10 * kDecay));
  };
  EXPECT_LT(error(1e-7), error(1e-4) / 30);
  EXPECT_LT(error(1e-10), error(1e-7) / 30);
}

TEST(Cvode, InterpolantHoldsTheToleranceBetweenTheSteps) {
  Cvode ode([](double t, const auto& y,
               auto dydt) { dydt(0) = -kDecay * (y(0) - std::cos(t)); },
            0.0, vector_of({1.0}),
            {.relative_tolerance = 0, .absolute_tolerance = vector_of({1e-9})});
  // y' = -k (y - cos t), y(0) = 1: forced part plus a decaying rest.
  const auto exact = [](double t) {
    const double k = kDecay, d = k * k + 1;
    const double rest = 1 - k * k / d;
    return k * (k * std::cos(t) + std::sin(t)) / d + rest * std::exp(-k * t);
  };
  double joint = 0, worst = 0;
  ode.advance_to(20.0, [&](const OdeStep& step) {
    EXPECT_EQ(step.begin, joint);
    joint = step.end;
    for (const double part : {0.0, 0.2, 0.5, 0.8, 1.0}) {
      const double t = std::lerp(step.begin, step.end, part);
      worst = std::max(worst, std::abs(step.at(t)(0) - exact(t)));
    }
  });
  EXPECT_EQ(joint, 20.0);
  EXPECT_LT(worst, 1e-7);
}

TEST(Cvode, SamplesAsItInterpolates) {
  Cvode ode(kDecayRate, 0.0, vector_of({2.0, -3.0}));
  std::vector<double> times(1000), values(1000);
  ode.advance_to(4.0, [&](const OdeStep& step) {
    for (std::size_t k = 0; k < times.size(); ++k) {
      times[k] = std::lerp(step.begin, step.end, static_cast<double>(k) / 999);
    }
    for (const Eigen::Index i : {0, 1}) {
      step.sample(i, times, values);
      for (const std::size_t k : {0u, 17u, 255u, 256u, 777u, 999u}) {
        EXPECT_NEAR(values[k], step.at(times[k])(i), 1e-14);
      }
    }
  });
}

TEST(Cvode, NeverLooksBeyondTheStopTime) {
  double latest = 0;
  CvodeOptions options;
  options.jacobian = [&](double t, const auto&, auto slope) {
    latest = std::max(latest, t);
    slope(0, 0) = -1e3;
  };
  Cvode ode(
      [&](double t, const auto& y, auto dydt) {
        latest = std::max(latest, t);
        dydt(0) = -1e3 * (y(0) - std::sin(t));
      },
      0.0, vector_of({0.5}), options);
  for (const double stop : {1e-9, 0.1, 0.3, 1.0, 10.0, 10.1}) {
    ode.advance_to(stop);
    EXPECT_LE(latest, stop);
  }
}

TEST(Cvode, RestartsAfterAJumpOfTheRightHandSide) {
  double target = 1;
  Cvode ode([&](double, const auto& y,
                auto dydt) { dydt(0) = kDecay * (target - y(0)); },
            0.0, vector_of({0.0}), {.relative_tolerance = 1e-10});
  const VectorXd at_jump = ode.advance_to(2.0);
  EXPECT_NEAR(at_jump(0), 1 - std::exp(-1.0), 1e-8);
  target = -5;
  ode.restart(2.0, at_jump);
  const double exact = -5 + (at_jump(0) + 5) * std::exp(-0.5);
  EXPECT_NEAR(ode.advance_to(3.0)(0), exact, 1e-8);
}

TEST(Cvode, RethrowsWhatTheJacobianThrew) {
  CvodeOptions options;
  options.jacobian = [](double, const auto&, auto) { throw SensorFault(); };
  Cvode ode(kDecayRate, 0.0, vector_of({1.0}), options);
  EXPECT_THROW(ode.advance_to(5.0), SensorFault);
}

TEST(Cvode, WorksAgainAfterAnExceptionAndARestart) {
  bool faulty = true;
  Cvode ode(
      [&](double t, const auto& y, auto dydt) {
        if (faulty && t > 0.5) throw SensorFault();
        dydt = -kDecay * y;
      },
      0.0, vector_of({1.0}));
  EXPECT_THROW(ode.advance_to(1.0), SensorFault);
  faulty = false;
  ode.restart(0.0, vector_of({1.0}));
  EXPECT_NEAR(ode.advance_to(1.0)(0), std::exp(-kDecay), 1e-6);
}

TEST(Cvode, ReportsARightHandSideThatIsNotFinite) {
  Cvode ode(
      [](double t, const auto& y, auto dydt) {
        dydt(0) = t > 1 ? std::numeric_limits<double>::quiet_NaN() : -y(0);
      },
      0.0, vector_of({1.0}));
  EXPECT_TRUE(holds(rejection<std::runtime_error>([&] { ode.advance_to(5.0); }),
                    "not finite at t = 1."));
}

TEST(Cvode, ReportsWhereItRanOutOfSteps) {
  Cvode ode(kDecayRate, 0.0, vector_of({1.0}), {.max_steps_per_advance = 5});
  EXPECT_TRUE(
      holds(rejection<std::runtime_error>([&] { ode.advance_to(100.0); }),
            "within 5 steps"));
}

TEST(Cvode, ReportsCvodesOwnWordsWhenItRefuses) {
  Cvode ode(kDecayRate, 0.0, vector_of({1.0}));
  ode.advance_to(2.0);
  EXPECT_TRUE(holds(rejection<std::runtime_error>([&] { ode.advance_to(1.0); }),
                    "is behind current t = 2"));
}

TEST(Cvode, RejectsTolerancesThatDoNotFit) {
  const auto with = [](double relative, const VectorXd& absolute) {
    Cvode(kDecayRate, 0.0, vector_of({1, 2, 3}),
          {.relative_tolerance = relative, .absolute_tolerance = absolute});
  };
  EXPECT_THROW(with(1e-6, vector_of({1e-9, 1e-9})), std::invalid_argument);
  EXPECT_THROW(with(-1e-6, vector_of({1e-9})), std::invalid_argument);
  EXPECT_THROW(with(NAN, vector_of({1e-9})), std::invalid_argument);
  EXPECT_THROW(with(1e-6, vector_of({1e-9, -1.0, 1e-9})),
               std::invalid_argument);
}

TEST(Cvode, WeighsEachComponentByItsOwnTolerance) {
  // Two uncoupled decays of very different size; only the tolerance vector
  // tells the integrator that the small one matters too.
  const auto error_of_small = [](const VectorXd& absolute) {
    Cvode ode(
        [](double, const auto& y, auto dydt) {
          dydt(0) = -0.1 * y(0);
          dydt(1) = -3.0 * y(1);
        },
        0.0, vector_of({1.0, 1e-6}),
        {.relative_tolerance = 0, .absolute_tolerance = absolute});
    return std::abs(ode.advance_to(0.5)(1) - 1e-6 * std::exp(-1.5));
  };
  EXPECT_LT(error_of_small(vector_of({1e-6, 1e-14})), 1e-12);
  EXPECT_GT(error_of_small(vector_of({1e-6})), 1e-12);
}

TEST(Cvode, AnalyticJacobianGivesTheSameWithFewerEvaluations) {
  // Robertson's stiff kinetics; the three fractions sum to one.
  const OdeRhs rate = [](double, const auto& y, auto dydt) {
    dydt(0) = -0.04 * y(0) + 1e4 * y(1) * y(2);
    dydt(2) = 3e7 * y(1) * y(1);
    dydt(1) = -dydt(0) - dydt(2);
  };
  CvodeOptions options{.absolute_tolerance = vector_of({1e-12, 1e-14, 1e-12})};
  Cvode quotients(rate, 0.0, vector_of({1, 0, 0}), options);
  long jacobians = 0;
  options.jacobian = [&](double, const auto& y, auto slope) {
    ++jacobians;
    slope.row(0) << -0.04, 1e4 * y(2), 1e4 * y(1);
    slope.row(2) << 0, 6e7 * y(1), 0;
    slope.row(1) = -slope.row(0) - slope.row(2);
  };
  Cvode analytic(rate, 0.0, vector_of({1, 0, 0}), options);
  const VectorXd a = analytic.advance_to(40.0);
  const VectorXd b = quotients.advance_to(40.0);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(a.sum(), 1.0, 1e-12);
  EXPECT_GT(jacobians, 0);
  EXPECT_LT(analytic.rhs_evaluations(), quotients.rhs_evaluations());
}

// A beat at 445 rad/s, damped at 38 1/s, that follows a slow input: the state
// of a split-mode gyro in a slowly changing rate.
long steps_of_quiet_beat(const CvodeOptions& options) {
  Cvode ode(
      [](double t, const auto& y, auto dydt) {
        const double u = y(0) - std::sin(0.001 * t), v = y(1);
        dydt(0) = -38 * u - 445 * v;
        dydt(1) = 445 * u - 38 * v;
      },
      0.0, vector_of({0, 0}), options);
  ode.advance_to(1000.0);
  return ode.steps();
}

TEST(Cvode, StabilityLimitDetectionSavesStepsOnAQuietBeat) {
  const long plain = steps_of_quiet_beat({});
  EXPECT_LT(steps_of_quiet_beat({.stability_limit_detection = true}),
            plain / 5);
}

TEST(Verification, V47IntegratorsInTwoThreadsGiveTheSameBits) {
  const auto run = [] {
    std::vector<double> visited;
    Cvode ode(
        [](double t, const auto& y, auto dydt) {
          dydt(0) = y(1);
          dydt(1) = 50 * (1 - y(0) * y(0)) * y(1) - y(0) + std::sin(t);
        },
        0.0, vector_of({2, 0}));
    ode.advance_to(100.0, [&](const OdeStep& step) {
      visited.push_back(step.end);
      visited.push_back(step.at(step.end)(0));
    });
    return visited;
  };
  const std::vector<double> alone = run();
  std::vector<double> left, right;
  std::thread other([&] { left = run(); });
  right = run();
  other.join();
  EXPECT_EQ(left, alone);
  EXPECT_EQ(right, alone);
}

}  // namespace
}  // namespace beamgyro::internal::cvode_test
