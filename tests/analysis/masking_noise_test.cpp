// SPDX-License-Identifier: GPL-3.0-or-later
// The masking noise against its definition: level, band, even spectrum; and the check of a measured level.
#include "analysis/experiment/masking_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "analysis/experiment/trial_order.hpp"

namespace tacto::analysis {
namespace {

// One line of the spectrum of a period by its definition, over the number of samples.
std::complex<double> line_of(const std::vector<double>& samples, std::size_t number) {
  const auto count = static_cast<double>(samples.size());
  std::complex<double> sum = 0;
  for (std::size_t n = 0; n < samples.size(); ++n)
    sum += samples[n] *
           std::polar(1.0, -2 * std::numbers::pi * std::fmod(static_cast<double>(number * n), count) / count);
  return sum / count;
}

TEST(MaskingNoise, HasItsLevelItsBandAndPhasesThatAnyoneCanCompute) {
  const schema::MaskingNoise noise = usual_masking_noise(65);
  EXPECT_EQ(noise.low_hz, 15);
  EXPECT_EQ(noise.high_hz, 1500);
  const std::vector<double> samples = masking_noise(noise, "7");
  ASSERT_EQ(samples.size(), 1440000U);
  double square = 0, peak = 0;
  for (const double sample : samples) {
    square += sample * sample / static_cast<double>(samples.size());
    peak = std::max(peak, std::abs(sample));
  }
  EXPECT_NEAR(std::sqrt(square), 0.1, 1e-9);
  EXPECT_LT(peak, 1);
  // 44551 lines of 1/30 Hz, from 450 to 45000, share the power.
  const double expected = 0.1 / std::sqrt(2 * 44551.0);
  for (const std::size_t number : {450UL, 20000UL, 45000UL}) {
    const std::complex<double> line = line_of(samples, number);
    EXPECT_NEAR(std::abs(line) / expected, 1, 1e-6) << number;
    const double phase = 2 * std::numbers::pi * uniform_by_sum("7/noise/" + std::to_string(number));
    EXPECT_NEAR(std::abs(line / expected - std::polar(1.0, phase)), 0, 1e-6) << number;
  }
  for (const std::size_t number : {0UL, 449UL, 45001UL})
    EXPECT_LT(std::abs(line_of(samples, number)) / expected, 1e-6) << number;
  EXPECT_NE(masking_noise(noise, "8")[100], samples[100]);
}

TEST(MaskingNoise, ALevelIsCheckedAndWhatIsNotMeasuredIsSaid) {
  schema::Protocol protocol = stretch_protocol("1");
  EXPECT_EQ(checked_masking_level(protocol, {}).value(), "");
  EXPECT_EQ(checked_masking_level(protocol, 65).error().kind, schema::ErrorKind::usage);
  protocol.masking_noise = usual_masking_noise(65);
  EXPECT_EQ(checked_masking_level(protocol, {}).value(), "not measured");
  for (const auto& [level_db, is_right] : {std::pair{62.0, true}, {68.0, true}, {61.9, false}, {68.1, false}})
    EXPECT_EQ(checked_masking_level(protocol, level_db).has_value(), is_right) << level_db;
}

}  // namespace
}  // namespace tacto::analysis
