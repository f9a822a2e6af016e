// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>

#include "compensation/methods/autopilot_methods.h"
#include "compensation/methods/bias_model.h"
#include "random/random_stream.h"
#include "tests/compensation/recorded_run.h"
#include "tests/config/rejection.h"
#include "tests/linear_algebra/reference_algebra.h"

namespace beamgyro::internal::autopilot_fits_test {
namespace {

// Monotone from -20 to 60 degC, so that a median leaves it as it is.
double cubic(double T) {
  const double x = T - 20.0;
  return 0.3 + 0.02 * x - 1e-4 * x * x + 3e-6 * x * x * x;
}

TrainingRows samples_of(const Recording& recording) {
  return training_rows(source_of({{"run.h5", "", recording}}),
                       {parse_input("temperature")}, {0.0, {}});
}

// 10 samples a second; bias as `bias` of temperature and time.
RecordedRun run_of(double duration, const SignalOfTime& temperature) {
  RecordedRun run{.duration = duration, .step = 0.1};
  run.temperature = temperature;
  run.bias = [=](double t) { return cubic(temperature(t)); };
  return run;
}

SignalOfTime ramp(double low, double K_per_s) {
  return [=](double t) { return low + K_per_s * t; };
}

const std::vector<double>& coefficients(const BiasModel& model) {
  return std::get<Polynomial>(model.function).coefficients;
}

// Derivatives of cubic() over n!, about another reference.
std::vector<double> about(double reference) {
  return shifted({0.3, 0.02, -1e-4, 3e-6}, reference - 20.0);
}

void expect_coefficients(const BiasModel& model, double reference,
                         const std::vector<double>& tolerance) {
  const std::vector<double> expected = about(reference);
  ASSERT_EQ(coefficients(model).size(), 4u);
  for (std::size_t n = 0; n < 4; ++n)
    EXPECT_NEAR(coefficients(model)[n], expected[n], tolerance[n]) << n;
}

// -20 ... 60 degC in 4000 s.
const SignalOfTime kWholeRange = ramp(-20.0, 0.02);

TEST(FitAsPx4, IsTheCubicInKelvinsAboutTheMiddleOfTheRange) {
  const BiasModel model =
      fit_as_px4(samples_of(run_of(4000.0, kWholeRange).recording()));
  EXPECT_NEAR(model.input_scales[0].centre, 20.0, 2e-3);  // one sample short
  EXPECT_EQ(model.input_scales[0].half_width, 1.0);
  EXPECT_EQ(model.bias_scale, Scale{});
  // The mean over a bin of h = 0.04 K is off by b'' h^2 / 24, the median at
  // both ends of the run by up to 7 samples of 2e-3 K.
  expect_coefficients(model, model.input_scales[0].centre,
                      {3e-7, 1e-7, 1e-9, 2e-10});
}

TEST(FitAsPx4, MedianRemovesOutliers) {
  const auto fit = [](double outlier) {
    RecordedRun run = run_of(4000.0, kWholeRange);
    const SignalOfTime bias = run.bias;
    run.bias = [=](double t) {
      const long k = std::lround(10.0 * t);
      // Up to 15 in a row of 31.
      return (k + 100) % 200 < 15 ? bias(t) + outlier : bias(t);
    };
    return fit_as_px4(samples_of(run.recording()));
  };
  Eigen::ArrayXd T = Eigen::ArrayXd::LinSpaced(81, -20.0, 60.0);
  EXPECT_LT((fit(500.0).predict(T) - fit(0.0).predict(T)).abs().maxCoeff(),
            0.01);
}

// Half the samples at the hot end are one bin of 2000.
TEST(FitAsPx4, ALongHotEndDoesNotOutweighTheCold) {
  const auto fits = [](double held) {
    RecordedRun run = run_of(4000.0 + held, [](double t) {
      return -20.0 + 0.02 * std::min(t, 4000.0);
    });
    run.bias = [T = run.temperature](double t) {
      return std::sin(0.08 * T(t));  // no cubic
    };
    const TrainingRows rows = samples_of(run.recording());
    return std::pair{fit_as_px4(rows),
                     fit_polynomial(rows.temperature / 60.0, rows.bias, 3)};
  };
  Eigen::ArrayXd T = Eigen::ArrayXd::LinSpaced(81, -20.0, 60.0);
  const auto [brief, brief_plain] = fits(0.0);
  const auto [lasting, lasting_plain] = fits(8000.0);
  EXPECT_LT((brief.predict(T) - lasting.predict(T)).abs().maxCoeff(), 2e-3);
  EXPECT_GT((brief_plain.predict(T / 60.0) - lasting_plain.predict(T / 60.0))
                .abs()
                .maxCoeff(),
            0.1);
}

// The cubic through points of temperature and bias about a reference, in units
// of `scale` [K].
void expect_least_squares(const BiasModel& model,
                          const std::vector<std::pair<double, double>>& points,
                          double centre, double scale, double tolerance) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(points.size()), 4);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index k = 0; k < A.rows(); ++k) {
    const auto& [T, mean] = points[static_cast<std::size_t>(k)];
    const double x = (T - centre) / scale;
    A.row(k) << 1.0, x, x * x, x * x * x;
    b(k) = mean;
  }
  const Eigen::VectorXd c = reference::least_squares(A, b);
  for (int n = 0; n < 4; ++n)
    EXPECT_NEAR(
        coefficients(model)[static_cast<std::size_t>(n)] * std::pow(scale, n),
        c(n), tolerance)
        << n;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(FitAsPx4, EqualsLeastSquaresOverTheBinsOfTheFilteredSamples) {
  RecordedRun run = run_of(900.0, [](double t) {
    return -20.0 + 80.0 * (1.0 - std::exp(-t / 200.0));
  });
  RandomStream random(3, 0, 0, RandomPurpose{0});
  run.bias = [T = run.temperature, &random](double t) {
    return std::sin(0.08 * T(t)) + 0.3 * random.normal();
  };
  const TrainingRows rows = samples_of(run.recording());
  const double low = rows.temperature.minCoeff(),
               high = rows.temperature.maxCoeff();
  std::map<long, std::vector<std::pair<double, double>>> bins;
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    std::vector<double> window;
    for (Eigen::Index j = std::max<Eigen::Index>(0, k - 15);
         j <= std::min(rows.size() - 1, k + 15); ++j)
      window.push_back(rows.bias(j));
    const double place = (rows.temperature(k) - low) / (high - low) * 2000.0;
    bins[std::min(std::lround(std::floor(place)), 1999L)].push_back(
        {rows.temperature(k), median_of(window)});
  }
  std::vector<std::pair<double, double>> means;
  for (const auto& [number, points] : bins) {
    double T = 0.0, mean = 0.0;
    for (const auto& [here, value] : points) {
      T += here / double(points.size());
      mean += value / double(points.size());
    }
    means.push_back({T, mean});
  }
  const BiasModel model = fit_as_px4(rows);
  EXPECT_EQ(model.input_scales[0].centre, 0.5 * (low + high));
  expect_least_squares(model, means, 0.5 * (low + high), 40.0, 1e-11);
}

