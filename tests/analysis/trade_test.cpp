// SPDX-License-Identifier: GPL-3.0-or-later
// The trade of speed for accuracy: rows against closed forms, fronts and knees against ones found by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "analysis/trade/measured_trade.hpp"
#include "analysis/trade/offline/offline_half.hpp"
#include "analysis/trade/offline/spectrogram_errors.hpp"
#include "analysis/trade/rows/pareto.hpp"
#include "analysis/trade/trade_page.hpp"
#include "playback/choose/budget_words.hpp"
#include "spatial/spectrogram/budget.hpp"
#include "spatial/spectrogram/spectrogram.hpp"

namespace tacto::analysis {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
// Near 210 Hz under the finger of 50 mm/s; they beat over 3.3 mm.
constexpr double kLines_per_m[] = {4137, 4437};

schema::Texture line_texture(double length_m, double pitch_m) {
  schema::Texture texture;
  texture.signal.pitch_m = pitch_m;
  for (double x_m = 0; x_m < length_m; x_m += pitch_m)
    texture.signal.values.push_back(0.1 * std::sin(kTurn * kLines_per_m[0] * x_m) +
                                    0.1 * std::sin(kTurn * kLines_per_m[1] * x_m));
  texture.unit = "N";
  return texture;
}

const TradeRow& row_named(const std::vector<TradeRow>& rows, const std::string& knob,
                          const std::string& choice) {
  for (const TradeRow& row : rows)
    if (row.knob == knob && row.choice == choice) return row;
  ADD_FAILURE() << "no row " << knob << ": " << choice;
  return rows.front();
}

class OfflineTrade : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto measured = measure_offline(line_texture(0.03, 1e-6));
    ASSERT_TRUE(measured) << schema::message(measured.error());
    rows_ = *measured;
  }
  static const TradeRow& resampled(const std::string& choice) {
    return row_named(rows_, "interpolation and grid", choice);
  }
  static inline std::vector<TradeRow> rows_;
};

TEST_F(OfflineTrade, CoarseGridsErrWithinWhatReadingStates) {
  const double w = kTurn * kLines_per_m[1] * 20e-6;
  const double bound = 0.0026 * std::pow(w, 4) + 0.0032 * std::pow(w, 5);  // TextureLookup, of the amplitude
  const double error = resampled("sinc, 20 um").error;
  EXPECT_LT(error, std::sqrt(2) * bound);
  EXPECT_GT(error, 0.05 * bound);
  EXPECT_LT(resampled("sinc, 1 um").error, 1e-5);
}

TEST_F(OfflineTrade, MoreExactWaysErrLess) {
  EXPECT_LT(resampled("sinc, 1 um").error, 0.1 * resampled("hermite, 1 um").error);
  // Lines in the middle of the band pass, drift and hum are removed. The residual is the drift, distorted at
  // the ends of the record over some periods of 15 Hz.
  EXPECT_LT(row_named(rows_, "filter", "fourier, edges treated").error, 5e-3);
  EXPECT_LT(row_named(rows_, "hop", "100 um").error, row_named(rows_, "hop", "1 mm").error);
  EXPECT_LT(row_named(rows_, "padding", "8 windows").error, row_named(rows_, "padding", "1 windows").error);
  EXPECT_LT(row_named(rows_, "resolution", "auto").error, 1e-6);
  EXPECT_LT(row_named(rows_, "stored", "single precision").error, std::ldexp(1.0, -24));
}

TEST_F(OfflineTrade, EveryRowIsMeasured) {
  for (const TradeRow& row : rows_) {
    EXPECT_TRUE(std::isfinite(row.error)) << row.knob << " " << row.choice;
    EXPECT_GT(row.error, 0) << row.knob << " " << row.choice;
    EXPECT_LT(row.error, 2) << row.knob << " " << row.choice;
    EXPECT_GT(row.memory_bytes, 0) << row.knob << " " << row.choice;
    EXPECT_TRUE(std::isfinite(row.cost_ns) && row.cost_ns >= 0) << row.knob << " " << row.choice;
    if (row.knob == "stored") {
      EXPECT_EQ(row.cost_ns, 0) << row.choice;
    }
  }
}

