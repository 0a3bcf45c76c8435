// SPDX-License-Identifier: GPL-3.0-or-later
// compare_surfaces on synthetic strokes: noise with a level of its own for each stroke. The rates on emulated
// strokes are in surfaces_rates_test, the formulas against NumPy in compare_command_test.py.
#include "analysis/compare/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/analysis/compare_textures.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;

constexpr double kStrokePitchM = 40e-6;
constexpr double kStrokeSpreadDb = 1.5;

// Strokes there and back with a spread of their levels, over a surface of white noise.
SurfaceSide noise_side(const std::string& recording, unsigned seed, std::size_t strokes) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  SurfaceSide side{recording, {}, {}};
  for (std::size_t i = 0; i < strokes; ++i) {
    const double gain = std::pow(10, kStrokeSpreadDb * normal(random) / 20);
    schema::Texture stroke =
        scaled(white_texture(100 * seed + static_cast<unsigned>(i), 800, kStrokePitchM), gain);
    stroke.direction = i % 2 == 0 ? 1 : -1;
    stroke.valid_band = {{0, 300, 10000}};
    stroke.source.recording_sha256 = recording;
    stroke.source.from_s = static_cast<double>(i);
    stroke.source.to_s = static_cast<double>(i) + 0.9;
    stroke.source.mean_speed_mps = 0.05 * std::exp(0.03 * normal(random));
    stroke.source.normal_force_n = 0.5 * std::exp(0.03 * normal(random));
    side.stroke_names.push_back(recording + "-" + std::to_string(i + 1));
    side.strokes.push_back(std::move(stroke));
  }
  return side;
}

// Adds white noise between two frequencies, as a sum of cosines; twice the power of noise of RMS 1 in the
// band is 3 dB more.
void add_noise(SurfaceSide& side, double low_per_m, double high_per_m, double power_ratio) {
  const double rms = std::sqrt(power_ratio * (high_per_m - low_per_m) * 2 * kStrokePitchM);
  for (std::size_t i = 0; i < side.strokes.size(); ++i) {
    const RandomSurface more(static_cast<unsigned>(i), low_per_m, high_per_m, 40);
    auto& signal = side.strokes[i].signal;
    for (std::size_t k = 0; k < signal.values.size(); ++k)
      signal.values[k] += rms * more(signal.position_m(k));
  }
}

SurfaceComparison compared(const SurfaceSide& a, const SurfaceSide& b, double tolerance_db = 2) {
  const auto c = compare_surfaces(a, b, tolerance_db);
  EXPECT_TRUE(c.has_value()) << schema::message(c.error());
  return c.value_or(SurfaceComparison{});
}

ErrorKind refused(const SurfaceSide& a, const SurfaceSide& b) {
  const auto c = compare_surfaces(a, b, 2);
  EXPECT_FALSE(c.has_value());
  return c ? ErrorKind::internal : c.error().kind;
}

SurfaceVerdict verdict(const SurfaceSide& a, const SurfaceSide& b) {
  return compared(a, b).verdict;
}

// A sine of amplitude 3 has the power 4.5; what the four tapers spread beyond a band of 40 of their widths is
// below 0.1 %. White samples of variance 1 have the density 2 pitch; the power of a band of width W over a
// length L is a mean of W L squares of two values, whose relative standard deviation is 1 / sqrt(W L): 0.05
// dB from 2 to 4 /mm over 4 m. The limits are 4 of them.
TEST(StrokeLevels, AreThePowerOfTheBand) {
  const schema::Texture tone =
      made_texture(20e-6, 2000, [](double x) { return 3 * std::sin(2 * std::numbers::pi * 3000 * x); });
  const std::vector<double> edges = {2000, 4000, 8000};
  const auto levels = stroke_levels_db(tone.signal.values, 20e-6, edges);
  EXPECT_NEAR(levels[0], 10 * std::log10(4.5), 0.01);
  EXPECT_LT(levels[1], levels[0] - 30);
  const auto white = stroke_levels_db(white_texture(5, 200000, 20e-6).signal.values, 20e-6, edges);
  EXPECT_NEAR(white[0], 10 * std::log10(2 * 20e-6 * 2000), 0.2);
  EXPECT_NEAR(white[1], 10 * std::log10(2 * 20e-6 * 4000), 0.14);
  EXPECT_TRUE(stroke_levels_db(std::vector<double>(100, 7.0), 20e-6, edges).empty())
      << "no power without the mean";
}

TEST(StrokeLevels, BandsAreHalfThirdOctaves) {
  const auto edges = sixth_octave_edges(990, 2010);
  ASSERT_EQ(edges.size(), 7U);
  EXPECT_NEAR(edges.front(), 1000, 1e-9);
  EXPECT_NEAR(edges.back(), 1000 * std::pow(10, 0.3), 1e-9);
  EXPECT_TRUE(sixth_octave_edges(1010, 1200).empty()) << "no whole band";
}