TEST(FitAsPx4, NeedsARangeOfTemperatures) {
  EXPECT_TRUE(holds(rejection([] {
                      fit_as_px4(samples_of(run_of(100.0, [](double) {
                                              return 25.0;
                                            }).recording()));
                    }),
                    "temperature is 25 degC throughout"));
}

TEST(FitAsArduPilot, IsTheCubicInKelvinsAbout35WithAConstantTerm) {
  const BiasModel model = fit_as_ardupilot(
      samples_of(run_of(4000.0, kWholeRange).recording()), 100);
  EXPECT_EQ(model.input_scales[0], (Scale{35.0, 1.0}));
  EXPECT_EQ(model.bias_scale, Scale{});
  // Samples after a point count from its end on, half a sample late: 1e-3 K on
  // a slope of 0.019 deg/s/K. The 2 s of average lag alike on both signals.
  expect_coefficients(model, 35.0, {4e-5, 2e-6, 2e-7, 4e-9});
}

// Points told from the samples one by one: means of 2 s by summing anew.
std::vector<std::pair<double, double>> points_of(const TrainingRows& rows,
                                                 int least) {
  std::vector<std::pair<double, double>> points;
  double start = 0.0, sum = 0.0;
  int count = -1;
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    double T = 0.0, b = 0.0, n = 0.0;
    for (Eigen::Index j = k; j >= 0 && rows.time(k) - rows.time(j) <= 2.0;
         --j) {
      T += rows.temperature(j);
      b += rows.bias(j);
      n += 1.0;
    }
    T /= n;
    if (count < 0) {
      start = T;
      count = 0;
    }
    if (T < start) continue;
    sum += b / n;
    if (++count >= least && T - start >= 0.5) {
      points.push_back({0.5 * (start + T), sum / count});
      start = T;
      sum = count = 0;
    }
  }
  return points;
}

