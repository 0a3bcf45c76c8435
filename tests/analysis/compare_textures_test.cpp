// SPDX-License-Identifier: GPL-3.0-or-later
// Comparisons with a closed form: gain, shift, noise of known power, grids; and refusals.
#include "tests/analysis/compare_textures.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "analysis/compare/band_sums.hpp"
#include "analysis/compare/compare.hpp"
#include "analysis/compare/compare_page.hpp"

namespace tacto::analysis {
namespace {

using schema::ErrorKind;

CompareOptions no_formants() {
  CompareOptions options;
  options.formants = false;
  return options;
}

const BandComparison& band_at(const Comparison& comparison, double frequency_per_m) {
  for (const BandComparison& band : comparison.bands)
    if (band.low_per_m <= frequency_per_m && frequency_per_m < band.high_per_m) return band;
  throw std::out_of_range("no such band");
}

// B = g A: all figures are known, to rounding.
TEST(Compare, AGainIsALevelAndNothingElse) {
  const auto sine = [](double x) { return 0.02 * std::sin(2 * std::numbers::pi * 2000 * x); };
  const auto a = made_texture(10e-6, 8000, sine);
  for (const double gain : {0.25, 0.9, 1.7, 12.0}) {
    const auto found = compare(a, scaled(a, gain), no_formants());
    ASSERT_TRUE(found) << message(found.error());
    const double db = 20 * std::log10(gain);
    EXPECT_NEAR(band_at(*found, 2000).level_db, db, 1e-9);
    EXPECT_NEAR(found->power_level_db, db, 1e-9);
    EXPECT_NEAR(*found->gain, gain, 1e-9 * gain);
    EXPECT_NEAR(*found->error_db, 20 * std::log10(std::abs(gain - 1)), 1e-6);
    EXPECT_LT(*found->residual_db, -120);
    EXPECT_NEAR(*found->coherence, 1, 1e-9);
    EXPECT_NEAR(band_at(*found, 2000).a_rms, 0.02 / std::numbers::sqrt2, 1e-4 * 0.02);
  }
}

TEST(Compare, GainsGiveTheVerdict) {
  const auto a = white_texture(1, 8000);
  const auto verdict = [&](double gain) {
    return compare(a, scaled(a, gain), no_formants())->verdict.likeness;
  };
  EXPECT_EQ(verdict(1), Likeness::none);
  EXPECT_EQ(verdict(1.1), Likeness::none) << "0.8 dB is within the tolerance";
  EXPECT_EQ(verdict(2), Likeness::louder);
  EXPECT_EQ(verdict(0.5), Likeness::quieter);
  EXPECT_EQ(verdict(-2), Likeness::louder);
  EXPECT_LT(*compare(a, scaled(a, -2), no_formants())->gain, -1.99) << "upside down";
}

// A shift of half a millimetre in windows of 50 mm: coherent, and the gain may be negative.
TEST(Compare, AShiftIsNotUpsideDown) {
  const RandomSurface surface(3, 300, 1100);
  const auto moved = [&](double by_m) {
    return made_texture(50e-6, 8000, [&](double x) { return surface(x + by_m); });
  };
  const auto said = [&](const schema::Texture& b) {
    const auto found = compare(moved(0), b, no_formants());
    std::string notes;
    for (const std::string& note : found->notes) notes += note + "\n";
    return notes;
  };
  for (const double by_m : {0.2e-3, 0.5e-3, 1e-3, 1.5e-3}) {
    EXPECT_EQ(said(moved(by_m)).find("inverted sign"), std::string::npos) << by_m;
    // The shortest wave is 0.9 mm long; after a shift of 0.2 mm the textures still overlap mostly.
    EXPECT_EQ(said(moved(by_m)).find("--align correlation") == std::string::npos, by_m < 0.3e-3) << by_m;
  }
  EXPECT_NE(said(scaled(moved(0), -1.3)).find("inverted sign"), std::string::npos);
  EXPECT_EQ(said(moved(0)), "");
}

// Two surfaces with a part in common, as gratings with the same lines have, are not one that is shifted.
TEST(Compare, ASmallCommonPartIsNoShift) {
  const RandomSurface common(3, 300, 1100), first(4, 300, 1100), second(5, 300, 1100);
  for (const double own : {0.3, 1.1}) {  // coherence 0.84, 0.20
    const auto a = made_texture(50e-6, 8000, [&](double x) { return common(x) + own * first(x); });
    const auto b = made_texture(50e-6, 8000, [&](double x) { return common(x + 1e-3) + own * second(x); });
    const auto found = compare(a, b, no_formants());
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->point_by_point) << *found->coherence;
    EXPECT_EQ(found->notes.empty(), own > 1) << *found->coherence;
  }
}

// Independent noise n of power r times A's: error r, coherence 1 / (1 + r), residual r / (1 + r).
TEST(Compare, NoiseOfKnownPowerIsErrorAndLostCoherence) {
  const auto a = white_texture(1, 200000), n = white_texture(2, 200000);
  for (const double ratio : {0.01, 0.3, 1.0}) {
    auto b = a;
    for (std::size_t i = 0; i < b.signal.values.size(); ++i)
      b.signal.values[i] += std::sqrt(ratio) * n.signal.values[i];
    CompareOptions options = no_formants();
    options.window_m = 2000 * a.signal.pitch_m;  // 199 segments
    const auto found = compare(a, b, options);
    // 1e5 independent cells: powers to 0.5 %, 4 standard deviations.
    EXPECT_NEAR(*found->error_db, 10 * std::log10(ratio), 0.06) << ratio;
    EXPECT_NEAR(*found->residual_db, 10 * std::log10(ratio / (1 + ratio)), 0.08) << ratio;
    // Coherence of n segments has a bias of (1 - c)^2 / n; the mean over 1000 bins scatters much less.
    EXPECT_NEAR(*found->coherence, 1 / (1 + ratio), 0.01) << ratio;
    EXPECT_TRUE(found->point_by_point);
  }
}

TEST(Compare, StrangersAreCoherentByChanceOnly) {
  int above = 0, cells = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto found =
        compare(white_texture(2 * seed + 100, 8000), white_texture(2 * seed + 101, 8000), no_formants());
    EXPECT_FALSE(found->point_by_point);
    EXPECT_GT(found->spectra.coherence.size(), 490U);
    for (const double c : found->spectra.coherence) above += c > found->chance_coherence, ++cells;
  }
  // Carter, Knapp and Nuttall: 5 % of the bins; neighbours depend on each other, hence the width.
  EXPECT_NEAR(static_cast<double>(above) / cells, 0.05, 0.015);
}