// 40 pairs, at a rate of 5 %: 7 or more have a probability of 0.3 %.
TEST(CompareSurfaces, OneSurfaceIsRarelyDifferent) {
  int different = 0;
  for (unsigned pair = 0; pair < 40; ++pair)
    different += verdict(noise_side("a", 2 * pair + 1, 6), noise_side("b", 2 * pair + 2, 6)) ==
                 SurfaceVerdict::different;
  EXPECT_LT(different, 7);
}

TEST(CompareSurfaces, NamesTheBandThatDiffers) {
  for (unsigned pair = 0; pair < 5; ++pair) {
    SurfaceSide b = noise_side("b", 2 * pair + 2, 12);
    add_noise(b, 2000, 2600, 3);
    const SurfaceComparison c = compared(noise_side("a", 2 * pair + 1, 12), b);
    ASSERT_EQ(c.verdict, SurfaceVerdict::different);
    EXPECT_LE(c.test->p, 0.002);
    const BandWindow& window = c.test->windows[c.test->strongest];
    EXPECT_LT(c.low_per_m(window), 2400);
    EXPECT_GT(c.high_per_m(window), 2200);
    EXPECT_NEAR(window.level_db, 6, 2.5);
    EXPECT_FALSE(c.by_recording);
  }
}

// The common gain of a stroke has a spread of 1.5 dB, the shape has none: 1.5 dB in two bands are found by
// the shape, but an interval of one band can contain 0. Such a band is no evidence by itself.
TEST(CompareSurfaces, AShapeThatDiffersIsNotABandThatDiffers) {
  int by_shape = 0;
  for (unsigned pair = 0; pair < 5; ++pair) {
    SurfaceSide b = noise_side("b", 2 * pair + 2, 12);
    add_noise(b, 2000, 2600, 0.4);
    add_noise(b, 5000, 7000, 0.4);
    const SurfaceComparison c = compared(noise_side("a", 2 * pair + 1, 12), b, 0.5);
    ASSERT_TRUE(c.test);
    const BandWindow& window = c.test->windows[c.test->strongest];
    const bool contains_0 = std::abs(window.level_db) <= c.test->reach * window.error_db;
    const bool only_shape = c.verdict == SurfaceVerdict::different && contains_0;
    EXPECT_EQ(c.because.find("in shape") != std::string::npos, only_shape) << c.because;
    by_shape += only_shape;
  }
  EXPECT_GT(by_shape, 0);
}

TEST(CompareSurfaces, ADifferenceBelowTheToleranceIsNone) {
  SurfaceSide a = noise_side("a", 1, 12), b = noise_side("b", 2, 12);
  for (schema::Texture& stroke : b.strokes) stroke = scaled(stroke, std::pow(10, 4.0 / 20));
  EXPECT_EQ(compared(a, b, 2).verdict, SurfaceVerdict::different);
  const SurfaceComparison c = compared(a, b, 8);
  EXPECT_EQ(c.verdict, SurfaceVerdict::no_difference_found);
  EXPECT_LE(c.test->p, kTestLevel);
  EXPECT_GT(c.finest_level_db, 8);
}

TEST(CompareSurfaces, TooFewStrokesAreUndecided) {
  EXPECT_EQ(verdict(noise_side("a", 1, 4), noise_side("b", 2, 12)), SurfaceVerdict::undecided);
  EXPECT_NE(verdict(noise_side("a", 1, 5), noise_side("b", 2, 5)), SurfaceVerdict::undecided);
  SurfaceSide there = noise_side("a", 1, 8), back = noise_side("b", 2, 8);
  for (schema::Texture& stroke : there.strokes) stroke.direction = 1;
  for (schema::Texture& stroke : back.strokes) stroke.direction = -1;
  EXPECT_EQ(verdict(there, back), SurfaceVerdict::undecided) << "no direction in common";
}

// The level follows the load, 20 dB per decade. Loads of 0.3 and 0.5 N hide the surface; loads that overlap
// do not.
TEST(CompareSurfaces, LoadIsSeparatedFromTheSurface) {
  SurfaceSide a = noise_side("a", 1, 12), b = noise_side("b", 2, 12);
  for (schema::Texture& stroke : b.strokes) *stroke.source.normal_force_n *= 0.6;
  const SurfaceComparison hidden = compared(a, b);
  EXPECT_EQ(hidden.verdict, SurfaceVerdict::undecided);
  EXPECT_LT(hidden.separable, 0.25);
  const auto press = [](SurfaceSide& side, double from_n, double to_n) {
    for (std::size_t i = 0; i < side.strokes.size(); ++i) {
      const double load_n = from_n + (to_n - from_n) * static_cast<double>(i) / 11;
      side.strokes[i].source.normal_force_n = load_n;
      side.strokes[i] = scaled(side.strokes[i], std::pow(load_n, 2));
    }
  };
  press(a, 0.3, 0.6);
  press(b, 0.45, 0.8);
  const SurfaceComparison overlapping = compared(a, b);
  EXPECT_EQ(overlapping.verdict, SurfaceVerdict::no_difference_found);
  EXPECT_GT(overlapping.b.level_db[3] - overlapping.a.level_db[3], 4) << "the means differ";
}