TEST(FitAsArduPilot, EqualsLeastSquaresOverTheRisesOfHalfAKelvin) {
  RecordedRun run = run_of(1500.0, [](double t) {
    return -20.0 + 80.0 * (1.0 - std::exp(-t / 600.0)) + 0.4 * std::sin(t);
  });
  RandomStream random(4, 0, 0, RandomPurpose{0});
  run.bias = [T = run.temperature, &random](double t) {
    return std::sin(0.08 * T(t)) + 0.3 * random.normal();
  };
  const TrainingRows rows = samples_of(run.recording());
  const auto points = points_of(rows, 30);
  ASSERT_GT(points.size(), 80u);
  expect_least_squares(fit_as_ardupilot(rows, 30), points, 35.0, 55.0, 1e-8);
}

TEST(FitAsArduPilot, LearnsNothingWhileCooling) {
  const RecordedRun heating = run_of(2000.0, kWholeRange);
  RecordedRun both = run_of(4000.0, [](double t) {
    return t < 2000.0 ? kWholeRange(t) : kWholeRange(4000.0 - t);
  });
  both.bias = [T = both.temperature](double t) {
    return cubic(T(t)) + (t < 2000.0 ? 0.0 : 5.0);
  };
  EXPECT_EQ(
      coefficients(fit_as_ardupilot(samples_of(both.recording()), 100)),
      coefficients(fit_as_ardupilot(samples_of(heating.recording()), 100)));
}

TEST(FitAsArduPilot, ARiseAgainIsLearntFromTheLastPointOn) {
  // Up to 20, down to 0, up to 60 degC; the second rise up to 20 degC is off.
  const auto temperature = [](double t) {
    if (t < 2000.0) return -20.0 + 0.02 * t;
    return t < 3000.0 ? 20.0 - 0.02 * (t - 2000.0) : 0.02 * (t - 3000.0);
  };
  RecordedRun run = run_of(6000.0, temperature);
  run.bias = [=](double t) {
    return cubic(temperature(t)) + (t > 2100.0 && t < 3900.0 ? 5.0 : 0.0);
  };
  expect_coefficients(fit_as_ardupilot(samples_of(run.recording()), 100), 35.0,
                      {0.01, 1e-3, 1e-4, 1e-6});
}

TEST(FitAsArduPilot, EachPowerOnIsLearntFromAnew) {
  RecordedRun run = run_of(8100.0, [](double t) {
    return kWholeRange(t < 4000.0 ? t : t - 4100.0);
  });
  run.powered = [](double t) { return t < 4000.0 || t >= 4100.0; };
  run.bias = [T = run.temperature](double t) {
    return cubic(T(t)) + (t < 4000.0 ? 0.0 : 1.0);
  };
  const BiasModel model = fit_as_ardupilot(samples_of(run.recording()), 100);
  EXPECT_NEAR(coefficients(model)[0], cubic(35.0) + 0.5, 1e-3);
}

TEST(FitAsArduPilot, RefusesWhatItsCalibrationRefuses) {
  const auto fit = [](double span, double seconds, int least_samples) {
    fit_as_ardupilot(
        samples_of(run_of(seconds, ramp(20.0, span / seconds)).recording()),
        least_samples);
  };
  const auto message = [&](double span, double seconds, int least_samples) {
    return rejection([&] { fit(span, seconds, least_samples); });
  };
  EXPECT_TRUE(holds(message(9.9, 1000.0, 100), "needs 10 K"));
  EXPECT_NO_THROW(fit(10.1, 1000.0, 100));
  // 10.1 K in 450 samples is one rise of 100 samples four times, in 350 three.
  EXPECT_NO_THROW(fit(10.1, 45.0, 100));
  EXPECT_TRUE(holds(message(10.1, 35.0, 100), "over 100 samples 3 times"));
  // Cooling only.
  EXPECT_TRUE(holds(message(-40.0, 1000.0, 100), "0 times"));
}

}  // namespace
}  // namespace beamgyro::internal::autopilot_fits_test
