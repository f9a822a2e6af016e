// SPDX-License-Identifier: MIT
#include "sim/stepper/gyro_stepper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/units.h"
#include "sim/numerics/simulation_failure.h"
#include "tests/sim/stepper/shipped_device.h"

namespace beamgyro::internal::gyro_stepper_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

GyroStepper stepper_of(const std::string& device,
                       const StepperStart& start = {},
                       const std::vector<std::string>& overrides = {}) {
  return {stepper_model(make_gyro(shipped_device(device, overrides))), start};
}

StepInputs turning(double deg_per_s, double degC = 25) {
  StepInputs inputs;
  inputs.motion[kRateZ] = deg_per_s * kDegree;
  inputs.ambient = degC + kZeroCelsius;
  return inputs;
}

// Some motion and heat, which bends every second.
StepInputs course(double t) {
  StepInputs inputs = turning(50 * std::sin(0.3 * t), 25 + 5 * std::sin(t / 9));
  return inputs;
}

bool same_bits(const StepSample& a, const StepSample& b) {
  return a.true_node_temperature == b.true_node_temperature &&
         a.time == b.time && a.rate == b.rate && a.output == b.output &&
         a.temperature == b.temperature &&
         a.drive_frequency == b.drive_frequency &&
         a.drive_voltage == b.drive_voltage && a.quadrature == b.quadrature &&
         a.true_bias == b.true_bias;
}

class OfDevice : public testing::TestWithParam<const char*> {};

TEST_P(OfDevice, ASnapshotGoesOnLikeTheOriginal) {
  GyroStepper original = stepper_of(GetParam(), {.seed = 5, .noise_rate = 100});
  for (int k = 0; k < 70; ++k)
    original.step(0.013, course(0.013 * k), course(0.013 * (k + 1)), k > 5);
  GyroStepper copy = original;
  GyroStepper restored = stepper_of(GetParam(), {.seed = 5, .noise_rate = 100});
  restored.restore(original.state());
  EXPECT_TRUE(same_bits(restored.now(), original.now()));
  for (int k = 0; k < 200; ++k) {
    const double dt = k % 3 == 0 ? 0.004 : 0.25;
    const StepInputs from = course(k), to = course(k + 1);
    original.step(dt, from, to, k % 50 != 7);
    copy.step(dt, from, to, k % 50 != 7);
    restored.step(dt, from, to, k % 50 != 7);
    ASSERT_TRUE(original.now().powered == (k % 50 != 7));
    if (!original.now().powered) continue;
    ASSERT_TRUE(same_bits(copy.now(), original.now())) << k;
    ASSERT_TRUE(same_bits(restored.now(), original.now())) << k;
  }
  EXPECT_EQ(copy.state(), original.state());
  EXPECT_EQ(restored.state(), original.state());
}
INSTANTIATE_TEST_SUITE_P(All, OfDevice,
                         testing::Values("nominal", "lifelike", "rebalance",
                                         "oven", "lifelike_with_modes"),
                         [](const auto& of) { return std::string(of.param); });

TEST(GyroStepper, ASnapshotOfTheEnvelopeGoesOnLikeTheOriginal) {
  const StepperStart start{.fidelity = StepFidelity::kEnvelope,
                           .seed = 5,
                           .noise_rate = 100,
                           .powered = false};
  GyroStepper original = stepper_of("nominal", start);
  for (int k = 0; k < 150; ++k)
    original.step(0.013, course(0.013 * k), course(0.013 * (k + 1)), k > 5);
  GyroStepper copy = original;
  GyroStepper restored = stepper_of("nominal", start);
  restored.restore(original.state());
  for (int k = 0; k < 100; ++k) {
    const StepInputs from = course(k), to = course(k + 1);
    for (GyroStepper* one : {&original, &copy, &restored})
      one->step(k % 3 == 0 ? 0.004 : 0.25, from, to, k % 50 != 7);
    ASSERT_EQ(copy.state(), original.state()) << k;
    ASSERT_EQ(restored.state(), original.state()) << k;
  }
}

TEST(GyroStepper, TheEnvelopeOfAGyroThatRemembersIsRefused) {
  EXPECT_THROW(stepper_of("lifelike", {.fidelity = StepFidelity::kEnvelope}),
               std::invalid_argument);
}

