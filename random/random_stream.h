// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace beamgyro::internal {

/// What a stream of random numbers is for: a number that is part of the data
/// format. A new purpose takes the next number, at the end; none is changed.
enum RandomPurpose : std::uint32_t {
  kWhiteNoiseStream,
  kFlickerStream,
  kRateRandomWalkStream,
  kTurnOnStream,
  kTemperatureSensorStream,
  kRateProfileStream,
  kInitialWeightsStream,
  kSampleOrderStream,
  kDeviceDrawStream,
  kMechanicalNoiseStream,
  kCrossRateXStream,
  kCrossRateYStream,
  kAccelerationXStream,
  kAccelerationYStream,
  kAccelerationZStream,
  kSobolScrambleStream,
  kIntervalStream,
  kWalkSinceTrimStream,
  kTurnOnTransientStream,
  kQuadratureNoiseStream,
  kDriveFrequencyNoiseStream,
  kDriveVoltageNoiseStream,
  kIndexResampleStream,
  kRankResampleStream,
  kRankSampleStream,
  kResidualForecastStream,
  kQualifiedRunSeedStream,
  kQualifiedRunOrderStream,
  kQualifiedCampaignStream,
  kHalfSplitStream,
  kPlanGainStream,
  kMembershipStream,
};

/// Returns the inverse of the normal distribution function. Throws
/// std::invalid_argument for a probability outside (0, 1). Method: Wichura,
/// algorithm AS 241 (PPND16), Applied Statistics 37 (1988) 477; relative error
/// about 1e-15.
double normal_quantile(double probability);

/// Returns the odd multiple of 2^-53 in (0, 1) with the upper 52 bits of
/// `word`.
double uniform_number(std::uint64_t word);

/// Numbers from the counter-based generator Philox4x32-10 (Salmon et al., SC
/// 2011): key = seed, counter = (block, purpose, device, run), two numbers for
/// each block. A stream depends on its four words only, and not on the order or
/// the thread in which streams are drawn. It has 2^33 numbers; after those it
/// throws std::runtime_error.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint32_t device, std::uint32_t run,
               RandomPurpose purpose);

  /// Returns the 64 random bits from which the next number would be made.
  std::uint64_t next_word();

  /// Returns the next number: an odd multiple of 2^-53 in (0, 1), symmetric
  /// about 1/2.
  double uniform();

  /// Returns normal_quantile() of the next number: mean 0, variance 1, at most
  /// 8.21 in magnitude.
  double normal();

  /// Writes the numbers that as many calls of normal() would return, to the
  /// last bit, but faster.
  void fill_normal(std::span<double> values);

  /// Returns how many numbers have been drawn.
  std::uint64_t position() const;

  /// Goes to where `position` numbers have been drawn, forwards or backwards.
  /// Throws std::runtime_error beyond the end of the stream.
  void seek(std::uint64_t position);

  /// Takes the position; see StateArchive of sim/numerics.
  template <class Archive>
  void archive(Archive& archive) {
    std::uint64_t drawn = position();
    archive(drawn);
    if (archive.is_reading()) seek(drawn);
  }

 private:
  std::array<std::uint64_t, 2> next_block();

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 3> stream_;  // purpose, device, run
  std::uint64_t next_block_ = 0;
  std::uint64_t spare_word_ = 0;  // second word of the last block drawn
  bool has_spare_ = false;
};

}  // namespace beamgyro::internal
