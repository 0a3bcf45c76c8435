// SPDX-License-Identifier: GPL-3.0-or-later
// Spatial frequencies in the force of the simulated finger on surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "tests/firmware-host/sim_stream.hpp"
#include "tests/measured.hpp"

namespace tacto::firmware_host {
namespace {

constexpr double kLongEnoughS = 1.3;  // for 34 mm at 40 mm/s with rest, ramp and speed variation

// Volts at the sensor against position, over the first stroke without its ramps, with a Hann window.
class Stroke {
 public:
  explicit Stroke(const std::string& uri) {
    const auto stream = tests::stream_of(uri, kLongEnoughS);
    const auto volts = stream.channel(tests::kSensor), position_m = stream.channel(tests::kPosition);
    const double from_m = 6e-3, to_m = 34e-3;
    for (std::size_t i = 1; i < volts.size() && position_m[i] < to_m; ++i)
      if (position_m[i] > from_m)
        add(volts[i], (position_m[i] - from_m) / (to_m - from_m), position_m[i], position_m[i - 1]);
  }

  /// |integral of v(x) w(x) e^(-2 pi i nu x) dx|^2.
  double power(double cycles_per_mm) const {
    std::complex<double> sum;
    for (std::size_t i = 0; i < place_mm_.size(); ++i)
      sum += weighted_[i] * std::polar(1.0, -2 * std::numbers::pi * cycles_per_mm * place_mm_[i]);
    return std::norm(sum);
  }
  double band_db(double from_per_mm, double to_per_mm) const {
    double sum = 0;
    for (double nu = from_per_mm; nu <= to_per_mm; nu += kStepPerMm) sum += power(nu);
    return 10 * std::log10(sum);
  }
  double peak_per_mm(double from_per_mm, double to_per_mm) const {
    double best = from_per_mm;
    for (double nu = from_per_mm; nu <= to_per_mm; nu += kStepPerMm / 2)
      if (power(nu) > power(best)) best = nu;
    return best;
  }

 private:
  static constexpr double kStepPerMm = 0.02;  // half of the resolution of 28 mm

  void add(double volts, double part, double here_m, double before_m) {
    place_mm_.push_back(here_m * 1e3);
    weighted_.push_back(volts * (here_m - before_m) * 1e3 * (1 - std::cos(2 * std::numbers::pi * part)));
  }
  std::vector<double> place_mm_, weighted_;
};

std::string with_seed(const std::string& surface, int seed) {
  const double speed_mm = 40 + (seed * 7) % 21;  // 40 to 60 mm/s
  return "sim:load=0.6N,strokes=1,surface=" + surface + ",seed=" + std::to_string(seed) +
         ",speed=" + std::to_string(speed_mm) + "mm/s";
}

TEST(SimTexture, ATriangularGratingIsHeardAtItsPeriodAndTwice) {
  const Stroke triangle("sim:surface=triangle,seed=1"), flat("sim:surface=flat,seed=1");
  EXPECT_GT(triangle.band_db(0.9, 1.1), flat.band_db(0.9, 1.1) + 20);
  EXPECT_GT(triangle.band_db(1.9, 2.1), flat.band_db(1.9, 2.1) + 20);
}

// Figure 1 of the paper: the contact is nonlinear. A triangular wave has odd harmonics only.
TEST(SimTexture, FigureOneForTwentySeeds) {
  int second_above = 0, below_the_line = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const Stroke triangle(with_seed("triangle", seed)), flat(with_seed("flat", seed));
    second_above += triangle.band_db(1.8, 2.2) >= triangle.band_db(0.8, 1.2) + 3;
    below_the_line += triangle.band_db(0.3, 0.8) >= flat.band_db(0.3, 0.8) + 6;
  }
  std::printf("second harmonic 3 dB above the fundamental: %d of 20; 0.3-0.8 /mm 6 dB above flat: %d of 20\n",
              second_above, below_the_line);
  tacto::measured("sim_texture.second_harmonic_seeds", second_above);
  tacto::measured("sim_texture.below_the_line_seeds", below_the_line);
  EXPECT_GE(second_above, 16);
  EXPECT_GE(below_the_line, 16);
}

// The paper's Figure 1 has "sub-harmonics" of the grating. At 50 mm/s this finger's pulp has a period of two
// grating periods: a line at half the fundamental, at the resolution of Stroke.
constexpr const char* kHalfOrder = "load=0.6N,strokes=1,person=3,wander=0,seed=1";

TEST(SimTexture, ANamedSetShowsTheHalfOrderLine) {
  const Stroke triangle(std::string("sim:surface=triangle,") + kHalfOrder);
  const Stroke flat(std::string("sim:surface=flat,") + kHalfOrder);
  EXPECT_NEAR(triangle.peak_per_mm(0.35, 0.65), 0.5, 0.02);
  const double line_db = triangle.band_db(0.46, 0.54);
  EXPECT_GT(line_db, triangle.band_db(0.36, 0.42) + 15);
  EXPECT_GT(line_db, triangle.band_db(0.58, 0.64) + 15);
  EXPECT_GT(line_db, flat.band_db(0.46, 0.54) + 20);
}

struct Line {
  const char* surface;
  double per_mm;
};

class SurfaceLine : public testing::TestWithParam<Line> {};

// A line of the surface keeps its frequency in 1/mm while its frequency in Hz doubles.
TEST_P(SurfaceLine, StaysInSpaceAtAnySpeed) {
  const auto [surface, per_mm] = GetParam();
  for (const char* speed : {"40mm/s", "80mm/s"}) {
    const Stroke stroke(std::string("sim:seed=1,surface=") + surface + ",speed=" + speed);
    EXPECT_NEAR(stroke.peak_per_mm(per_mm - 0.1, per_mm + 0.1), per_mm, 0.02) << speed;
    EXPECT_GT(stroke.band_db(per_mm - 0.06, per_mm + 0.06), stroke.band_db(per_mm + 0.12, per_mm + 0.24) + 3)
        << speed;
  }
}

INSTANTIATE_TEST_SUITE_P(Gratings, SurfaceLine,
                         testing::Values(Line{"triangle", 1}, Line{"B", 8.0 / 3}, Line{"C", 1.0 / 3},
                                         Line{"C", 8.0 / 3}, Line{"E", 2}));

TEST(SimTexture, TheFiveSamplesAreFarAboveFlatAndWithinTheRange) {
  const Stroke flat("sim:surface=flat,seed=2");
  for (const char* surface : {"A", "B", "C", "D", "E"}) {
    const std::string uri = std::string("sim:seed=2,surface=") + surface;
    EXPECT_GT(Stroke(uri).band_db(0.3, 8), flat.band_db(0.3, 8) + 10) << surface;
    EXPECT_EQ(tests::stream_of(uri, 2).counts.clipped, 0U) << surface;
  }
}

}  // namespace
}  // namespace tacto::firmware_host