// Blackman's window reduces the depth of the power's beat, cos(2 pi d x), to Q(d) / Q(0), where Q is the
// transform of its square. Linear interpolation between rows h apart has an error of (2 pi d h)^2 / sqrt(120)
// of the beat's RMS.
double closed_hop_error(double window_m, double hop_m) {
  const auto square = [&](double per_m) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int n = 0; n < kSteps; ++n) {
      const double turn = kTurn * (n + 0.5) / kSteps;
      const double w = 0.42 - 0.5 * std::cos(turn) + 0.08 * std::cos(2 * turn);
      sum += w * w * std::cos(kTurn * per_m * window_m * ((n + 0.5) / kSteps - 0.5));
    }
    return sum;
  };
  const double beat_per_m = kLines_per_m[1] - kLines_per_m[0];
  const double depth = square(beat_per_m) / square(0);
  return depth / std::sqrt(2 + depth * depth) * std::pow(kTurn * beat_per_m * hop_m, 2) / std::sqrt(120);
}

// The error of a pair is the root of the sum of squares of its parts; the smallest hop has almost no error of
// its own.
TEST_F(OfflineTrade, WindowAndHopErrAsTheBeatSays) {
  for (const double window_mm : {2.5, 5.0}) {
    const auto error = [&](const char* hop) {
      return row_named(rows_, "window x hop", fmt::format("{:g} mm, {}", window_mm, hop)).error;
    };
    EXPECT_LT(error("100 um"), error("200 um"));
    EXPECT_LT(error("200 um"), error("500 um"));
    EXPECT_LT(error("500 um"), error("1 mm"));
    const double window_alone =
        std::sqrt(std::pow(error("200 um"), 2) - std::pow(closed_hop_error(window_mm * 1e-3, 200e-6), 2));
    const double hop_alone = std::sqrt(std::pow(error("500 um"), 2) - std::pow(window_alone, 2));
    const double closed = closed_hop_error(window_mm * 1e-3, 500e-6);
    EXPECT_NEAR(hop_alone, closed, 0.1 * closed) << window_mm;  // the next term, (2 pi d h)^2 / 14, is 6 %
  }
  // A wide window smooths the beat, so that the rows may be far apart.
  EXPECT_LT(closed_hop_error(10e-3, 1e-3), 0.1 * closed_hop_error(2.5e-3, 1e-3));
}

// One line per window, d bins beside the next bin: Blackman's main lobe at d.
TEST(SpectrogramPairs, PaddingErrsAsTheWindowsLobeSays) {
  schema::Texture line;
  line.signal.pitch_m = 5e-6;
  constexpr double kLine_per_m = 2117;
  for (int i = 0; i < 6000; ++i) line.signal.values.push_back(std::sin(kTurn * kLine_per_m * 5e-6 * i));
  const auto energy = OctaveEnergy::of(line);
  ASSERT_TRUE(energy);
  const auto rows = measure_spectrogram_pairs(line, *energy);
  ASSERT_TRUE(rows) << schema::message(rows.error());
  const auto lobe = [](double bins) {
    const auto sinc = [](double x) {
      return std::abs(x) < 1e-12 ? 1 : std::sin(kTurn / 2 * x) / (kTurn / 2 * x);
    };
    return 0.42 * sinc(bins) + 0.25 * (sinc(bins - 1) + sinc(bins + 1)) +
           0.04 * (sinc(bins - 2) + sinc(bins + 2));
  };
  for (const double window_m : {5e-3, 10e-3})
    for (const int times : {1, 2, 4, 8}) {
      const auto height = [&](int padding) {
        const double place = kLine_per_m * window_m * padding;
        return lobe((place - std::round(place)) / padding);
      };
      const TradeRow& row =
          row_named(*rows, "window x padding", fmt::format("{:g} mm, {} windows", 1e3 * window_m, times));
      const std::string target = playback::percent(std::abs(height(times) / height(16) - 1));
      EXPECT_TRUE(row.note.ends_with("padding " + target))
          << row.choice << ": " << row.note << ", " << target;
    }
}

