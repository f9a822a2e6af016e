// SPDX-License-Identifier: MIT
#include "compensation/export/firmware_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "compensation/firmware/runtime.h"
#include "compensation/inputs/features.h"
#include "tests/compensation/recorded_run.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::firmware_model_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Two power cycles over more than the range of temperature, every signal.
Recording eventful_recording() {
  RecordedRun run{.duration = 4000.0, .step = 0.5};
  run.powered = [](double t) { return t < 1500.0 || t >= 1600.0; };
  run.temperature = [](double t) {
    return 5.0 + 48.0 * std::sin(0.004 * t) + 0.1 * std::sin(0.9 * t);
  };
  run.bias = [](double t) { return std::sin(0.01 * t); };
  run.true_rate = [](double t) { return 100.0 * std::sin(0.1 * t); };
  Recording recording = run.recording();
  const auto add = [&](const char* name, double centre, double amplitude) {
    std::vector<double> values;
    for (std::size_t k = 0; k < recording.time.size(); ++k)
      values.push_back(recording.status[k] != 0
                           ? std::numeric_limits<double>::quiet_NaN()
                           : centre + amplitude *
                                          std::sin(0.003 * recording.time[k]));
    recording.columns.push_back({name, "1", name, Role::kMeasured, values});
  };
  add("drive_frequency", 9156.0, 12.0);
  add("drive_voltage", 1.5, 0.7);
  add("quadrature", 40.0, 25.0);
  return recording;
}

// Largest difference [deg/s] from compensated_rate() in double precision.
double worst_error(const FittedCompensator& compensator,
                   const Recording& recording) {
  const std::vector<double> expected = compensated_rate(compensator, recording);
  FirmwareModel model(compensator);
  bool powered = false;
  double worst = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const bool now = (recording.status[k] & kUnpowered) == 0;
    if (now && !powered) model.start(0.5f);
    powered = now;
    if (!now) continue;
    FirmwareSample sample;
    for (std::size_t s = 0; s < kFirmwareSignalCount; ++s)
      sample.value[s] = static_cast<float>(
          column_values(recording, kFirmwareSignals[s])[k] -
          (s == kFirmwareDriveFrequency ? model.drive_frequency() : 0));
    const double error = std::abs(model.step(sample) - expected[k]);
    if (std::isnan(error)) return error;
    worst = std::max(worst, error);
  }
  return worst;
}

// rate - f(input), f the identity unless it is told otherwise.
FittedCompensator of_input(const std::string& name) {
  FittedCompensator c;
  c.inputs = {parse_input(name)};
  c.bias = {{Scale{}}, {}, Polynomial{{0.0, 1.0}}};
  c.temperature_range = {.lowest = -300.0, .highest = 300.0};
  return c;
}

FirmwareSample at(float temperature, float rate = 0.0f) {
  FirmwareSample sample;
  sample.value[0] = rate;
  sample.value[1] = temperature;
  return sample;
}

// Temperature of a chamber in steps and ramps, as the sensor shows it.
double chamber(double t) {
  const double ramp = 40.0 * std::sin(0.01 * t) + (t > 90.0 ? 20.0 : 0.0);
  return std::round(ramp / 0.05) * 0.05;
}

TEST(FirmwareModel, AgreesWithDoublePrecisionOverPowerCycles) {
  const Recording recording = eventful_recording();
  // A single holds 6e-8 of 100 deg/s and of biases of some deg/s; 8e-6 deg/s
  // was the worst.
  for (const NamedCompensator& each : one_of_each_kind())
    EXPECT_LT(worst_error(each.compensator, recording), 2e-5) << each.name;
}

// As training without weight decay leaves them: neurons that cancel.
TEST(FirmwareModel, LargeWeightsOfANetworkAgreeTo1e4) {
  FittedCompensator c = network_compensator();
  auto& network = std::get<BpNetwork>(c.bias.function);
  Eigen::VectorXd w = network.weights();
  const Eigen::Index last = w.size() - 5;  // weights of four neurons, bias
  for (Eigen::Index k = 0; k < 4; ++k) w(last + k) = k % 2 == 0 ? 15.0 : -15.0;
  network.set_weights(w);
  EXPECT_LT(worst_error(c, eventful_recording()), 1e-4);
}

// Largest difference of an input from `exact` of the time [s] and the
// temperature of the chamber, which is run through at a pace of `pace`.
double worst_of(const std::string& input, float period,
                const std::function<double(double, double)>& exact,
                int samples = 3000, double pace = 1.0) {
  FirmwareModel model(of_input(input));
  model.start(period);
  double worst = 0.0;
  for (int k = 0; k < samples; ++k) {
    const double t = k * static_cast<double>(period);
    const double T = chamber(pace * t);
    const double error =
        std::abs(-model.step(at(static_cast<float>(T))) - exact(t, T));
    EXPECT_FALSE(std::isnan(error)) << "sample " << k;
    worst = std::max(worst, error);
  }
  return worst;
}

// Of 60 degC a single holds 4e-6, in what goes in and what comes out.
constexpr double kOfSingles = 8e-6;

