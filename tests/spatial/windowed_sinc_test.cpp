// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/windowed_sinc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::spatial {
namespace {

// The largest error for a tone of amplitude 1, far from the ends.
double error_at(double cycles_per_sample) {
  const double turn = 2 * std::numbers::pi * cycles_per_sample;
  std::vector<double> tone(400);
  for (std::size_t i = 0; i < tone.size(); ++i) tone[i] = std::sin(turn * static_cast<double>(i));
  const WindowedSinc sinc;
  double error = 0;
  for (double place = 100; place < 300; place += 0.0137)
    error = std::max(error, std::abs(sinc(tone, place) - std::sin(turn * place)));
  return error;
}

TEST(WindowedSinc, MissesAToneByWhatItsHeaderSays) {
  for (const double cycles : {0.01, 0.05, 0.1, 0.2, 0.3}) EXPECT_LT(error_at(cycles), 2e-6) << cycles;
  EXPECT_LT(error_at(0.4), 2e-3);
}

TEST(WindowedSinc, KeepsConstantsAndSamples) {
  const std::vector<double> values = {3, 1, 4, 1, 5, 9, 2, 6};
  const WindowedSinc sinc;
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(sinc(values, static_cast<double>(i)), values[i], 1e-14);
  const std::vector<double> level(7, 12.5);
  for (double place = -1; place < 8; place += 0.11) EXPECT_NEAR(sinc(level, place), 12.5, 1e-13);
}

}  // namespace
}  // namespace tacto::spatial