// White noise has the density 2 sigma^2 p up to half the grid's frequency; the power of an octave is density
// times width.
TEST(OctavePowers, OfWhiteNoiseAreItsDensityTimesTheirWidth) {
  schema::Texture noise;
  noise.unit = "N";
  noise.signal.pitch_m = 20e-6;
  std::mt19937_64 generator(7);
  std::normal_distribution<double> value;
  for (int i = 0; i < 1'000'000; ++i) noise.signal.values.push_back(value(generator));
  for (const double window_m : {2.5e-3, 5e-3})
    for (const int padding : {1, 2, 4, 8}) {
      spatial::SpectrogramOptions options;
      options.window_m = window_m;
      options.hop_m = window_m / 2;
      options.padded_m = padding * window_m;
      options.detrend = spatial::Detrend::none;  // otherwise components within two bins of 0 are removed, too
      const auto made = spatial::spatial_spectrogram(noise, options);
      ASSERT_TRUE(made) << schema::message(made.error());
      const auto powers = octave_powers(*made, 0, 20);
      for (std::size_t i = 0; i < powers.size(); ++i) {
        const double width_per_m = kOctaves_per_m[i + 1] - kOctaves_per_m[i];
        // 20 m of noise determine a band's power to sqrt(1 / (width 20 m)); Blackman's overlap of a half
        // increases that to at most 1.07 times (Welch 1967). Tolerance: four standard deviations.
        const double four = 4 * 1.07 / std::sqrt(width_per_m * 20);
        EXPECT_NEAR(powers[i] / (2 * 20e-6 * width_per_m), 1, four)
            << window_m << " x " << padding << ", octave " << i;
      }
    }
}

// The same without chance: a density a + b k at each bin, with steps that do not divide an octave.
TEST(OctavePowers, OfAStraightDensityAreItsIntegral) {
  for (const double step_per_m : {800.0, 400.0, 200.0, 137.0, 25.0}) {
    schema::Spectrogram made;
    made.position_m = {0.01, 0.02};
    made.frequency_step_per_m = step_per_m;
    made.bins = static_cast<std::size_t>(std::ceil(8000 / step_per_m)) + 1;
    for (int p = 0; p < 2; ++p)
      for (std::size_t k = 0; k < made.bins; ++k)
        made.cells.push_back(static_cast<float>(1e-6 * (10e3 - made.frequency_per_m(k))));
    const auto powers = octave_powers(made, 0, 1);
    for (std::size_t i = 0; i < powers.size(); ++i) {
      const double low = kOctaves_per_m[i], high = kOctaves_per_m[i + 1];
      const double closed = 1e-6 * (high - low) * (10e3 - (low + high) / 2);
      EXPECT_NEAR(powers[i], closed, 1e-6 * closed) << step_per_m << " 1/m, octave " << i;  // floats
    }
  }
}

TEST(OfflineTradeInput, RefusesWhatIsTooShortOrTooCoarse) {
  const auto too_short = measure_offline(line_texture(0.005, 1e-6));
  ASSERT_FALSE(too_short);
  EXPECT_NE(too_short.error().what.find("12 mm"), std::string::npos);
  const auto too_coarse = measure_offline(line_texture(0.03, 60e-6));
  ASSERT_FALSE(too_coarse);
  EXPECT_NE(too_coarse.error().what.find("50 um"), std::string::npos);
}

TEST(MeasuredChoices, FallWithPointsAndEqualSciPy) {
  for (const schema::MeasuredChoice& choice : measure_resampling()) {
    EXPECT_TRUE(std::isfinite(choice.cost_ns) && choice.cost_ns >= 0) << choice.name << " " << choice.cost_ns;
    for (std::size_t i = 1; i < choice.errors.size(); ++i)
      EXPECT_LE(choice.errors[i].error, choice.errors[i - 1].error) << choice.name;
  }
  // SciPy: PchipInterpolator(t, way) inverted, then PchipInterpolator(t, force), of a sine under a finger
  // whose speed varies by a tenth, with a period of 937 frames; its inverse is exact to 1e-8 of the error.
  const auto cubics = measure_resampling().front();
  ASSERT_EQ(cubics.name, "hermite");
  EXPECT_NEAR(cubics.error_at(20), 2.5552528e-3, 1e-6 * 2.6e-3);
  EXPECT_NEAR(cubics.error_at(100), 4.8769526e-5, 1e-6 * 4.9e-5);
  const schema::MeasuredChoice grid = measure_grid();
  EXPECT_LT(grid.error_at(100), 1e-7);
  EXPECT_GT(grid.error_at(4), 0.01);
}

TEST(Pareto, FindsFrontAndKneeByHand) {
  // Error against cost: 10 %, 1 % and 0.9 % for 10, 20 and 100 ns; a fourth choice is beaten.
  const std::vector<TradeRow> rows = {{"way", "rough", 0.1, 10, "tick", 1, 0, ""},
                                      {"way", "good", 0.01, 20, "tick", 1, 0, ""},
                                      {"way", "silly", 0.02, 50, "tick", 1, 0, ""},
                                      {"way", "fine", 0.009, 100, "tick", 1, 0, ""},
                                      {"other", "only", 0.5, 1, "tick", 1, 0, ""}};
  const auto worth = worth_of(rows);
  EXPECT_TRUE(worth[0].on_front && worth[1].on_front && worth[3].on_front && worth[4].on_front);
  EXPECT_FALSE(worth[2].on_front);
  EXPECT_EQ(worth[2].beaten_by, "good");
  EXPECT_TRUE(worth[1].knee);
  EXPECT_FALSE(worth[0].knee || worth[3].knee || worth[4].knee);
  const auto answers = plain_answers(rows);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_NE(answers[0].knee.find("good (error 1 %"), std::string::npos) << answers[0].knee;
  EXPECT_EQ(answers[0].never, "silly");
}