TEST(GyroStepper, FinerStepsShowTheSame) {
  const auto end_of = [](int parts) {
    GyroStepper stepper =
        stepper_of("nominal", {.noise = false}, {"readout.adc_bits=32"});
    std::vector<double> rates;
    for (int k = 0; k < 300; ++k)  // 0.7 s each
      for (int i = 0; i < parts; ++i) {
        const double from = k + double(i) / parts, to = k + (i + 1.0) / parts;
        const auto between = [](double t) {
          const double whole = std::floor(t), share = t - whole;
          StepInputs inputs = course(whole);
          const StepInputs next = course(whole + 1);
          inputs.motion[kRateZ] +=
              share * (next.motion[kRateZ] - inputs.motion[kRateZ]);
          inputs.ambient += share * (next.ambient - inputs.ambient);
          return inputs;
        };
        stepper.step(0.7 / parts, between(from), between(to), true);
        if (i + 1 == parts) rates.push_back(stepper.now().rate);
      }
    return rates;
  };
  const std::vector<double> coarse = end_of(7);  // 100 ms
  for (const int parts : {100, 700}) {           // 7 ms, 1 ms
    const std::vector<double> fine = end_of(parts);
    for (std::size_t k = 0; k < coarse.size(); ++k)
      ASSERT_NEAR(fine[k], coarse[k], 1e-7) << parts << " at " << k;
  }
}

TEST(GyroStepper, NoiseBelongsToItsTicksHoweverTimeIsCut) {
  const StepperStart start{.seed = 3, .noise_rate = 10};
  const std::vector<std::string> fine = {"readout.adc_bits=32"};
  GyroStepper coarse = stepper_of("nominal", start, fine);
  GyroStepper cut = stepper_of("nominal", start, fine);
  StepperStart quiet = start;
  quiet.noise = false;
  GyroStepper silent = stepper_of("nominal", quiet, fine);
  double before = cut.now().rate - silent.now().rate;
  for (int tick = 1; tick <= 50; ++tick) {
    coarse.step(0.1, turning(0), true);
    for (int i = 1; i <= 8; ++i) {
      cut.step(0.0125, turning(0), true);
      silent.step(0.0125, turning(0), true);
      const double noise = cut.now().rate - silent.now().rate;
      if (i < 8) {
        EXPECT_NEAR(noise, before, 1e-7);
      } else {
        EXPECT_GT(std::abs(noise - before), 1e-6);
      }
      before = noise;
    }
    EXPECT_NEAR(cut.now().rate, coarse.now().rate, 1e-7);
    EXPECT_EQ(cut.now().drive_frequency, coarse.now().drive_frequency);
  }
}

// Of the ticks within a step only the last is shown.
TEST(GyroStepper, AStepOverManyTicksShowsTheNoiseOfItsLast) {
  const StepperStart start{.seed = 3, .noise_rate = 10};
  GyroStepper long_steps = stepper_of("nominal", start);
  GyroStepper short_steps = stepper_of("nominal", start);
  for (int k = 0; k < 20; ++k) {
    for (int tick = 0; tick < 5; ++tick)
      short_steps.step(0.1, turning(0), true);
    const StepSample& sample = long_steps.step(0.5, turning(0), true);
    const StepSample& expected = short_steps.now();
    EXPECT_NEAR(sample.rate, expected.rate, 1e-7);
    EXPECT_NEAR(sample.temperature, expected.temperature, 1e-9);
    EXPECT_NEAR(sample.quadrature, expected.quadrature, 1e-9);
    EXPECT_NEAR(sample.drive_frequency, expected.drive_frequency, 1e-9);
    EXPECT_NEAR(sample.drive_voltage, expected.drive_voltage, 1e-9);
  }
}

TEST(GyroStepper, TheRateOfTheNoiseIsThatOfTheFirstStep) {
  GyroStepper given = stepper_of("nominal", {.seed = 3, .noise_rate = 50});
  GyroStepper taken = stepper_of("nominal", {.seed = 3});
  GyroStepper silent = stepper_of("nominal", {.noise = false});
  EXPECT_EQ(taken.now().rate, silent.now().rate);
  EXPECT_NE(given.now().rate, silent.now().rate);
  for (int k = 0; k < 20; ++k) {
    given.step(0.02, turning(1), true);
    taken.step(0.02, turning(1), true);
    EXPECT_TRUE(same_bits(given.now(), taken.now()));
  }
}

