// SPDX-License-Identifier: MIT
#include "compensation/training/left_out_sigma.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compensation/methods/fit.h"
#include "compensation/methods/population.h"
#include "compensation/models/array_view.h"
#include "compensation/models/undetermined_fit.h"
#include "compensation/training/cross_validation.h"

namespace beamgyro::internal {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;

constexpr int kLeastLeftOut = 3;
constexpr double kLeastRms = 1e-6;  // [deg/s]: residuals of 0 promise nothing

// Mean temperature and square of the mean residual of groups that the others
// surround.
struct LeftOutGroups {
  std::vector<double> temperature, square;
};

LeftOutGroups left_out_groups(const TrainingRows& rows, const RowGroups& groups,
                              const ArrayXd& residual) {
  LeftOutGroups found;
  for (int group = 0; group < groups.count; ++group) {
    const RowMask own = between_others(rows, groups, group);
    double count = 0.0, T = 0.0, sum = 0.0;
    for (Index k = 0; k < rows.size(); ++k) {
      if (!own(k)) continue;
      count += 1.0;
      T += rows.temperature(k);
      sum += residual(k);
    }
    if (count == 0.0) continue;
    found.temperature.push_back(T / count);
    found.square.push_back(sum / count * (sum / count));
  }
  return found;
}

// Inputs at temperatures, all others at their means.
ArrayXXd inputs_at(const TrainingRows& rows, const ArrayXd& T) {
  ArrayXXd x = rows.inputs.colwise().mean().replicate(T.size(), 1);
  x.col(0) = T;
  return x;
}

// h at temperatures.
ArrayXd leverage(const FitSpec& kind, const std::vector<Input>& inputs,
                 const TrainingRows& rows, const RowGroups& groups,
                 const ArrayXd& T, std::uint64_t seed) {
  ArrayXd sum = ArrayXd::Zero(T.size());
  TrainingRows moved = rows;
  for (int group = 0; group < groups.count; ++group) {
    moved.bias = (groups.of_row == group).cast<double>();
    sum += fit_model(kind, inputs, moved, {}, seed)
               .model.predict(inputs_at(rows, T))
               .square();
  }
  return sum;
}

template <class Count>
[[noreturn]] void fail_soaks(Count found, const char* where) {
  throw UndeterminedFit(fmt::format(
      "the rows have {} soaks{}; expected {} or more, each to be predicted by "
      "the others",
      found, where, kLeastLeftOut));
}

}  // namespace

ArrayXd local_rms(const Eigen::Ref<const ArrayXd>& T,
                  const Eigen::Ref<const ArrayXd>& squares, const ArrayXd& at) {
  const double span = T.maxCoeff() - T.minCoeff();
  const double width = span > 0.0 ? span / 8.0 : 1.0;  // [K]
  const double shared = 0.1 * static_cast<double>(T.size());
  ArrayXd result(at.size());
  for (Index k = 0; k < at.size(); ++k) {
    const ArrayXd weights = (-0.5 * ((T - at(k)) / width).square()).exp();
    const double mean = ((weights * squares).sum() + shared * squares.mean()) /
                        (weights.sum() + shared);
    result(k) = std::max(std::sqrt(mean), kLeastRms);
  }
  return result;
}

RowGroups soak_groups(const TrainingRows& rows) {
  RowGroups groups{Grouping::kSegment, Eigen::ArrayXi(rows.size()), 0};
  double first = 0.0;
  for (Index k = 0; k < rows.size(); ++k) {
    const bool anew = k == 0 || rows.cycle(k) != rows.cycle(k - 1) ||
                      std::abs(rows.temperature(k) - first) >= kPointWidth;
    if (anew) {
      first = rows.temperature(k);
      ++groups.count;
    }
    groups.of_row(k) = groups.count - 1;
  }
  return groups;
}

LeftOutSigma left_out_sigma(const FitSpec& kind,
                            const std::vector<Input>& inputs,
                            const TrainingRows& rows, const ArrayXd& at,
                            std::uint64_t seed) {
  const RowGroups groups = soak_groups(rows);
  if (groups.count < kLeastLeftOut) fail_soaks(groups.count, "");
  RowGroups folds = groups;
  folds.count = std::min(groups.count, kMostLeftOut);
  folds.of_row =
      groups.of_row.unaryExpr([](int group) { return group % kMostLeftOut; });
  const Predictions unseen = predict_unseen(kind, inputs, rows, folds, seed);
  const LeftOutGroups left =
      left_out_groups(rows, groups, rows.bias - unseen.bias);
  if (left.square.size() < kLeastLeftOut)
    fail_soaks(left.square.size(), " between the temperatures of the others");
  const ArrayXd T = array_view(left.temperature);
  ArrayXd sigma = local_rms(T, array_view(left.square), at);
  if (groups.count <= kMostLeftOut) {
    const double usual = leverage(kind, inputs, rows, groups, T, seed).mean();
    sigma *=
        ((1.0 + leverage(kind, inputs, rows, groups, at, seed)) / (1.0 + usual))
            .sqrt();
  }
  return {{at, sigma}, static_cast<int>(left.square.size())};
}

}  // namespace beamgyro::internal