TEST(Pareto, SaysAtWhichSpeedItsPickErrsMost) {
  TradeRow row{"way", "late", 0.3, 10, "tick", 1, 2e-3, ""};
  row.by_speed = {{0.025, 0.1}, {0.1, 0.3}, {0.2, kNotMeasured}};
  EXPECT_EQ(row.worst_speed_mps(), 0.1);
  TradeRow good = row;
  good.choice = "early", good.error = 0.005, good.by_speed = {{0.025, 0.001}, {0.1, 0.002}, {0.2, 0.005}};
  const std::vector<TradeRow> rows = {row, good};
  EXPECT_EQ(plain_answers(rows).front().knee,
            "early (error 0.5 % at 200 mm/s, the worst of 25, 100, 200 mm/s, 10 ns per tick)");
  EXPECT_TRUE(std::isnan(TradeRow{}.worst_speed_mps()));
}

// For a scene of a slow and a fast texture, the error is the larger one at each speed.
TEST(WorstTrade, TakesTheWorseOfEachSpeed) {
  TradeRow a{"way", "late", 0.3, 10, "tick", 1, 0, "a"}, b{"way", "late", 0.4, 10, "tick", 2, 0, "b"};
  a.by_speed = {{0.025, 0.3}, {0.1, kNotMeasured}};
  b.by_speed = {{0.025, 0.1}, {0.1, 0.4}};
  const Trade worst =
      worst_trade({{"a", "m", "", {{"real time", {a}}}}, {"b", "m", "", {{"real time", {b}}}}});
  const TradeRow& row = worst.halves.front().rows.front();
  EXPECT_EQ(row.error, 0.4);
  EXPECT_EQ(row.by_speed[0].error, 0.3);
  EXPECT_EQ(row.by_speed[1].error, 0.4);
  EXPECT_EQ(row.worst_speed_mps(), 0.1);
  EXPECT_EQ(row.note, "b");
}

TEST(Pareto, WhatSavesMemoryOrTimeToAnswerIsWorthIt) {
  const std::vector<TradeRow> rows = {{"way", "big", 0.01, 10, "tick", 100, 0, ""},
                                      {"way", "small", 0.01, 20, "tick", 1, 0, ""},
                                      {"way", "late", 0.02, 20, "tick", 100, 2e-3, ""}};
  const auto worth = worth_of(rows);
  EXPECT_TRUE(worth[0].on_front && worth[1].on_front);
  EXPECT_EQ(worth[2].beaten_by, "big");
}

TEST(Pareto, CostsWithinATenthAreAlike) {
  const std::vector<TradeRow> rows = {{"way", "a", 0.01, 100, "tick", 1, 0, ""},
                                      {"way", "b", 0.02, 95, "tick", 1, 0, ""}};
  EXPECT_EQ(worth_of(rows)[1].beaten_by, "a");
}

TEST(TradePage, HasEveryRowOnceAndEscapesNames) {
  const Trade trade{"<b>oak</b>",
                    "a machine",
                    "by a test",
                    {{"offline", {{"way", "a, \"b\"", 0.01, 100, "frame", 1, 0, "n"}}}}};
  const auto page = trade_page(trade);
  ASSERT_TRUE(page) << schema::message(page.error());
  EXPECT_EQ(page->find("<b>oak"), std::string::npos);
  EXPECT_NE(page->find("&lt;b&gt;oak"), std::string::npos);
  EXPECT_NE(page->find("Simulated"), std::string::npos);
  EXPECT_EQ(
      trade_csv(trade),
      std::string(kTradeCsvHead) +
          "cost_ns,per,memory_bytes,latency_s,on_front,knee,beaten_by,note,simulated,worst_speed_mps,"
          "error_at_25mmps,error_at_100mmps,error_at_200mmps\n"
          "offline,\"way\",\"a, \"\"b\"\"\",0.01,100,frame,1,0,true,false,\"\",\"n\",\"by a test\",,,,\n");
}

}  // namespace
}  // namespace tacto::analysis
