// SPDX-License-Identifier: GPL-3.0-or-later
// How often the verdict is right, over many draws; and each of its rules.
#include <gtest/gtest.h>

#include "analysis/compare/compare.hpp"
#include "spatial/texture/make_texture.hpp"
#include "tests/analysis/compare_textures.hpp"
#include "tests/measured.hpp"

namespace tacto::analysis {
namespace {

Verdict judged(const schema::Texture& a, const schema::Texture& b, PairAlign align = PairAlign::position) {
  CompareOptions options;
  options.formants = false;
  options.pair.align = align;
  const auto found = compare(a, b, options);
  EXPECT_TRUE(found) << schema::message(found.error());
  return found->verdict;
}

// A one-pole low-pass changes the shape of the spectrum.
schema::Texture smoothed(schema::Texture texture, double part) {
  double state = 0;
  for (double& value : texture.signal.values) value = state += part * (value - state);
  return texture;
}

constexpr std::size_t kLength = 6000;

TEST(CompareVerdict, TwoPiecesOfOneKindAreSeldomCalledDifferent) {
  constexpr int kPairs = 200;
  int same = 0, wrong = 0;
  for (unsigned i = 0; i < kPairs; ++i) {
    const auto likeness = judged(white_texture(1000 + 2 * i, kLength), white_texture(1001 + 2 * i, kLength),
                                 i % 2 == 0 ? PairAlign::position : PairAlign::none)
                              .likeness;
    same += likeness == Likeness::none;
    wrong += likeness != Likeness::none && likeness != Likeness::undecided;
  }
  tacto::measured("compare_verdict.one_kind_wrong", wrong);
  tacto::measured("compare_verdict.one_kind_same", same);
  // 5 % of such pairs are called different by bands and lines, that is 10 of 200 with a standard deviation of
  // 3.1; hardly any by third octaves and by level (compare_narrow_test has the rates).
  EXPECT_LE(wrong, 19);
  EXPECT_GE(same, kPairs * 8 / 10);
}

TEST(CompareVerdict, OtherShapesAndLevelsAreFound) {
  constexpr int kPairs = 40;
  int different = 0, louder = 0;
  for (unsigned i = 0; i < kPairs; ++i) {
    const auto a = white_texture(3000 + 2 * i, kLength), b = white_texture(3001 + 2 * i, kLength);
    different += judged(a, smoothed(b, 0.3)).likeness == Likeness::different;
    louder += judged(a, scaled(b, 2)).likeness == Likeness::louder;
  }
  tacto::measured("compare_verdict.other_shapes_found_percent", 100.0 * different / kPairs);
  tacto::measured("compare_verdict.other_levels_found_percent", 100.0 * louder / kPairs);
  EXPECT_GE(different, kPairs * 95 / 100);
  EXPECT_GE(louder, kPairs * 95 / 100);
}

std::string notes_of(const schema::Texture& a, const schema::Texture& b) {
  CompareOptions options;
  options.formants = false;
  const auto found = compare(a, b, options);
  std::string all;
  for (const std::string& note : found->notes) all += note + "\n";
  return all;
}

TEST(CompareVerdict, AThousandTimesIsAskedAboutAsAUnit) {
  const auto a = white_texture(7, kLength);
  EXPECT_NE(notes_of(a, scaled(a, 1000)).find("a thousand times A"), std::string::npos);
  EXPECT_NE(notes_of(a, scaled(a, 1e-3)).find("a thousandth times A"), std::string::npos);
  EXPECT_EQ(notes_of(a, scaled(a, 500)).find("unit"), std::string::npos);  // 54 dB
  EXPECT_EQ(notes_of(a, scaled(smoothed(a, 0.1), 1000)).find("unit"), std::string::npos);
}

// The interval of the level contains the true level in 90 of 100 pairs.
TEST(CompareVerdict, IntervalCovers) {
  constexpr int kPairs = 300;
  int covered = 0;
  for (unsigned i = 0; i < kPairs; ++i) {
    CompareOptions options;
    options.formants = false;
    const auto found = compare(white_texture(5000 + 2 * i, 3000), white_texture(5001 + 2 * i, 3000), options);
    covered += found->evidence.level_low_db <= 0 && 0 <= found->evidence.level_high_db;
  }
  tacto::measured("compare_verdict.level_covered_percent", 100.0 * covered / kPairs);
  // Binomial: 0.9 +- 0.017; the rest of the tolerance is for the bands' logarithms and for only 15 segments.
  EXPECT_NEAR(covered / static_cast<double>(kPairs), 0.9, 0.05);
}

TEST(CompareVerdict, SaysWhenItCannotTell) {
  CompareOptions options;
  options.formants = false;
  options.window_m = 3000 * 50e-6;
  const auto a = white_texture(1, kLength), b = white_texture(2, kLength);
  const auto few = compare(a, b, options);
  EXPECT_EQ(few->verdict.likeness, Likeness::undecided);
  auto narrow = a;
  narrow.valid_band = {{0, 1000, 1400}};
  EXPECT_EQ(judged(narrow, b).likeness, Likeness::undecided);
  // If the parts of a texture differ strongly from each other, small differences are not detectable.
  auto uneven = b;
  for (std::size_t i = 0; i < kLength; ++i)
    uneven.signal.values[i] *= std::pow(10, 1.2 * std::sin(static_cast<double>(i) / 450));
  const Verdict verdict = judged(a, scaled(uneven, 1 / spatial::rms_of(uneven)));
  EXPECT_EQ(verdict.likeness, Likeness::undecided) << verdict.because;
}

TEST(CompareVerdict, RuleByNumbers) {
  Evidence e;
  e.bands = 10;
  e.segments = 15;
  e.shape_db = 1, e.shape_chance_db = 1.5, e.finest_shape_db = 1;
  e.level_db = 1, e.level_low_db = 0.5, e.level_high_db = 1.5;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::none);
  e.level_high_db = 2.5;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::undecided);
  e.level_db = 3, e.level_low_db = 0.5, e.level_high_db = 5.5;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::louder);
  e.level_low_db = -0.5;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::undecided);
  e.level_db = -3, e.level_low_db = -4, e.level_high_db = -2;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::quieter);
  e.finest_shape_db = 2.5;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::undecided);
  e.shape_db = 4, e.shape_excess_db = 3.5;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::different);
  e.shape_excess_db = 1;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::undecided) << "certain, but too small to count";
  e.finest_shape_db = 1, e.level_db = 0, e.level_low_db = -0.5, e.level_high_db = 0.5;
  e.narrow = NarrowBand{2000, 2600, -5, 4, 3.5, {{200, 6}}};
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::different);
  EXPECT_NE(verdict_of(e, 2).because.find("5.0 dB"), std::string::npos);
  EXPECT_EQ(verdict_of(e, 6).likeness, Likeness::none) << "within the tolerance";
  e.narrow->score = 3;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::none) << "by chance";
  e.line = SpectralLine{3000, true, 8, 20, 12, 4};
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::different);
  EXPECT_NE(verdict_of(e, 2).because.find("3/mm"), std::string::npos);
  e.line->score = 11;
  EXPECT_EQ(verdict_of(e, 2).likeness, Likeness::none);
  EXPECT_EQ(detectable_words(e, 2).find("6.0 dB over 0.2/mm"), 0U) << detectable_words(e, 2);
}

}  // namespace
}  // namespace tacto::analysis
