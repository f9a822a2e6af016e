// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "sim/scenario/motion.h"
#include "sim/scenario/rate_profile.h"
#include "sim/signal/output_filter.h"

namespace beamgyro::internal {

/// Returns |a|^2 [m2/s4] behind the output filter, two equal poles `corner`
/// [rad/s], at the times k / output_rate. The mechanics rectify a vibration in
/// front of the filter, so a fast vibration gives its mean square. The result
/// is exact for every signal. At t = 0 the filter has settled on the value
/// there; on a sine it gives the periodic response. `axes` [m/s2] must outlive
/// the stream.
SampleStream filtered_square_acceleration(std::span<const Signal> axes,
                                          double corner, double output_rate);

/// The motion of the case behind the output filter, sample by sample, for a
/// static response to it.
class FilteredMotion {
 public:
  /// `gyro` and `motion` must outlive the object.
  FilteredMotion(const TrimmedGyro& gyro, const Motion& motion,
                 double output_rate);

  /// Goes on to the next `count` samples.
  void next(std::size_t count);

  /// Returns the motion at sample `k` of the present ones.
  CaseMotion at(std::size_t k) const;

 private:
  struct Filtered {
    SampleStream filtered;
    std::vector<double> values;

    void next(std::size_t count);
  };

  const MountParameters& mount_;
  PerAxis<Filtered> axes_;
  Filtered square_;
};

}  // namespace beamgyro::internal
