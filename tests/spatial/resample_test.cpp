// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/resample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/bench/workload.hpp"
#include "tests/spatial/golden_file.hpp"

namespace tacto::spatial {
namespace {

TEST(Resample, EqualsSciPy) {
  GoldenFile file("resample.txt");
  for (const int direction : {1, -1}) {
    auto position_m = file.numbers();
    for (double& position : position_m) position *= 1e-6;
    const auto force = file.numbers();
    ASSERT_EQ(force.size(), 120U);
    const MonotonePath path = monotone_path(position_m, direction, {1e-6, 0});
    const auto grid = grid_along(path, direction, 1e-6);
    ASSERT_TRUE(grid);
    const auto expected = file.numbers();
    const auto values = resample(path, direction, *grid, force, 0);
    ASSERT_EQ(values.size(), expected.size());
    // Forces of up to 20 with steps of 1; times exact to 1e-10 of a sample. At the very ends, where the
    // finger's speed may be 0, a rounding of the position changes the time by 1e-8 of a sample and more.
    for (std::size_t i = 0; i < values.size(); ++i)
      ASSERT_NEAR(values[i], expected[i], i == 0 || i + 1 == values.size() ? 1e-6 : 1e-9)
          << direction << " " << i;
  }
}

// A surface line of `wavelength_m` under the finger of the benchmarks, with exact positions.
struct ResampleSurface {
  double wavelength_m;
  double force_n(double position_m) const {
    return std::sin(2 * std::numbers::pi * position_m / wavelength_m);
  }
};

// RMS error of a method, re the surface's RMS, 1 mm from the ends.
double resample_error(ResampleMethod method, const ResampleSurface& surface, int direction) {
  MonotonePath path;
  std::vector<double> force;
  for (std::size_t i = 0; i < bench::kStrokeFrames; ++i) {
    path.sample.push_back(static_cast<double>(i));
    path.way_m.push_back(bench::way_m(static_cast<double>(i) / bench::kRate_hz));
    force.push_back(surface.force_n(direction * path.way_m.back()));
  }
  const auto grid = grid_along(path, direction, 1e-6);
  const auto values = resample(path, direction, *grid, force, 0, method);
  double sum = 0;
  for (std::size_t k = 1000; k + 1000 < values.size(); ++k)
    sum += std::pow(values[k] - surface.force_n(grid->position_m(k)), 2);
  return std::sqrt(2 * sum / static_cast<double>(values.size() - 2000));
}

TEST(Resample, MissesAKnownSurfaceByWhatTheHeaderSays) {
  struct Stated {
    ResampleMethod method;
    double coarse, fine;
  };
  for (const auto& [method, coarse, fine] :
       {Stated{ResampleMethod::hermite, 1.1e-4, 3.3e-3}, {ResampleMethod::sinc, 4e-7, 4e-7}})
    for (const int direction : {1, -1}) {
      EXPECT_LT(resample_error(method, {0.4e-3}, direction), coarse) << name_of(method);
      EXPECT_LT(resample_error(method, {0.1e-3}, direction), fine) << name_of(method);
    }
}

TEST(Resample, KeepsItsScratchWithoutKeepingAnythingElse) {
  const auto work = bench::workload(2);
  for (const auto method : {ResampleMethod::hermite, ResampleMethod::sinc}) {
    Resampler resampler(method);
    for (const std::size_t size : {8000U, 50U, 3000U}) {
      const MonotonePath path = monotone_path(std::span(work.position_m).first(size), 1, {1e-6, 0});
      const auto grid = grid_along(path, 1, 1e-6);
      const auto force = std::span(work.force_n).first(size);
      std::vector<double> reused(grid->count);
      resampler(path, 1, *grid, force, 0, reused);
      EXPECT_EQ(reused, resample(path, 1, *grid, force, 0, method));
    }
  }
}

}  // namespace
}  // namespace tacto::spatial