TEST(Compare, CorrelationFindsAShift) {
  const RandomSurface surface(5, 300, 6000);
  const auto a = made_texture(10e-6, 6000, surface);
  for (const double shift_m : {0.3e-3, -0.7123e-3}) {
    const auto b = made_texture(10e-6, 6000, [&](double x) { return surface(x + shift_m); });
    CompareOptions options = no_formants();
    options.pair.align = PairAlign::correlation;
    const auto found = compare(a, b, options);
    ASSERT_TRUE(found) << message(found.error());
    EXPECT_EQ(found->pair.aligned, "correlation");
    EXPECT_NEAR(found->pair.shift_m, shift_m, 0.05 * 10e-6) << "a twentieth of the pitch";
    EXPECT_LT(*found->error_db, -40);
    const auto unaligned = compare(a, b, no_formants());
    EXPECT_GT(*unaligned->error_db, 0) << "without it nothing fits";
    EXPECT_EQ(unaligned->verdict.likeness, Likeness::none) << "the spectra are the same all the same";
    EXPECT_TRUE(unaligned->point_by_point) << "coherence does not mind a shift far below the window";
  }
}

TEST(Compare, PlacesComeFromTheBench) {
  const RandomSurface surface(6, 300, 6000);
  auto a = made_texture(10e-6, 6000, surface);
  auto b = made_texture(10e-6, 6000, [&](double x) { return surface(x + 7e-3); });
  a.source_origin_m = 0.1;
  b.source_origin_m = 0.107;
  const auto found = compare(a, b, no_formants());
  EXPECT_EQ(found->pair.aligned, "place");
  EXPECT_NEAR(found->pair.a_from_m, 7e-3, 1e-9);
  EXPECT_LT(*found->error_db, -200);
  b.source_origin_m = 0.15;  // hardly any common places
  const auto from_start = compare(a, b, no_formants());
  EXPECT_EQ(from_start->pair.aligned, "start");
  EXPECT_FALSE(from_start->notes.empty());
}

TEST(Compare, GridsOfDifferentPitchMeetOnTheCoarserOne) {
  const RandomSurface surface(7, 300, 5000);
  const auto coarse = made_texture(25e-6, 2400, surface);
  for (const double finer_m : {25e-6 / 3, 10e-6, 20e-6}) {
    const auto fine = made_texture(finer_m, static_cast<std::size_t>(0.06 / finer_m), surface);
    const auto found = compare(coarse, fine, no_formants());
    ASSERT_TRUE(found) << message(found.error());
    EXPECT_DOUBLE_EQ(found->pair.pitch_m, 25e-6);
    ASSERT_FALSE(found->notes.empty());
    EXPECT_NE(found->notes.front().find("coarser"), std::string::npos);
    EXPECT_LE(found->high_per_m, 0.4 / 25e-6 * (1 + 1e-9));
    EXPECT_LT(*found->error_db, -80) << "windowed sinc: 1e-5 of a tone, and of it the ends";
    EXPECT_EQ(found->verdict.likeness, Likeness::none);
  }
}

// Frequencies above the coarse grid's limit must not alias into the band.
TEST(Compare, NothingFoldsOntoTheCoarserGrid) {
  const RandomSurface low(8, 300, 5000), high(9, 30000, 35000);
  const auto coarse = made_texture(25e-6, 2400, low);
  const auto fine = made_texture(10e-6, 6000, [&](double x) { return low(x) + 10 * high(x); });
  const auto found = compare(coarse, fine, no_formants());
  EXPECT_LT(*found->error_db, -60) << "80 dB and more below what was 20 dB louder";
}

