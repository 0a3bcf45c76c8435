// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/hermite_resampler.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "spatial/dsp/resample/hermite.hpp"
#include "spatial/dsp/resample/hermite_inverse.hpp"
#include "spatial/reference/exact_hermite.hpp"
#include "tests/bench/workload.hpp"

namespace tacto::spatial {
namespace {

struct ResamplerPath {
  std::vector<double> t, x;
};

// A finger with different steps: from `slowest` to `fastest` counts of 1 um per sample.
ResamplerPath resampler_finger(int slowest, int fastest, std::size_t samples, double offset_m = 0) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> counts(slowest, fastest);
  ResamplerPath path;
  double count = 0;
  for (std::size_t i = 0; i < samples; ++i, count += counts(random)) {
    path.t.push_back(static_cast<double>(i));
    path.x.push_back(offset_m + count * 1e-6);
  }
  return path;
}

EvenPlaces places_on(const ResamplerPath& path, double pitch) {
  const double first = std::ceil(path.x.front() / pitch), last = std::floor(path.x.back() / pitch);
  return {first, pitch, static_cast<std::size_t>(last - first) + 1};
}

// The force is the time, so that the result is the time at which the finger was there.
std::vector<double> times_of(const ResamplerPath& path, const EvenPlaces& places) {
  std::vector<double> values(static_cast<std::size_t>(path.t.back()) + 1), out(places.count);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  HermiteResampler resampler;
  resampler(path.t, path.x, values, 0, places, out);
  return out;
}

// The largest error of position over every `stride`-th place, in m.
double resampled_error(const ResamplerPath& path, const EvenPlaces& places, std::size_t stride = 1) {
  const reference::ExactHermite exact(path.t, path.x);
  const auto times = times_of(path, places);
  double error = 0;
  for (std::size_t k = 0; k < places.count; k += stride)
    error = std::max(error, static_cast<double>(std::abs(exact.value(times[k]) - places.at(k))));
  return error;
}

double resampler_rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(HermiteResampler, MissesPositionsByLessThanAPicometre) {
  // Required: 1e-9 m. 2e-12 of a segment of 6 um is 1e-17 m; the time, a sample number of four digits, is
  // rounded to 1e-12 of a segment.
  const ResamplerPath gentle = resampler_finger(4, 6, 4000), jerky = resampler_finger(1, 9, 4000);
  EXPECT_LT(resampled_error(gentle, places_on(gentle, 1e-6)), 1e-17 * 2000);
  EXPECT_LT(resampled_error(jerky, places_on(jerky, 1e-6)), 1e-14);
}

// Whether segment i's ends are within a factor 3/2 of its secant.
bool easy(const ResamplerPath& path, std::size_t i) {
  const auto slopes = hermite_slopes(path.t, path.x);
  const double secant = (path.x[i + 1] - path.x[i]) / (path.t[i + 1] - path.t[i]);
  return std::abs(std::log(slopes[i] / secant)) < std::log(1.5) &&
         std::abs(std::log(slopes[i + 1] / secant)) < std::log(1.5);
}

TEST(HermiteResampler, SolvesEasySegmentsTo2eMinus12OfThemAndAllTo1eMinus10) {
  // Segments with all pairs of slopes within the factor, and around it.
  double worst_easy = 0, worst = 0;
  for (double before = 0.3; before < 3.4; before *= 1.06)
    for (double after = 0.3; after < 3.4; after *= 1.06) {
      const ResamplerPath path{{0, 1, 2, 3, 4, 5},
                               {0, 1, 1 + before, 2 + before, 2 + before + after, 3 + before + after}};
      const EvenPlaces places{std::ceil((1 + before) * 64), 1.0 / 64, 60};
      const reference::ExactHermite exact(path.t, path.x);
      const auto times = times_of(path, places);
      double error = 0;
      for (std::size_t k = 0; k < places.count; ++k)
        error = std::max(error, std::abs(static_cast<double>(exact.inverse(places.at(k))) - times[k]));
      worst = std::max(worst, error);
      if (easy(path, 2)) worst_easy = std::max(worst_easy, error);
    }
  RecordProperty("easy", fmt::format("{:.1e}", worst_easy));
  RecordProperty("all", fmt::format("{:.1e}", worst));
  EXPECT_GT(worst_easy, 0);
  EXPECT_LT(worst_easy, 2e-12);
  EXPECT_LT(worst, 1e-10);
}

TEST(HermiteResampler, MissesTheForceByLessThanAMillionthOfItsRms) {
  const auto work = bench::workload(1);
  const std::span<const double> force = std::span(work.force_n).first(bench::kStrokeFrames);
  ResamplerPath path;
  for (std::size_t i = 0; i < bench::kStrokeFrames; ++i) {
    path.t.push_back(static_cast<double>(i));
    path.x.push_back(work.position_m[i]);
  }
  const EvenPlaces places = places_on(path, 1e-6);
  std::vector<double> out(places.count), errors;
  HermiteResampler resampler;
  resampler(path.t, path.x, force, 0, places, out);
  const reference::ExactHermite exact_x(path.t, path.x), exact_f(path.t, force);
  for (std::size_t k = 0; k < places.count; k += 37)
    errors.push_back(static_cast<double>(exact_f.value(exact_x.inverse(places.at(k)))) - out[k]);
  const double error = resampler_rms(errors) / resampler_rms({force.begin(), force.end()});
  RecordProperty("error_re_rms", fmt::format("{:.1e}", error));
  EXPECT_LT(error, 1e-12);
}

TEST(HermiteResampler, IsBracketedWhereTheSpeedNearsZero) {
  // Speeds over 12 decades from sample to sample.
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> decades(-12, 0);
  ResamplerPath path{{0}, {0}};
  for (int i = 1; i < 3000; ++i) {
    path.t.push_back(i);
    path.x.push_back(path.x.back() + 1e-3 * std::pow(10, decades(random)));
  }
  const EvenPlaces places = places_on(path, 1e-6);
  const auto times = times_of(path, places);
  EXPECT_TRUE(std::ranges::is_sorted(times));
  // A time of four digits is exact to 5e-13; at speeds of up to 3e-3 m per sample that is about 1e-15 m.
  EXPECT_LT(resampled_error(path, places), 1e-12);
}

TEST(HermiteResampler, TakesSegmentsOfManySamplesAndTimesBetweenThem) {
  const ResamplerPath path{{0, 0.5, 7, 8, 40, 41.25, 60}, {0, 1e-6, 9e-6, 11e-6, 12e-6, 80e-6, 81e-6}};
  // 1e-10 of a segment of 68 um.
  EXPECT_LT(resampled_error(path, places_on(path, 1e-8)), 1e-14);
}

TEST(HermiteResampler, HoldsOnGridsFrom10NmTo1Mm) {
  const ResamplerPath path = resampler_finger(3, 7, 20000);
  EXPECT_LT(resampled_error(path, places_on(path, 1e-8), 501), 1e-14);
  EXPECT_LT(resampled_error(path, places_on(path, 1e-3)), 1e-14);
}

TEST(HermiteResampler, HoldsAKilometreAway) {
  const ResamplerPath path = resampler_finger(3, 7, 3000, 1000);
  // One unit in the last place of 1000 m is 1.1e-13 m.
  EXPECT_LT(resampled_error(path, places_on(path, 1e-6)), 5e-13);
}

TEST(HermiteResampler, GivesTheSameAsOneByOne) {
  for (const ResamplerPath& path : {resampler_finger(1, 9, 500), resampler_finger(5, 5, 500)}) {
    const EvenPlaces places = places_on(path, 1e-7);
    const HermiteInverse inverse(path.t, path.x);
    const auto times = times_of(path, places);
    for (std::size_t k = 0; k < places.count; ++k) ASSERT_NEAR(times[k], inverse(places.at(k)), 1e-10);
  }
}

TEST(HermiteResampler, StaysWithinItsKnots) {
  const ResamplerPath path = resampler_finger(4, 6, 100);
  const EvenPlaces wide{-5, 1e-6, static_cast<std::size_t>(path.x.back() * 1e6) + 20};
  const auto times = times_of(path, wide);
  EXPECT_EQ(times.front(), 0);
  EXPECT_EQ(times.back(), 99);
  EXPECT_EQ(times_of({{0, 1}, {0, 3e-6}}, {0, 1e-6, 4}).size(), 4U);
}

}  // namespace
}  // namespace tacto::spatial
