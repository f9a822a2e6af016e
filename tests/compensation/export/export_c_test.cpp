// SPDX-License-Identifier: MIT
#include "compensation/export/export_c.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "compensation/export/export_findings.h"
#include "compensation/export/firmware_model.h"
#include "compensation/firmware/c_text.h"
#include "tests/compensation/sample_compensators.h"
#include "tests/config/rejection.h"

namespace beamgyro::internal::export_c_test {
namespace {

FittedCompensator one_of_kind(const std::string& name) {
  for (const NamedCompensator& each : one_of_each_kind())
    if (each.name == name) return each.compensator;
  throw std::logic_error(name);
}

TEST(ExportedC, NeitherDoublePrecisionNorALibraryNorAllocation) {
  for (const NamedCompensator& each : one_of_each_kind()) {
    const ExportedC c = export_c(each.compensator, "gyro");
    for (const char* part : {"double", "math.h", "malloc", "stdlib"})
      EXPECT_FALSE(holds(c.header + c.source + c.self_test, part))
          << each.name << ": " << part;
  }
}

TEST(ExportedC, HeaderDeclaresWhatTheSourceDefines) {
  for (const NamedCompensator& each : one_of_each_kind()) {
    const ExportedC c = export_c(each.compensator, "left_gyro");
    EXPECT_TRUE(holds(c.header, "#ifndef LEFT_GYRO_H\n#define LEFT_GYRO_H\n"));
    for (const char* declaration :
         {"int left_gyro_init(left_gyro_state *state, float period)",
          "float left_gyro_step(left_gyro_state *state, const left_gyro_sample "
          "*sample)",
          "uint32_t left_gyro_crc(void)"}) {
      EXPECT_TRUE(holds(c.header, std::string(declaration) + ";")) << each.name;
      EXPECT_TRUE(holds(c.source, std::string(declaration) + " {"))
          << each.name;
    }
  }
}

TEST(ExportedC, HeaderTellsTheChecksumTheInputsAndTheRange) {
  const FittedCompensator compensator = network_compensator();
  const std::string header = export_c(compensator, "gyro").header;
  EXPECT_TRUE(holds(header, fmt::format("#define gyro_CRC 0x{:08x}u\n",
                                        FirmwareModel(compensator).crc())));
  EXPECT_TRUE(holds(header, "x[1]: temperature_lowpass(0.1)\n"));
  EXPECT_TRUE(holds(header, "Valid from 0.33 to 50.70 degC"));
  EXPECT_TRUE(holds(header, "0.1429 deg/s rms, on held-out runs 0.2857 deg/s"));
}

TEST(ExportedC, HeaderHasMacrosOfTheRangeThePeriodsAndTheDifference) {
  const FittedCompensator compensator = network_compensator();
  const std::string header = export_c(compensator, "gyro").header;
  EXPECT_TRUE(holds(header, "#define gyro_TEMPERATURE_LOWEST 0.33333334f\n"));
  EXPECT_TRUE(holds(header, "#define gyro_TEMPERATURE_HIGHEST 50.7f\n"));
  EXPECT_TRUE(holds(header, "#define gyro_PERIOD_SHORTEST 0.0005f\n"));
  EXPECT_TRUE(holds(header, "#define gyro_PERIOD_LONGEST 20.0f\n"));
  EXPECT_TRUE(
      holds(header, fmt::format("#define gyro_DIFFERENCE {}\n",
                                c_literal(static_cast<float>(
                                    firmware_difference(compensator).rate)))));
}

TEST(ExportedC, HeaderCarriesTheWarningsOfTraining) {
  FittedCompensator c = spline_compensator();
  c.provenance.warnings = {"first */ of two", "second"};
  const std::string header = export_c(c, "g").header;
  EXPECT_TRUE(
      holds(header, "/* WARNING: first _/ of two. */\n/* WARNING: second. */"));
}

TEST(ExportedC, SelfTestNamesTheOptionsThatChangeBits) {
  const std::string text = export_c(spline_compensator(), "g").self_test;
  EXPECT_TRUE(holds(text, "-ffp-contract=off and without -ffast-math"));
}

TEST(ExportedC, DifferencesBeyondTheLimitAreRefusedOrCarriedInTheCode) {
  FittedCompensator c = network_compensator();
  auto& network = std::get<BpNetwork>(c.bias.function);
  network.set_weights(100.0 * network.weights());
  const std::string refusal = rejection([&] { export_c(c, "g"); });
  EXPECT_TRUE(holds(refusal,
                    "from those of compensate, and 0.0001 deg/s is "
                    "the most"));
  EXPECT_TRUE(holds(refusal, "; force exports it")) << refusal;
  const ExportedC forced = export_c(c, "g", true);
  ASSERT_EQ(forced.warnings.size(), 1u);
  for (const std::string& text : {forced.header, forced.source})
    EXPECT_TRUE(holds(text, "/* WARNING: its answers in single precision"));
}

TEST(ExportedC, CompensatorsThatCancelTheRateAreRefusedOrWarnedOfInTheCode) {
  FittedCompensator c = spline_compensator();
  c.inputs.push_back(parse_input("rate"));
  c.bias = {{{5.0, 45.0}, {0.0, 5.0}}, {}, Polynomial{{0.3, -0.2}, {4.9}}};
  const std::string refusal = rejection([&] { export_c(c, "g"); });
  EXPECT_TRUE(holds(refusal,
                    "it cancels the rate: of a small rate it lets "
                    "0.0200 through"));
  const ExportedC forced = export_c(c, "g", true);
  for (const std::string& text : {forced.header, forced.source})
    EXPECT_TRUE(holds(text, "/* WARNING: it cancels the rate"));
  std::get<Polynomial>(c.bias.function).slopes = {2.4};  // 0.52 are left
  EXPECT_TRUE(export_c(c, "g").warnings.empty());
}

TEST(ExportedC, HoldsEveryParameterAsTheSameSingle) {
  for (const NamedCompensator& each : one_of_each_kind()) {
    const std::string source = export_c(each.compensator, "gyro").source;
    const FirmwareModel model(each.compensator);
    for (const FirmwareArray& array : model.arrays().all()) {
      const std::string start = fmt::format("static const float {}[{}] = {{",
                                            array.name, array.values.size());
      ASSERT_TRUE(holds(source, start)) << each.name << ": " << array.name;
      const char* at = source.data() + source.find(start) + start.size();
      for (const float value : array.values) {
        char* end = nullptr;
        ASSERT_EQ(std::strtof(at, &end), value)
            << each.name << ": " << array.name;
        ASSERT_EQ(std::string(end, 2), "f,");
        at = end + 2;
      }
      ASSERT_EQ(std::string(at, 3), "\n};");
    }
  }
}

TEST(ExportedC, CarriesOnlyTheFunctionsItCalls) {
  const std::string cubic = export_c(one_of_kind("polynomial"), "g").source;
  EXPECT_TRUE(holds(cubic, "polynomial_of("));
  for (const char* other : {"tanh_of", "exp_minus", "lowpass", "table_at"})
    EXPECT_FALSE(holds(cubic, other)) << other;
  const std::string network = export_c(network_compensator(), "g").source;
  EXPECT_TRUE(holds(network, "tanh_of("));
  EXPECT_FALSE(holds(network, "polynomial_of("));
}

TEST(ExportedC, SampleHasTheSignalsThatAreRead) {
  const std::string few = export_c(spline_compensator(), "g").header;
  EXPECT_TRUE(holds(few, "float temperature_degC;\n"));
  EXPECT_FALSE(holds(few, "quadrature_deg_per_s"));
  const std::string many =
      export_c(one_of_kind("bp_with_every_input"), "g").header;
  for (const char* field :
       {"rate_deg_per_s", "temperature_degC", "quadrature_deg_per_s",
        "drive_frequency_change_Hz", "drive_voltage_V"})
    EXPECT_TRUE(holds(many, field)) << field;
}

TEST(ExportedC, WhatAFileSaysOfItsMethodStaysInTheComment) {
  FittedCompensator c = spline_compensator();
  c.provenance.method = "spline */ int evil; /* \\\n?";
  const std::string header = export_c(c, "g").header;
  EXPECT_TRUE(holds(header, "drift: spline _/ int evil; /_ ___.\n"));
}

TEST(ExportedC, ParameterBeyondSinglePrecisionIsRefused) {
  FittedCompensator c = spline_compensator();
  c.bias.bias_scale.centre = 1e300;
  EXPECT_TRUE(holds(rejection([&] { export_c(c, "g"); }),
                    "does not fit single precision"));
}

TEST(CText, LiteralsReadBackToTheSameSingle) {
  for (const float value :
       {0.0f, -1.0f, 0.1f, 1.0f / 3.0f, 1e-30f, -3.4e38f, 16777216.0f,
        std::numeric_limits<float>::denorm_min()}) {
    const std::string text = c_literal(value);
    EXPECT_EQ(std::strtof(text.c_str(), nullptr), value) << text;
    EXPECT_NE(text.find_first_of(".e"), std::string::npos) << text;
    EXPECT_EQ(text.back(), 'f');
  }
}

TEST(CText, StringsHoldQuotesAndNoTrigraph) {
  EXPECT_EQ(c_string(R"({"a": "b\c??/"})"), R"("{\"a\": \"b\\c\?\?/\"}")");
}

TEST(CText, IdentifiersStartWithALetterAndHoldLettersDigitsUnderscores) {
  EXPECT_EQ(c_identifier("gyro_2"), "gyro_2");
  EXPECT_EQ(c_identifier("left gyro-2.final"), "left_gyro_2_final");
  EXPECT_EQ(c_identifier("2nd"), "c_2nd");
  EXPECT_EQ(c_identifier("_x"), "c__x");
  EXPECT_EQ(c_identifier(""), "c_");
  EXPECT_EQ(c_identifier("\xc3\xa9t\xc3\xa9"), "c___t__");
}

}  // namespace
}  // namespace beamgyro::internal::export_c_test