TEST(FirmwareModel, LowPassFollowsItsClosedFormFromShortToLongPeriods) {
  for (const float period : {0.01f, 0.5f, 7.0f, 12.5f, 100.0f}) {
    LowPass exact(7.0);
    EXPECT_LE(worst_of("temperature_lowpass(7)", period,
                       [&](double t, double T) { return exact.step(t, T); }),
              kOfSingles)
        << "period " << period;
  }
}

TEST(FirmwareModel, RateOfTemperatureFollowsItsClosedForm) {
  for (const float period : {0.1f, 5.0f, 150.0f}) {
    LowPass exact(60.0);
    // Over 60 s, what a single holds of temperatures of 60 degC: 4e-6 K.
    EXPECT_LT(worst_of("temperature_rate(60)", period,
                       [&](double t, double T) {
                         return (T - exact.step(t, T)) / 60.0;
                       }),
              2e-7)
        << "period " << period;
  }
}

TEST(FirmwareModel, PlayIsThatOfTheWorkbench) {
  Play exact(3.3);
  EXPECT_LE(worst_of("temperature_play(3.3)", 0.5f,
                     [&](double, double T) { return exact.step(T); }),
            kOfSingles);
}

// A step takes 1.25e-6 of the lag off it, some ten of its last places: without
// the carry the worst is 0.035 K.
TEST(FirmwareModel, SlowFilterAtAFastRateLosesNothingToRounding) {
  LowPass exact(400.0);
  EXPECT_LT(
      worst_of(
          "temperature_lowpass(400)", 0.0005f,
          [&](double t, double T) { return exact.step(t, T); }, 800000, 0.2),
      kOfSingles);
}

TEST(FirmwareModel, TimeSincePowerOnDecaysExponentially) {
  FirmwareModel model(of_input("since_power_on(64)"));
  model.start(0.25f);
  double worst = 0.0;
  for (int k = 0; k < 30000; ++k)
    worst = std::max(
        worst, std::abs(-model.step(at(20.0f)) - std::exp(-k * 0.25 / 64.0)));
  EXPECT_LT(worst, 2e-7);  // half a last place of 1 is 6e-8
}

TEST(FirmwareModel, HyperbolicTangentIsGoodTo5e7) {
  FittedCompensator c = of_input("temperature");
  BpNetwork network({1, 1, 1});
  network.set_weights(Eigen::Vector4d(1.0, 0.0, 1.0, 0.0));
  c.bias.function = network;
  FirmwareModel model(c);
  model.start(1.0f);
  double worst = 0.0;
  for (int k = -100000; k <= 100000; ++k) {
    const float x = 1e-4f * static_cast<float>(k);
    const double error =
        std::abs(-model.step(at(x)) - std::tanh(static_cast<double>(x)));
    ASSERT_FALSE(std::isnan(error)) << x;
    worst = std::max(worst, error);
  }
  EXPECT_LT(worst, 5e-7);
  EXPECT_EQ(-model.step(at(300.0f)), 1.0f);
  EXPECT_EQ(-model.step(at(-300.0f)), -1.0f);
}

TEST(FirmwareModel, TemperaturesOutOfRangeCountAsItsEnds) {
  FirmwareModel model(spline_compensator());  // -40 ... 50 degC
  model.start(1.0f);
  const float coldest = model.step(at(-40.0f)), hottest = model.step(at(50.0f));
  EXPECT_NE(coldest, hottest);
  EXPECT_NE(model.step(at(-39.0f)), coldest);
  EXPECT_EQ(model.step(at(-80.0f)), coldest);
  EXPECT_EQ(model.step(at(90.0f)), hottest);
}

TEST(FirmwareModel, TemperatureThatIsNotFiniteGivesNoneAndHarmsNoFilter) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  FittedCompensator c = of_input("temperature_lowpass(100)");
  c.temperature_range = {.lowest = -40.0, .highest = 50.0};
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    FirmwareModel model(c);
    model.start(1.0f);
    EXPECT_TRUE(std::isnan(model.step(at(bad))));
    EXPECT_EQ(model.step(at(20.0f)), -20.0f);  // the first of the filter
    EXPECT_TRUE(std::isnan(model.step(at(bad))));
    EXPECT_EQ(model.step(at(20.0f)), -20.0f);
    const float before = model.step(at(25.0f));
    EXPECT_TRUE(std::isnan(model.step(at(bad))));
    EXPECT_NEAR(model.step(at(25.0f)), before, 0.05);
    EXPECT_LT(model.step(at(25.0f)), -20.0f);
  }
}

// Temperature and quadrature wait for a sample that has both.
TEST(FirmwareModel, AFilteredSignalThatIsNotFiniteHarmsNoFilter) {
  FirmwareModel model(of_input("quadrature_lowpass(100)"));
  const auto with = [](float quadrature) {
    FirmwareSample sample = at(20.0f);
    sample.value[3] = quadrature;
    return sample;
  };
  model.start(1.0f);
  EXPECT_TRUE(std::isnan(model.step(with(kNan))));
  EXPECT_EQ(model.step(with(40.0f)), -40.0f);
  const float before = model.step(with(50.0f));
  EXPECT_TRUE(std::isnan(model.step(with(kNan))));
  EXPECT_NEAR(model.step(with(50.0f)), before, 0.2);
  EXPECT_LT(model.step(with(50.0f)), -40.0f);
}

