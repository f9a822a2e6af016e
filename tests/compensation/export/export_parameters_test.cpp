// SPDX-License-Identifier: MIT
#include "compensation/export/export_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::export_parameters_test {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr TemperatureRange kRange = {.lowest = -40.0, .highest = 50.0};

// Values by name, singles as an autopilot keeps them, and the types in PX4's.
struct Parameters {
  std::map<std::string, float> value;
  std::map<std::string, int> type;
};

Parameters parse_px4(const std::string& text) {
  Parameters parameters;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '#') continue;
    std::istringstream cells(line);
    std::string vehicle, component, name;
    float value = 0.0f;
    int type = 0;
    cells >> vehicle >> component >> name >> value >> type;
    EXPECT_TRUE(cells && cells.eof()) << line;
    EXPECT_EQ(vehicle + component, "11") << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), '\t'), 4) << line;
    EXPECT_TRUE(parameters.value.emplace(name, value).second) << line;
    parameters.type[name] = type;
  }
  return parameters;
}

Parameters parse_ardupilot(const std::string& text) {
  Parameters parameters;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '#') continue;
    const std::size_t comma = line.find(',');
    EXPECT_NE(comma, std::string::npos) << line;
    EXPECT_TRUE(
        parameters.value
            .emplace(line.substr(0, comma), std::stof(line.substr(comma + 1)))
            .second)
        << line;
  }
  return parameters;
}

double at(const Parameters& parameters, const std::string& name) {
  return static_cast<double>(parameters.value.at(name));
}

// What PX4 takes off the rate [deg/s].
double px4_bias(const Parameters& p, const std::string& gyro, int axis,
                double temperature) {
  const double d =
      std::clamp(temperature, at(p, gyro + "TMIN"), at(p, gyro + "TMAX")) -
      at(p, gyro + "TREF");
  double offset = 0.0;
  for (int k = 3; k >= 0; --k)
    offset = offset * d +
             at(p, gyro + "X" + std::to_string(k) + "_" + std::to_string(axis));
  return offset * kDegPerRad;
}

// What ArduPilot takes off the rate [deg/s], as correct_sensor() of its
// AP_InertialSensor_TCal does: it clamps the calibration temperature, too.
double ardupilot_bias(const Parameters& p, int instance, char axis,
                      double temperature) {
  const std::string n = std::to_string(instance);
  const std::string calibration = "INS_TCAL" + n + "_";
  const auto polynomial = [&](double x) {
    double sum = 0.0;
    for (int k = 3; k >= 1; --k)
      sum =
          (sum + at(p, calibration + "GYR" + std::to_string(k) + "_" + axis)) *
          x;
    return 1e-6 * sum;
  };
  const double low = at(p, calibration + "TMIN"),
               high = at(p, calibration + "TMAX");
  const double T = std::clamp(temperature, low, high);
  const double reference =
      std::clamp(at(p, "INS_GYR" + n + "_CALTEMP"), low, high);
  const double offset =
      at(p, "INS_GYR" + (instance == 1 ? "" : n) + "OFFS_" + axis);
  return (polynomial(T - 35.0) - polynomial(reference - 35.0) + offset) *
         kDegPerRad;
}

double compensator_bias(const BiasModel& bias, double temperature,
                        const TemperatureRange& range = kRange) {
  Eigen::ArrayXXd x(1, 1);
  x(0, 0) = std::clamp(temperature, range.lowest, range.highest);
  return bias.predict(x)(0);
}

FittedCompensator of_bias(const BiasModel& bias) {
  FittedCompensator c = spline_compensator();
  c.bias = bias;
  return c;
}

BiasModel polynomial(const std::vector<double>& coefficients) {
  return {{{5.0, 45.0}}, {0.5, 2.0}, Polynomial{coefficients}};
}

