// SPDX-License-Identifier: GPL-3.0-or-later
// Rate at which `compare` finds a narrow band or a line in one of two textures, and rate of false alarms. 200
// pairs per row, or TACTO_COMPARE_PAIRS of them; with 1,000 the required rates are asserted.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <complex>
#include <cstdlib>
#include <string>

#include "analysis/compare/compare.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "tests/analysis/compare_textures.hpp"
#include "tests/measured.hpp"
#include "tests/sanitized.hpp"

namespace tacto::analysis {
namespace {

constexpr double kPitchM = 50e-6;
constexpr std::array<double, 3> kLengthsMm = {40, 60, 90};

int pairs() {
  const char* asked = std::getenv("TACTO_COMPARE_PAIRS");
  return asked ? std::atoi(asked) : draws(200, 4);
}

using Gain = std::function<double(double per_mm)>;

// White Gaussian noise of standard deviation 1 after a gain that depends on frequency; cut out of twice the
// length.
std::vector<double> shaped_noise(std::mt19937_64& random, std::size_t samples, const Gain& gain) {
  std::normal_distribution<double> normal;
  std::vector<double> values(2 * samples);
  for (double& value : values) value = normal(random);
  spatial::RealFft fft(values.size());
  std::vector<std::complex<double>> spectrum(fft.bins());
  fft.forward(values, spectrum);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectrum[k] *= gain(1e-3 * static_cast<double>(k) / (static_cast<double>(values.size()) * kPitchM));
  fft.inverse(spectrum, values);
  return {values.begin() + static_cast<std::ptrdiff_t>(samples / 2),
          values.begin() + static_cast<std::ptrdiff_t>(samples / 2 + samples)};
}

double white(double) {
  return 1;
}

// A spectral shape: density in dB at frequencies in 1/mm, linear between them on a logarithmic axis.
template <std::size_t N>
double shape_amplitude(const std::array<std::pair<double, double>, N>& shape, double per_mm) {
  if (per_mm <= shape.front().first) return std::pow(10, shape.front().second / 20);
  for (std::size_t i = 1; i < N; ++i)
    if (const auto [high, high_db] = shape[i]; per_mm < high) {
      const auto [low, low_db] = shape[i - 1];
      return std::pow(10, (low_db + (high_db - low_db) * std::log(per_mm / low) / std::log(high / low)) / 20);
    }
  return std::pow(10, shape.back().second / 20);
}

// Densities of the emulated device's surfaces A and D, mean of 8 strokes at 50 mm/s (seeds 101-108), dB.
double like_a(double per_mm) {
  constexpr std::array<std::pair<double, double>, 11> kShape = {{{0.39, 25.8},
                                                                 {0.61, 24.6},
                                                                 {0.96, 20.4},
                                                                 {1.5, 16.2},
                                                                 {1.87, 15.6},
                                                                 {2.34, 19.8},
                                                                 {2.93, 21.4},
                                                                 {3.66, 10.8},
                                                                 {5.72, 10.2},
                                                                 {7.15, 3.4},
                                                                 {8.94, 0}}};
  return shape_amplitude(kShape, per_mm);
}
double like_d(double per_mm) {
  constexpr std::array<std::pair<double, double>, 12> kShape = {{{0.39, 8.6},
                                                                 {0.61, 4.9},
                                                                 {0.96, 4.5},
                                                                 {1.5, 5.2},
                                                                 {1.87, 5.6},
                                                                 {2.34, 10.1},
                                                                 {2.93, 11.2},
                                                                 {3.66, 4.1},
                                                                 {4.57, 6.4},
                                                                 {5.72, 8.3},
                                                                 {7.15, 2.8},
                                                                 {8.94, 0}}};
  return shape_amplitude(kShape, per_mm);
}

schema::Texture texture_of(std::vector<double> values) {
  schema::Texture texture;
  texture.signal.pitch_m = kPitchM;
  texture.signal.values = std::move(values);
  return texture;
}

std::size_t samples_of(double length_mm) {
  return static_cast<std::size_t>(std::lround(1e-3 * length_mm / kPitchM));
}

struct Pair {
  std::vector<double> a, b;
};
Pair noise_pair(unsigned seed, double length_mm, const Gain& gain) {
  std::mt19937_64 random(seed);
  Pair pair;
  pair.a = shaped_noise(random, samples_of(length_mm), gain);
  pair.b = shaped_noise(random, samples_of(length_mm), gain);
  return pair;
}

Comparison compared(const Pair& pair, PairAlign align = PairAlign::position) {
  CompareOptions options;
  options.formants = false;
  options.pair.align = align;
  auto found = compare(texture_of(pair.a), texture_of(pair.b), options);
  EXPECT_TRUE(found) << schema::message(found.error());
  return std::move(*found);
}

// Adds independent noise from `low` to `high` 1/mm, so that the density there increases by `db`.
void add_bump(Pair& pair, unsigned seed, double low, double high, double db) {
  std::mt19937_64 random(seed);
  const double amplitude = std::sqrt(std::pow(10, db / 10) - 1);
  const auto bump =
      shaped_noise(random, pair.b.size(), [&](double k) { return k >= low && k <= high ? amplitude : 0; });
  for (std::size_t i = 0; i < bump.size(); ++i) pair.b[i] += bump[i];
}

// Adds a line that increases the density of white noise in a Hann window of `window_mm` by `db`: its peak is
// power x window / 1.5, the noise's one-sided density is 2 x pitch.
void add_line(Pair& pair, unsigned seed, double window_mm, double db) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  const double per_mm = 1 + 7 * part(random), phase = 2 * std::numbers::pi * part(random);
  const double pitch_mm = 1e3 * kPitchM;
  const double power = (std::pow(10, db / 10) - 1) * 2 * pitch_mm * 1.5 / window_mm;
  for (std::size_t i = 0; i < pair.b.size(); ++i)
    pair.b[i] += std::sqrt(2 * power) *
                 std::cos(2 * std::numbers::pi * per_mm * pitch_mm * static_cast<double>(i) + phase);
}

struct Rates {
  int pairs = 0, different = 0, shape = 0, band = 0, line = 0;
  void add(const Comparison& c) {
    const Evidence& e = c.evidence;
    ++pairs;
    different += c.verdict.likeness == Likeness::different;
    shape += e.shape_db > e.shape_chance_db && e.shape_excess_db > c.tolerance_db;
    band += band_differs(e, c.tolerance_db);
    line += line_differs(e, c.tolerance_db);
  }
  double share() const { return static_cast<double>(different) / pairs; }
  void measure(const std::string& key) const {
    tacto::measured("compare_narrow." + key + "_percent", 100 * share());
  }
  void print(const std::string& what) const {
    const auto percent = [&](int count) { return 100.0 * count / pairs; };
    fmt::print(
        "{}: {} pairs, different {:.1f} % (by third octaves {:.1f}, a narrow band {:.1f}, a line {:.1f})\n",
        what, pairs, percent(different), percent(shape), percent(band), percent(line));
  }
};

Rates false_alarms(const std::string& what, unsigned seed, double length_mm, const Gain& gain) {
  Rates rates;
  for (int i = 0; i < pairs(); ++i)
    rates.add(compared(noise_pair(seed + static_cast<unsigned>(i), length_mm, gain),
                       i % 2 == 0 ? PairAlign::position : PairAlign::none));
  rates.print(fmt::format("no difference, {}, {:g} mm", what, length_mm));
  rates.measure(fmt::format("no_difference_{}_{:g}_mm", key_part(what), length_mm));
  return rates;
}

TEST(CompareNarrow, FalseAlarms) {
  std::vector<Rates> rows;
  unsigned seed = 100000;
  for (const double length_mm : kLengthsMm)
    rows.push_back(false_alarms("white", seed += 10000, length_mm, white));
  for (const double length_mm : {40.0, 90.0}) {
    rows.push_back(false_alarms("sloped as A", seed += 10000, length_mm, like_a));
    rows.push_back(false_alarms("sloped as D", seed += 10000, length_mm, like_d));
  }
  int different = 0, all = 0;
  for (const Rates& row : rows) different += row.different, all += row.pairs;
  if (sanitized()) return;
  // 5 % of 1,400 pairs: +- 0.6 %; of 200: +- 1.5 %, 3 standard deviations each.
  EXPECT_NEAR(static_cast<double>(different) / all, 0.05, 0.0175);
  for (const Rates& row : rows) {
    EXPECT_GE(row.share(), row.pairs >= 1000 ? 0.035 : 0.004);
    EXPECT_LE(row.share(), row.pairs >= 1000 ? 0.065 : 0.096);
  }
}

TEST(CompareNarrow, ABumpOf6DbIsFoundAndNamed) {
  constexpr std::array<double, 3> kRequired = {0.80, 0.95, 0.99};
  for (std::size_t row = 0; row < kLengthsMm.size(); ++row) {
    Rates rates;
    int named = 0;
    for (int i = 0; i < pairs(); ++i) {
      const auto seed = static_cast<unsigned>(200000 + 10000 * row + static_cast<unsigned>(i));
      Pair pair = noise_pair(seed, kLengthsMm[row], white);
      add_bump(pair, seed + 5000, 2, 2.6, 6);
      const Comparison found = compared(pair);
      rates.add(found);
      const NarrowBand& band = *found.evidence.narrow;
      named += band_differs(found.evidence, 2) && band.low_per_m < 2600 && band.high_per_m > 2000 &&
               band.level_db > 0;
      EXPECT_EQ(band_differs(found.evidence, 2),
                found.verdict.because.find("/mm B is ") != std::string::npos);
    }
    rates.print(fmt::format("6 dB over 2-2.6 /mm, {:g} mm", kLengthsMm[row]));
    rates.measure(fmt::format("band_of_6_db_{:g}_mm", kLengthsMm[row]));
    tacto::measured(
        fmt::format("compare_narrow.band_of_6_db_by_third_octaves_{:g}_mm_percent", kLengthsMm[row]),
        100.0 * rates.shape / rates.pairs);
    if (sanitized()) continue;
    EXPECT_GE(rates.share(), kRequired[row]);
    EXPECT_GE(named, rates.band * 98 / 100);
  }
}

TEST(CompareNarrow, ALineOf7DbIsFoundAndNamed) {
  constexpr std::array<double, 3> kRequired = {0.55, 0.85, 0.95};
  for (std::size_t row = 0; row < kLengthsMm.size(); ++row) {
    Rates rates;
    for (int i = 0; i < pairs(); ++i) {
      const auto seed = static_cast<unsigned>(300000 + 10000 * row + static_cast<unsigned>(i));
      Pair pair = noise_pair(seed, kLengthsMm[row], white);
      add_line(pair, seed + 5000, 10, 7);
      const Comparison found = compared(pair);
      rates.add(found);
      EXPECT_EQ(line_differs(found.evidence, 2),
                found.verdict.because.find("has a line at") != std::string::npos);
    }
    rates.print(fmt::format("a line of 7 dB, {:g} mm", kLengthsMm[row]));
    rates.measure(fmt::format("line_of_7_db_{:g}_mm", kLengthsMm[row]));
    EXPECT_GE(rates.share(), sanitized() ? 0 : kRequired[row]);
  }
}

// The differences that the report states as detectable, a band and a line, are found in 8 of 10 pairs.
TEST(CompareNarrow, TheDetectableDifferenceIsFoundEightTimesInTen) {
  constexpr std::array<std::size_t, 4> kWidths = {0, 3, 5, 8};  // 1, 4, 8 and 24 cells
  std::array<Rates, 4> bumps;
  Rates line;
  for (int i = 0; i < pairs(); ++i) {
    const auto seed = static_cast<unsigned>(400000 + i);
    const Pair pair = noise_pair(seed, 60, white);
    const Comparison before = compared(pair);
    for (std::size_t row = 0; row < kWidths.size(); ++row) {
      const DetectableBand& band = before.evidence.narrow->detectable[kWidths[row]];
      const double low = 3 + 0.21 * (i % 8);
      Pair with_bump = pair;
      add_bump(with_bump, seed + 5000, low, low + 1e-3 * band.width_per_m, band.level_db);
      bumps[row].add(compared(with_bump));
    }
    Pair with_line = pair;
    add_line(with_line, seed + 5000, 1e3 * before.window_m, before.evidence.line->detectable_db);
    line.add(compared(with_line));
  }
  line.print("a line of the detectable size, 60 mm");
  line.measure("detectable_line");
  for (std::size_t row = 0; row < kWidths.size(); ++row) {
    bumps[row].print(fmt::format("a band of the detectable size, number {}, 60 mm", kWidths[row]));
    bumps[row].measure(fmt::format("detectable_band_{}", kWidths[row]));
  }
  if (sanitized()) return;
  EXPECT_NEAR(line.share(), 0.8, 0.1);
  for (const Rates& bump : bumps) EXPECT_GE(bump.share(), 0.75);
  // For a wide band, whose detectable level is the tolerance, its parts are found as well.
  for (std::size_t row = 0; row + 1 < bumps.size(); ++row) EXPECT_LE(bumps[row].share(), 0.93);
}

// Both have the same strong lines; in one they are 0.1 % finer and 1 dB higher. That is no difference.
TEST(CompareNarrow, LinesThatBothHaveAreNoDifference) {
  int different = 0;
  for (int i = 0; i < draws(40, 4); ++i) {
    Pair pair = noise_pair(static_cast<unsigned>(500000 + i), 60, white);
    for (std::size_t n = 0; n < pair.a.size(); ++n)
      for (const double per_mm : {0.8, 1.6, 2.4, 4.8}) {
        const double turns = 2 * std::numbers::pi * per_mm * 1e3 * kPitchM * static_cast<double>(n);
        pair.a[n] += std::cos(turns);
        pair.b[n] += 1.12 * std::cos(1.001 * turns + 1);
      }
    different += compared(pair).verdict.likeness == Likeness::different;
  }
  EXPECT_LE(different, 6) << "of 40: 5 % are 2, + 3 standard deviations";
}

// Noise whose level wanders along the texture: in the whole band, or in a part of it. The assertions are
// loose; the figures are those of analysis/DECISIONS.md for textures that are not stationary.
TEST(CompareNarrow, UnsteadyTexturesAreCalledDifferentMoreOften) {
  for (const bool all : {true, false}) {
    Rates rates;
    for (int i = 0; i < pairs(); ++i) {
      Pair pair = noise_pair(static_cast<unsigned>(600000 + i), 60, white);
      std::mt19937_64 random(static_cast<unsigned>(610000 + i));
      for (std::vector<double>* values : {&pair.a, &pair.b}) {
        auto wander = shaped_noise(random, values->size(),
                                   [](double k) { return k <= 0.1 ? std::sqrt(1 / (2 * 0.1 * 0.05)) : 0; });
        const auto part =
            shaped_noise(random, values->size(), [&](double k) { return all || (k > 2 && k < 4); });
        for (std::size_t n = 0; n < values->size(); ++n)  // 3 dB of standard deviation, 10 mm and longer
          (*values)[n] = (all ? 0 : (*values)[n]) + std::pow(10, 3 * wander[n] / 20) * part[n];
      }
      rates.add(compared(pair));
    }
    rates.print(all ? "unsteady by 3 dB, all of it, 60 mm" : "unsteady by 3 dB, 2-4 /mm only, 60 mm");
    EXPECT_LE(rates.share(), sanitized() ? 1 : 0.15) << "7 % + 3 standard deviations of 200 pairs";
  }
}

}  // namespace
}  // namespace tacto::analysis