TEST(FirmwareModel, SigmaForgetsAGlitchOfTheTemperature) {
  const FittedCompensator c = with_sigma(spline_compensator());
  FirmwareModel model(c);
  model.start(1.0f);
  model.step(at(20.0f));
  const float before = model.sigma();
  for (const float glitch : {1e30f, -1e30f}) {
    model.step(at(glitch));
    EXPECT_TRUE(std::isfinite(model.sigma()));
    model.step(at(20.0f));
    // Of 1000 K for a second, a rate of 1000 K / tau^2 is left.
    EXPECT_LT(
        model.sigma(),
        before + 2.0 * c.sigma->factor * c.sigma->temperature_rate->amplitude *
                     1000.0 /
                     std::pow(c.sigma->temperature_rate->time_constant, 2));
  }
}

// A network would saturate at an infinite input, and answer.
TEST(FirmwareModel, AnyInputThatIsNotFiniteGivesNone) {
  const FittedCompensator c = one_of_each_kind().back().compensator;
  for (const float bad : {kNan, std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()})
    for (std::size_t s = 0; s < kFirmwareSignalCount; ++s) {
      FirmwareModel model(c);
      if (!model.reads(s)) continue;
      model.start(1.0f);
      FirmwareSample sample = at(20.0f);
      sample.value[s] = bad;
      EXPECT_TRUE(std::isnan(model.step(sample))) << kFirmwareSignals[s];
      EXPECT_FALSE(std::isnan(model.step(at(20.0f)))) << kFirmwareSignals[s];
    }
}

TEST(FirmwareModel, RateThatIsNoNumberGivesNone) {
  FirmwareModel model(spline_compensator());
  model.start(1.0f);
  EXPECT_TRUE(std::isnan(model.step(at(20.0f, kNan))));
}

TEST(FirmwareModel, StartForgetsEverything) {
  for (const NamedCompensator& each : one_of_each_kind()) {
    FirmwareModel model(each.compensator);
    const auto answers = [&] {
      std::vector<float> result;
      model.start(0.5f);
      for (int k = 0; k < 50; ++k)
        result.push_back(model.step(at(static_cast<float>(k) - 5.0f, 1.0f)));
      return result;
    };
    const std::vector<float> first = answers();
    EXPECT_EQ(answers(), first) << each.name;
  }
}

TEST(FirmwareModel, ReadsTheSignalsOfItsInputsOnly) {
  const auto signals = [](const FirmwareModel& model) {
    std::string read;
    for (std::size_t k = 0; k < kFirmwareSignalCount; ++k)
      if (model.reads(k)) read += std::string(" ") + kFirmwareSignals[k];
    return read;
  };
  EXPECT_EQ(signals(FirmwareModel(network_compensator())), " rate temperature");
  EXPECT_EQ(signals(FirmwareModel(of_input("drive_voltage"))),
            " rate temperature drive_voltage");
  EXPECT_EQ(signals(FirmwareModel(one_of_each_kind().back().compensator)),
            " rate temperature quadrature drive_frequency drive_voltage");
}

TEST(FirmwareModel, ParameterBeyondSinglePrecisionIsNamed) {
  FittedCompensator c = of_input("temperature");
  c.bias.function = Polynomial{{0.0, 1e39}};
  EXPECT_EQ(rejection([&] { const FirmwareModel model(c); }),
            "the parameter 1e+39 does not fit single precision");
}

// Check values of CRC-32: "12345678" and no byte at all.
TEST(Crc32, OfTheBytesOfSinglesLeastSignificantFirst) {
  EXPECT_EQ(crc32({std::bit_cast<float>(0x34333231u),
                   std::bit_cast<float>(0x38373635u)}),
            0x9ae0daafu);
  EXPECT_EQ(crc32({}), 0u);
}

TEST(Crc32, CoversEveryParameter) {
  FittedCompensator c = of_input("temperature");
  const std::uint32_t before = FirmwareModel(c).crc();
  std::get<Polynomial>(c.bias.function).coefficients[1] = 1.0000001;
  const std::uint32_t coefficient = FirmwareModel(c).crc();
  EXPECT_NE(coefficient, before);
  c.temperature_range.highest = 301.0;
  EXPECT_NE(FirmwareModel(c).crc(), coefficient);
}

TEST(FirmwareRuntime, SectionsAreFoundByName) {
  const std::string tanh = runtime_text("tanh");
  EXPECT_TRUE(holds(tanh, "static float tanh_of(float x)"));
  EXPECT_FALSE(holds(tanh, "polynomial_of"));
  EXPECT_THROW(runtime_text("cosh"), std::logic_error);
}

}  // namespace
}  // namespace beamgyro::internal::firmware_model_test