// Everything an autopilot can hold, with a drift of some deg/s.
std::vector<NamedCompensator> exportable() {
  return {{"none", of_bias({{Scale{}}, {}, NoBias{}})},
          {"constant", of_bias({{Scale{}}, {0.25, 2.0}, ConstantBias{1.5}})},
          {"linear", of_bias(polynomial({0.3, -1.2}))},
          {"cubic", of_bias(polynomial({0.3, -1.2, 0.8, 1.1}))},
          {"px4",
           of_bias({{{5.0, 1.0}}, {}, Polynomial{{2.0, 3e-2, -1e-3, 2e-5}}})},
          {"ardupilot",
           of_bias({{{35.0, 1.0}}, {}, Polynomial{{-1.0, 5e-2, 2e-3, 3e-5}}})}};
}

std::string px4_of(const BiasModel& cubic, char axis = 'z',
                   const AutopilotGyro& gyro = {.instance = 0}) {
  return px4_parameters({{axis, cubic, kRange}}, gyro);
}

std::string ardupilot_of(const BiasModel& cubic, char axis = 'z',
                         int instance = 1,
                         const TemperatureRange& range = kRange) {
  return ardupilot_parameters({{axis, cubic, range}}, {.instance = instance});
}

// Singles hold 6e-8 of terms of some 10 deg/s.
constexpr double kRoundTrip = 1e-6;  // [deg/s]

TEST(Px4Parameters, PublishedEquationGivesTheCompensatorsBias) {
  for (const NamedCompensator& each : exportable()) {
    const Parameters p = parse_px4(
        px4_of(autopilot_cubic(each.compensator, false), 'y', {.instance = 2}));
    for (double T = -45.0; T <= 55.0; T += 0.25) {
      EXPECT_NEAR(px4_bias(p, "TC_G2_", 1, T),
                  compensator_bias(each.compensator.bias, T), kRoundTrip)
          << each.name << " at " << T;
      EXPECT_EQ(px4_bias(p, "TC_G2_", 0, T), 0.0);
      EXPECT_EQ(px4_bias(p, "TC_G2_", 2, T), 0.0);
    }
  }
}

TEST(Px4Parameters, NamesTypesAndReferenceAreThoseOfTheFirmware) {
  const Parameters p = parse_px4(
      px4_of(polynomial({1.0}), 'z', {.instance = 0, .device_id = 2162688}));
  EXPECT_EQ(p.value.size(), 5u + 4u * 3u);
  EXPECT_EQ(p.value.at("TC_G_ENABLE"), 1.0f);
  EXPECT_EQ(p.value.at("TC_G0_ID"), 2162688.0f);
  EXPECT_EQ(p.value.at("TC_G0_TREF"), 5.0f);
  EXPECT_EQ(p.value.at("TC_G0_TMIN"), -40.0f);
  EXPECT_EQ(p.value.at("TC_G0_TMAX"), 50.0f);
  EXPECT_NEAR(at(p, "TC_G0_X0_2"), 2.5 / kDegPerRad, 4e-9);
  for (const auto& [name, type] : p.type)
    EXPECT_EQ(type, name == "TC_G_ENABLE" || name == "TC_G0_ID" ? 6 : 9)
        << name;
}

TEST(ArduPilotParameters, PublishedEquationGivesTheCompensatorsBias) {
  for (const int instance : {1, 3})
    for (const NamedCompensator& each : exportable()) {
      const Parameters p = parse_ardupilot(ardupilot_of(
          autopilot_cubic(each.compensator, false), 'x', instance));
      for (double T = -45.0; T <= 55.0; T += 0.25) {
        EXPECT_NEAR(ardupilot_bias(p, instance, 'X', T),
                    compensator_bias(each.compensator.bias, T), kRoundTrip)
            << each.name << " at " << T;
        EXPECT_EQ(ardupilot_bias(p, instance, 'Z', T), 0.0);
      }
    }
}