TEST(Compare, ShiftIsTakenOut) {
  const RandomSurface surface(10, 300, 5000);
  const auto a = made_texture(10e-6, 6000, surface);
  const auto b = made_texture(10e-6, 6000, [&](double x) { return surface(x - 3e-6); });
  const auto found = compare(a, b, no_formants());
  const auto shifted = shifted_error(found->spectra, found->low_per_m, found->high_per_m, 50e-6);
  EXPECT_NEAR(shifted.shift, 3e-6, 1e-8);
  EXPECT_LT(shifted.error_db, *found->error_db - 15) << "what is left: windows that do not move with it";
}

TEST(Compare, FormantsAreMatchedMissedAndExtra) {
  const auto line = [](double x, double k) { return std::sin(2 * std::numbers::pi * k * x); };
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.3);
  const auto a =
      made_texture(50e-6, 1600, [&](double x) { return line(x, 1000) + line(x, 2500) + noise(random); });
  const auto b =
      made_texture(50e-6, 1600, [&](double x) { return line(x, 1000) + line(x, 4000) + noise(random); });
  CompareOptions options;
  options.spectrogram.max_frequency_per_m = 9e3;
  const auto found = compare(a, b, options);
  ASSERT_TRUE(found) << message(found.error());
  ASSERT_EQ(found->formants.matched.size(), 1U);
  EXPECT_NEAR(found->a_formants[found->formants.matched[0].first].frequency_per_m, 1000, 20);
  ASSERT_EQ(found->formants.missed.size(), 1U);
  EXPECT_NEAR(found->a_formants[found->formants.missed[0]].frequency_per_m, 2500, 20);
  ASSERT_EQ(found->formants.extra.size(), 1U);
  EXPECT_NEAR(found->b_formants[found->formants.extra[0]].frequency_per_m, 4000, 20);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const auto a = white_texture(1, 4000);
  const auto fault_of = [&](const schema::Texture& b, const CompareOptions& options = no_formants()) {
    const auto found = compare(a, b, options);
    EXPECT_FALSE(found);
    return found ? ErrorKind::internal : found.error().kind;
  };
  auto heights = a;
  heights.quantity = "height";
  heights.unit = "m";
  EXPECT_EQ(fault_of(heights), ErrorKind::unsuitable);
  EXPECT_EQ(fault_of(scaled(a, 0)), ErrorKind::unsuitable) << "silence";
  EXPECT_EQ(fault_of(white_texture(2, 40)), ErrorKind::unsuitable) << "too short";
  auto slow = a, fast = a;
  slow.valid_band = {{0, 100, 900}};
  fast.valid_band = {{0, 1000, 9000}};
  EXPECT_EQ(compare(slow, fast, no_formants()).error().kind, ErrorKind::unsuitable) << "nothing in common";
  CompareOptions options = no_formants();
  options.window_m = 10;
  EXPECT_EQ(fault_of(a, options), ErrorKind::usage);
  options = no_formants();
  options.tolerance_db = 0;
  EXPECT_EQ(fault_of(a, options), ErrorKind::usage);
  options = no_formants();
  options.pair.max_shift_m = NAN;
  EXPECT_EQ(fault_of(a, options), ErrorKind::usage);
}

TEST(ComparePage, NeedsNothingBesideItAndEscapesNames) {
  const auto a = white_texture(1, 4000);
  const auto found = compare(a, scaled(a, 2), no_formants());
  const auto page = comparison_page(*found, {"<oak & \"ash\">", "b"});
  ASSERT_TRUE(page) << message(page.error());
  EXPECT_EQ(page->find("<oak"), page->npos);
  EXPECT_NE(page->find("&lt;oak &amp; &quot;ash&quot;&gt;"), page->npos);
  EXPECT_EQ(page->find("=\"http"), page->npos) << "a link; names of SVG's vocabulary are none";
  EXPECT_LT(page->find("class=\"answer\""), page->find("<table")) << "the answer comes first";
  std::size_t pictures = 0;
  for (auto at = page->find("src=\"data:"); at != page->npos; at = page->find("src=\"data:", at + 1))
    ++pictures;
  EXPECT_EQ(pictures, 4U);
  for (auto at = page->find("src=\""); at != page->npos; at = page->find("src=\"", at + 1))
    EXPECT_EQ(page->compare(at, 10, "src=\"data:"), 0);
}

// The progress covers the spectrograms of both textures.
TEST(Compare, WhoWaitsHearsHowFarItIs) {
  const auto a = made_texture(10e-6, 8000, [](double x) { return 0.02 * std::sin(12000 * x); });
  std::vector<double> heard;
  const auto found = compare(a, scaled(a, 2), {}, [&](double part) { heard.push_back(part); });
  ASSERT_TRUE(found) << message(found.error());
  EXPECT_TRUE(std::ranges::is_sorted(heard));
  EXPECT_TRUE(std::ranges::any_of(heard, [](double part) { return part > 0 && part < 0.5; }));
  ASSERT_FALSE(heard.empty());
  EXPECT_GT(heard.back(), 0.9);
  EXPECT_LE(heard.back(), 1);
}

}  // namespace
}  // namespace tacto::analysis