TEST(GyroStepper, BeyondTheMapTheExactSolutionGoesOnWithoutAJump) {
  GyroStepper stepper =
      stepper_of("nominal", {.noise = false},
                 {"readout.adc_bits=32", "readout.full_scale_deg_per_s=1000"});
  double before = stepper.now().true_bias;
  for (int k = 0; k < 4000; ++k) {  // 25 to 125 degC within the materials
    stepper.step(1, turning(0, 25 + k * 0.025),
                 turning(0, 25 + (k + 1) * 0.025), true);
    EXPECT_LT(std::abs(stepper.now().true_bias - before), 0.2);
    before = stepper.now().true_bias;
  }
  EXPECT_GT(stepper.now().true_node_temperature[kBeam], 105);
}

// Everything that a step may be given that is wrong.
TEST(GyroStepper, BadInputChangesNothing) {
  GyroStepper stepper = stepper_of("nominal", {.seed = 1, .noise_rate = 10});
  for (int k = 0; k < 5; ++k) stepper.step(0.1, course(k), true);
  const std::string before = stepper.state();
  const StepSample sample = stepper.now();
  std::vector<std::function<void()>> bad;
  for (const double duration : {0.0, -0.1, kNaN, kInfinity, -kInfinity, 1.1e5})
    bad.push_back(
        [&stepper, duration] { stepper.step(duration, turning(0), true); });
  for (std::size_t axis = 0; axis < kCaseAxisCount; ++axis)
    for (const double value : {kNaN, kInfinity, -kInfinity, 1e9})
      for (const bool at_end : {false, true})
        bad.push_back([&stepper, axis, value, at_end] {
          StepInputs wrong = turning(0);
          wrong.motion[axis] = value;
          stepper.step(0.1, at_end ? turning(0) : wrong,
                       at_end ? wrong : turning(0), true);
        });
  for (const double ambient : {kNaN, kInfinity, -5.0, 151.0, -101.0, 1e9})
    bad.push_back([&stepper, ambient] {
      stepper.step(0.1, turning(0, ambient == -5.0 ? -280 : ambient), true);
    });
  for (const auto& call : bad) {
    EXPECT_THROW(call(), std::invalid_argument);
    EXPECT_EQ(stepper.state(), before);
    EXPECT_TRUE(same_bits(stepper.now(), sample));
  }
  for (const std::string& bytes :
       {std::string(), std::string("x"), before + "x",
        before.substr(0, before.size() - 1)}) {
    EXPECT_THROW(stepper.restore(bytes), std::invalid_argument);
    EXPECT_EQ(stepper.state(), before);
  }
}

TEST(GyroStepper, AStepThatTheMaterialsDoNotStandChangesNothing) {
  GyroStepper stepper =
      stepper_of("nominal", {}, {"thermal.electronics_power_W=20"});
  const std::string before = stepper.state();
  EXPECT_THROW(stepper.step(1e4, turning(0, 140), true), SimulationFailure);
  EXPECT_EQ(stepper.state(), before);
  stepper.step(0.1, turning(0), true);
  EXPECT_NEAR(stepper.time(), 0.1, 1e-15);
}

TEST(GyroStepper, ABadStartIsRefused) {
  const std::vector<StepperStart> bad = {
      {.noise_rate = -1},
      {.noise_rate = kNaN},
      {.noise_rate = kInfinity},
      {.inputs = turning(kNaN)},
      {.inputs = turning(0, 200)},
      {.temperatures = NodeVector::Constant(0)},
      {.temperatures = NodeVector::Constant(kNaN)},
      {.age = -1.0},
      {.age = kNaN},
  };
  for (const StepperStart& start : bad)
    EXPECT_THROW(stepper_of("nominal", start), std::invalid_argument);
}

}  // namespace
}  // namespace beamgyro::internal::gyro_stepper_test