TEST(ArduPilotParameters, NamesAndReferenceAreThoseOfTheFirmware) {
  const Parameters first = parse_ardupilot(ardupilot_of(polynomial({1.0})));
  EXPECT_EQ(first.value.size(), 3u + 3u * 3u + 1u + 3u);
  EXPECT_EQ(first.value.at("INS_TCAL1_ENABLE"), 1.0f);
  EXPECT_EQ(first.value.at("INS_TCAL1_TMIN"), -40.0f);
  EXPECT_EQ(first.value.at("INS_TCAL1_TMAX"), 50.0f);
  EXPECT_EQ(first.value.at("INS_GYR1_CALTEMP"), 35.0f);
  EXPECT_NEAR(at(first, "INS_GYROFFS_Z"), 2.5 / kDegPerRad, 4e-9);
  const Parameters second =
      parse_ardupilot(ardupilot_of(polynomial({1.0}), 'z', 2));
  EXPECT_TRUE(second.value.contains("INS_GYR2OFFS_Z"));
  EXPECT_TRUE(second.value.contains("INS_TCAL2_GYR3_X"));
}

// The reference of the polynomial is 35 degC whether training saw it or not.
TEST(ArduPilotParameters, RangesOnEitherSideOfTheReferenceGiveTheBias) {
  const BiasModel cubic = polynomial({0.3, -1.2, 0.8, 1.1});
  for (const auto& [range, reference] :
       std::vector<std::pair<TemperatureRange, float>>{{{-30.0, 20.0}, 20.0f},
                                                       {{-30.0, 34.99}, 34.99f},
                                                       {{-30.0, 60.0}, 35.0f},
                                                       {{35.01, 75.0}, 35.01f},
                                                       {{45.3, 75.0}, 45.3f}}) {
    const Parameters p = parse_ardupilot(ardupilot_of(cubic, 'y', 2, range));
    EXPECT_EQ(p.value.at("INS_GYR2_CALTEMP"), reference);
    for (double T = -40.0; T <= 80.0; T += 0.5)
      EXPECT_NEAR(ardupilot_bias(p, 2, 'Y', T),
                  compensator_bias(cubic, T, range), 3 * kRoundTrip)
          << "up to " << range.highest << " at " << T;
  }
}

// Three gyros, trained over different temperatures.
std::vector<AutopilotAxis> three_axes() {
  return {{'z', polynomial({0.3, -1.2, 0.8, 1.1}), {-40.0, 50.0}},
          {'x', polynomial({-0.7, 0.2}), {-35.0, 55.0}},
          {'y', polynomial({1.5, 0.0, -0.4}), {-42.0, 48.0}}};
}

TEST(AutopilotParameters, SeveralAxesShareAFileAndTheTemperaturesAllSaw) {
  const std::vector<AutopilotAxis> axes = three_axes();
  const TemperatureRange common{-35.0, 48.0};
  EXPECT_EQ(common_range(axes), common);
  const Parameters px4 =
      parse_px4(px4_parameters(axes, {.instance = 1, .device_id = 7}));
  const Parameters ardupilot =
      parse_ardupilot(ardupilot_parameters(axes, {.instance = 3}));
  EXPECT_EQ(px4.value.at("TC_G1_TMAX"), 48.0f);
  EXPECT_EQ(ardupilot.value.at("INS_TCAL3_TMIN"), -35.0f);
  for (const AutopilotAxis& axis : axes)
    for (double T = -50.0; T <= 60.0; T += 0.5) {
      const double expected = compensator_bias(axis.cubic, T, common);
      EXPECT_NEAR(px4_bias(px4, "TC_G1_", axis.axis - 'x', T), expected,
                  kRoundTrip);
      EXPECT_NEAR(ardupilot_bias(ardupilot, 3,
                                 static_cast<char>(axis.axis - 'x' + 'X'), T),
                  expected, kRoundTrip);
    }
}

TEST(AutopilotParameters, AxesWithoutACommonTemperatureAreRefused) {
  const std::string message = rejection([&] {
    px4_parameters({{'x', polynomial({1.0}), {-40.0, 10.0}},
                    {'y', polynomial({1.0}), {20.0, 50.0}}},
                   {.instance = 0});
  });
  EXPECT_NE(message.find("trained from 20.00 degC up and one up to 10.00 degC"),
            std::string::npos)
      << message;
}

std::string refusal(const FittedCompensator& c) {
  return rejection([&] { autopilot_cubic(c, false); });
}