// Four recordings a side with a level of each recording that is larger than the spread of its strokes.
TEST(CompareSurfaces, FourRecordingsASideAreTheUnit) {
  const auto side = [](unsigned seed, const std::string& name, std::size_t recordings) {
    SurfaceSide all{name, {}, {}};
    for (std::size_t i = 0; i < recordings; ++i) {
      const SurfaceSide one = noise_side(name + std::to_string(i), seed + static_cast<unsigned>(i), 6);
      const double gain = i % 2 == 0 ? 1 : 2;
      for (const schema::Texture& stroke : one.strokes) all.strokes.push_back(scaled(stroke, gain));
      all.stroke_names.insert(all.stroke_names.end(), one.stroke_names.begin(), one.stroke_names.end());
    }
    return all;
  };
  const SurfaceComparison four = compared(side(10, "a", 4), side(20, "b", 4));
  EXPECT_TRUE(four.by_recording);
  EXPECT_EQ(four.units_a, 4U);
  EXPECT_EQ(four.verdict, SurfaceVerdict::no_difference_found);
  EXPECT_FALSE(compared(side(10, "a", 3), side(20, "b", 4)).by_recording);
}

// Five pieces of one stroke, with gaps of 2 ms, have its level: they are no evidence of a spread.
TEST(CompareSurfaces, PiecesOfAStrokeBetweenGapsCountOnce) {
  const auto cut = [](SurfaceSide side) {
    for (std::size_t i = 0; i < side.strokes.size(); ++i) {
      schema::Texture& piece = side.strokes[i];
      piece.direction = 1;
      piece.source.from_s = 0.1 * static_cast<double>(i) + (i < 5 ? 0 : 5);
      piece.source.to_s = piece.source.from_s + 0.098;
    }
    return side;
  };
  const SurfaceComparison c = compared(cut(noise_side("a", 1, 10)), cut(noise_side("b", 2, 10)));
  EXPECT_EQ(c.units_a, 2U);
  EXPECT_EQ(c.a.strokes, 2U);
  EXPECT_EQ(c.verdict, SurfaceVerdict::undecided);
  EXPECT_EQ(c.notes.size(), 1U);
}

TEST(CompareSurfaces, SaysWhichSideIsSimulated) {
  const SurfaceSide a = noise_side("a", 1, 6);
  SurfaceSide b = noise_side("b", 2, 6);
  EXPECT_EQ(compared(a, b).simulated().words(), "");
  for (schema::Texture& stroke : b.strokes) stroke.simulated = "by a bench";
  const SurfaceComparison one = compared(a, b);
  EXPECT_TRUE(one.simulated().only_one());
  EXPECT_EQ(one.simulated().words(), "B by a bench; A was measured");
  EXPECT_EQ(one.notes.front(), one.simulated().warning());
  b.strokes[2].simulated = "";
  EXPECT_EQ(refused(a, b), ErrorKind::unsuitable) << "measured and simulated strokes on one side";
  EXPECT_EQ((SimulatedSides{"by one", "by two"}.words()), "A by one; B by two");
  EXPECT_EQ((SimulatedSides{"by one", "by one"}.words()), "by one");
}

TEST(CompareSurfaces, UnsuitableSidesAreRefused) {
  const SurfaceSide a = noise_side("a", 1, 6), b = noise_side("b", 2, 6);
  EXPECT_EQ(refused(a, a), ErrorKind::usage) << "the same strokes on both sides";
  SurfaceSide other = b;
  other.strokes[3].quantity = "height";
  EXPECT_EQ(refused(a, other), ErrorKind::unsuitable);
  other = b;
  other.strokes[3].average = schema::TextureAverage{};
  EXPECT_EQ(refused(a, other), ErrorKind::unsuitable);
  other = b;
  other.strokes[3] = scaled(other.strokes[3], 0);
  EXPECT_EQ(refused(a, other), ErrorKind::unsuitable);
  other = b;
  other.strokes[3].signal.values.resize(40);
  EXPECT_EQ(refused(a, other), ErrorKind::unsuitable);
  other = b;
  other.strokes[3].valid_band = {{0, 6000, 10000}};
  EXPECT_EQ(refused(a, other), ErrorKind::unsuitable) << "less than an octave in common";
  EXPECT_FALSE(compare_surfaces(a, b, 0).has_value());
}

}  // namespace
}  // namespace tacto::analysis
