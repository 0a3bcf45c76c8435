// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/uncertain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "capture/calibrate/hann_line.hpp"
#include "tests/capture/sim_take.hpp"

namespace tacto::capture {
namespace {

// Student's t, two-sided 95 %, from printed tables.
TEST(Uncertain, CoverageFactorsAreStudents) {
  const std::pair<double, double> kTable[] = {{1, 12.7062}, {2, 4.3027},  {3, 3.1824},
                                              {5, 2.5706},  {19, 2.0930}, {100, 1.9840}};
  for (const auto& [freedom, factor] : kTable)
    EXPECT_NEAR(coverage_factor_95(freedom), factor, 1e-4) << freedom;
  EXPECT_NEAR(coverage_factor_95(INFINITY), 1.95996, 1e-5);
}

// Noise held for ten samples, as a load cell's: an estimate with independent samples would be three times too
// small.
TEST(Uncertain, TheMeanOfHeldNoiseIsCovered) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 1000);
  Coverage coverage;
  for (int run = 0; run < 1000; ++run) {
    std::vector<double> samples;
    for (int i = 0; i < 200; ++i) samples.insert(samples.end(), 10, std::round(7e5 + normal(random)));
    coverage.add(mean_of(samples), 7e5);
  }
  EXPECT_GT(coverage.inside(), 0.93);  // 95 % +- 2 sigma of 1000 trials is +- 1.4 %
  EXPECT_LT(coverage.inside(), 0.97);
  EXPECT_NEAR(coverage.rms(), 1.06, 0.08);  // sqrt(19 / 17), Student's own
}

TEST(Uncertain, AConvertersStepIsFound) {
  EXPECT_EQ(step_of(std::vector<double>{65536, 131072, -65536}), 65536);
  EXPECT_EQ(step_of(std::vector<double>{3 * 65536.0, 3 * 65536.0}), 65536);
  EXPECT_EQ(step_of(std::vector<double>{0, 0}), 0);
  EXPECT_EQ(step_of(std::vector<double>{0.5, 1}), 1);
  const std::vector<double> constant(100, 65536.0);
  EXPECT_NEAR(mean_of(constant).uncertainty, 65536 / std::sqrt(12), 1);
}

TEST(Uncertain, DriftShowsAgainstNoise) {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> white, drifting;
  for (int i = 0; i < 10000; ++i) {
    white.push_back(normal(random));
    drifting.push_back(white.back() + i * 5e-4);
  }
  EXPECT_LT(drift_ratio(white), 0.1);
  EXPECT_GT(drift_ratio(drifting), 1);
  EXPECT_EQ(drift_ratio(std::vector<double>(100, 3.0)), 0);
}

TEST(HannLine, IsTheSumThatItSaysItIs) {
  std::vector<double> samples;
  for (int i = 0; i < 1000; ++i) samples.push_back(5 + 2 * std::cos(2 * std::numbers::pi * 0.05 * i + 0.3));
  const auto line = hann_line(samples, 0.05);
  EXPECT_NEAR(amplitude_of(line, samples.size()), 2, 1e-9);
  EXPECT_NEAR(std::arg(line), 0.3, 1e-9);
  double mean = 0;
  for (const double sample : samples) mean += sample / 1000;
  std::complex<long double> slow = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    const long double turn = 2 * std::numbers::pi_v<long double> * static_cast<long double>(i);
    slow += (samples[i] - static_cast<long double>(mean)) * (1 - std::cos(turn / 1000)) / 2.0L *
            std::polar(1.0L, -turn * 0.0123L);
  }
  EXPECT_NEAR(std::abs(hann_line(samples, 0.0123) - std::complex<double>(slow)), 0, 1e-9);
}

TEST(HannLine, WhiteNoiseHasItsDensity) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 3);
  double sum = 0;
  for (int run = 0; run < 400; ++run) {
    std::vector<double> samples;
    for (int i = 0; i < 500; ++i) samples.push_back(normal(random));
    sum += density_of(hann_line(samples, 0.11), samples.size(), 1000);
  }
  EXPECT_NEAR(sum / 400, 2 * 9.0 / 1000, 0.15 * 2 * 9.0 / 1000);  // 5 % is one sigma of 400
}

}  // namespace
}  // namespace tacto::capture