TEST(AutopilotCubic, RefusalNamesTheReasonAndWhatACubicWouldLeave) {
  for (const auto& [compensator, reason] :
       std::vector<std::pair<FittedCompensator, std::string>>{
           {of_bias(polynomial({1, 2, 3, 4, 5, 6})), "its degree is 5"},
           {spline_compensator(), "it is of kind spline"},
           {network_compensator(), "it is of kind bp"}})
    EXPECT_EQ(refusal(compensator),
              "the format holds a cubic of the temperature, and of this "
              "compensator " +
                  reason +
                  "; a cubic fitted to the same rows has 0.4 deg/s rms "
                  "in-sample where this one has 0.1429; fit_cubic "
                  "exports it");
}

TEST(AutopilotCubic, RefusalTellsHeldOutResidualsOfBoth) {
  FittedCompensator c = spline_compensator();
  c.provenance.baseline_held_out_rms = 0.5;
  EXPECT_NE(refusal(c).find("0.4 deg/s rms in-sample and 0.5 held-out where "
                            "this one has 0.1429 and 0.2857"),
            std::string::npos)
      << refusal(c);
}

TEST(AutopilotCubic, OtherInputsAndAScaleFactorAreRefused) {
  FittedCompensator c = of_bias(polynomial({1, 2}));
  EXPECT_NO_THROW(autopilot_cubic(c, false));
  c.inputs = {parse_input("temperature_lowpass(100)")};
  EXPECT_NE(refusal(c).find("it has other inputs than the temperature"),
            std::string::npos);
  c = of_bias(polynomial({1, 2}));
  c.inputs.push_back(parse_input("quadrature"));
  c.bias.input_scales.emplace_back();
  std::get<Polynomial>(c.bias.function).slopes = {0.1};
  EXPECT_NE(refusal(c).find("it has other inputs than the temperature"),
            std::string::npos);
  c = of_bias(polynomial({1, 2}));
  c.scale_factor = LookupTable{Eigen::ArrayXd::LinSpaced(2, -40.0, 50.0),
                               Eigen::ArrayXd::Ones(2)};
  EXPECT_NE(refusal(c).find("it corrects the scale factor"), std::string::npos);
}

TEST(AutopilotCubic, FitCubicExportsTheBaselineOfACompensatorThatIsNoCubic) {
  const FittedCompensator spline = spline_compensator();
  const BiasModel cubic = autopilot_cubic(spline, true);
  const FittedCompensator own = of_bias(polynomial({0.3, -1.2}));
  for (const double T : {-40.0, 0.0, 50.0}) {
    EXPECT_EQ(compensator_bias(cubic, T), compensator_bias(spline.baseline, T));
    EXPECT_EQ(compensator_bias(autopilot_cubic(own, true), T),
              compensator_bias(own.bias, T));
  }
}

TEST(AutopilotParameters, InstancesThereAreNotAreRefused) {
  const BiasModel cubic = polynomial({1.0});
  for (const int instance : {-1, 4})
    EXPECT_EQ(
        rejection([&] { px4_of(cubic, 'z', {.instance = instance}); }),
        "instance " + std::to_string(instance) + ": PX4 has the gyros 0 to 3");
  for (const int instance : {0, 4})
    EXPECT_EQ(rejection([&] { ardupilot_of(cubic, 'z', instance); }),
              "instance " + std::to_string(instance) +
                  ": ArduPilot has the gyros 1 to 3");
}

TEST(ArduPilotParameters, RangesTheFirmwareRefusesAreRefused) {
  for (const TemperatureRange& range :
       {TemperatureRange{20.0, 29.5}, {-71.0, 20.0}, {20.0, 81.0}})
    EXPECT_NE(
        rejection([&] { ardupilot_of(polynomial({1.0}), 'z', 1, range); })
            .find("that ArduPilot accepts: within -70 to 80 degC and 10 K "
                  "apart"),
        std::string::npos);
  EXPECT_NO_THROW(ardupilot_of(polynomial({1.0}), 'z', 1, {20.0, 30.0}));
}

}  // namespace
}  // namespace beamgyro::internal::export_parameters_test
