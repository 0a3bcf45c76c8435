// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time half of the trade: the order of the choices, and their errors where a closed form exists.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/trade/realtime_half.hpp"

namespace tacto::analysis {
namespace {

// 24 mm with equal amplitudes up to the finest detail, 8 /mm.
schema::Texture traded_texture() {
  schema::Texture texture;
  texture.signal.pitch_m = 10e-6;
  for (int i = 0; i < 2400; ++i) {
    double force_n = 0;
    for (const double per_m : {500.0, 2000.0, 5000.0, 8000.0})
      force_n += 0.01 * std::sin(2 * std::numbers::pi * per_m * i * 10e-6 + per_m);
    texture.signal.values.push_back(force_n);
  }
  return texture;
}

class RealtimeTradeTable : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto rows = measure_realtime(traded_texture(), *schema::read_transducer("wiertlewski2011"));
    ASSERT_TRUE(rows) << schema::message(rows.error());
    rows_ = *rows;
  }
  static const TradeRow& row(const std::string& knob, const std::string& choice) {
    static const TradeRow kNone{"none", "none", -1, -1, "", -1, -1, ""};
    const auto found =
        std::ranges::find_if(rows_, [&](const TradeRow& r) { return r.knob == knob && r.choice == choice; });
    EXPECT_NE(found, rows_.end()) << knob << ": " << choice;
    return found == rows_.end() ? kNone : *found;
  }
  static double error(const std::string& knob, const std::string& choice) { return row(knob, choice).error; }
  static std::vector<TradeRow> rows_;
};
std::vector<TradeRow> RealtimeTradeTable::rows_;

TEST_F(RealtimeTradeTable, HoldsNumbersAlone) {
  for (const TradeRow& row : rows_) {
    std::printf("%-36s %-22s %10.3g  %8.1f ns  %9.0f B  %7.4f ms  %s\n", row.knob.c_str(), row.choice.c_str(),
                row.error, row.cost_ns, row.memory_bytes, 1e3 * row.latency_s, row.note.c_str());
    EXPECT_EQ(row.is_judged(), row.knob != "loop") << row.choice;  // of the loops only the latency is known
    for (const double value :
         {row.is_judged() ? row.error : 0, row.cost_ns, row.memory_bytes, row.latency_s}) {
      EXPECT_TRUE(std::isfinite(value)) << row.knob << ": " << row.choice;
      EXPECT_GE(value, 0) << row.knob << ": " << row.choice;
    }
    EXPECT_EQ(row.per, row.knob.starts_with("tick rate") ? "ms" : "tick");
  }
  EXPECT_GT(rows_.size(), 60U);
}

// At six samples per period each has its stated error; that of nearest is a quarter of the force.
TEST_F(RealtimeTradeTable, OrdersTheInterpolations) {
  const std::string knob = "interpolation x samples per period";
  EXPECT_LT(error(knob, "sinc, 6"), 0.3 * error(knob, "hermite, 6"));
  EXPECT_LT(error(knob, "hermite, 6"), 0.3 * error(knob, "linear, 6"));
  EXPECT_LT(error(knob, "linear, 6"), 0.6 * error(knob, "nearest, 6"));
  EXPECT_GT(error(knob, "nearest, 6"), 0.05);
  for (const auto& [fewer, more] : {std::pair{"6", "12"}, {"12", "24"}})
    EXPECT_LT(error(knob, std::string("linear, ") + more),
              0.5 * error(knob, std::string("linear, ") + fewer));
  EXPECT_LT(error(knob, "hermite, 12"), 0.2 * error(knob, "hermite, 6"));
  EXPECT_LT(error(knob, "hermite, 24"), 1.5e-4);  // an encoder of 1 nm is not more accurate at 200 mm/s
}

// Inverting only the magnitudes does not improve the displacement compared with the gain alone.
TEST_F(RealtimeTradeTable, OrdersTheInverses) {
  EXPECT_LT(error("inverse", "full"), 2e-3);
  for (const char* other : {"magnitude", "gain", "none"})
    EXPECT_LT(error("inverse", "full"), 0.01 * error("inverse", other)) << other;
  const std::string amplitudes = "inverse, amplitudes only";
  EXPECT_LE(error(amplitudes, "full"), error(amplitudes, "magnitude"));
  EXPECT_LT(error(amplitudes, "magnitude"), 0.1 * error(amplitudes, "gain"));
  EXPECT_LE(error(amplitudes, "gain"), error(amplitudes, "none"));
}

TEST_F(RealtimeTradeTable, TellsWhatEachThingIsFor) {
  EXPECT_LT(error("look ahead", "on"), 0.1 * error("look ahead", "off"));
  EXPECT_NEAR(row("look ahead", "off").latency_s, 2e-3, 1e-9);
  EXPECT_LT(error("between counts", "on, 10 um encoder"),
            0.5 * error("between counts", "off, 10 um encoder"));
  EXPECT_LT(error("pyramid", "all levels"), 0.1 * error("pyramid", "one level"));
  EXPECT_GT(row("pyramid", "all levels").memory_bytes, row("pyramid", "one level").memory_bytes);
  EXPECT_LT(error("hysteresis", "undone"), 0.1 * error("hysteresis", "kept"));
  EXPECT_NEAR(error("precision", "single"), error("precision", "double"), 1e-5);
  EXPECT_LT(row("loop", "device").latency_s, row("loop", "host").latency_s);
}

// Below 1750 Hz the band ends earlier, and the content above is missing.
TEST_F(RealtimeTradeTable, KnowsWhatTheRateIsFor) {
  EXPECT_GT(error("tick rate", "1 kHz"), 0.1);
  EXPECT_LT(error("tick rate", "2 kHz"), 2e-3);
  EXPECT_LT(error("tick rate", "20 kHz"), 2e-3);
  EXPECT_EQ(error("tick rate x inverse", "2 kHz, full"), error("tick rate", "2 kHz"));
}

schema::Texture one_line(double per_m) {
  schema::Texture texture;
  texture.signal.pitch_m = 10e-6;
  for (int i = 0; i < 2400; ++i)  // whole waves: the loop has no seam
    texture.signal.values.push_back(0.01 * std::sin(2 * std::numbers::pi * per_m * i * 10e-6));
  return texture;
}

// A delay tau causes an error of 2 |sin(pi k v tau)| for a line of k: without compensation the error grows
// with the finger's speed, the same at each rate; with compensation it is almost zero.
TEST(RealtimePairs, ADelayErrsByItsClosedForm) {
  constexpr double kLinePerM = 1000;
  const auto rows = measure_realtime(one_line(kLinePerM), *schema::read_transducer("wiertlewski2011"));
  ASSERT_TRUE(rows) << schema::message(rows.error());
  int uncompensated = 0;
  for (const TradeRow& row : *rows) {
    if (row.knob != "tick rate x delay compensation") continue;
    ASSERT_EQ(row.by_speed.size(), 3U) << row.choice;
    const bool off = row.choice.ends_with("off");
    uncompensated += off;
    EXPECT_EQ(row.latency_s > 1e-3, off) << row.choice;
    for (const ErrorAtSpeed& each : row.by_speed) {
      const double late =
          2 * std::abs(std::sin(std::numbers::pi * kLinePerM * each.speed_mps * row.latency_s));
      // The residual of the compensated chain is added; at 1 kHz the band ends below 300 Hz.
      EXPECT_NEAR(each.error, late, 0.01) << row.choice << " at " << each.speed_mps << " m/s";
    }
    if (off) {
      EXPECT_EQ(row.worst_speed_mps(), 0.2) << row.choice;
      EXPECT_LT(row.by_speed[0].error, row.by_speed[1].error) << row.choice;
      EXPECT_LT(row.by_speed[1].error, row.by_speed[2].error) << row.choice;
    }
  }
  EXPECT_EQ(uncompensated, 5);
}

// 8 /mm are 200 Hz for a finger of 25 mm/s, and 800 Hz, outside of the band, for one of 100 mm/s.
TEST(RealtimePairs, ASpeedWithNothingToFeelIsNotCounted) {
  const auto rows = measure_realtime(one_line(8000), *schema::read_transducer("wiertlewski2011"));
  ASSERT_TRUE(rows) << schema::message(rows.error());
  const auto full = std::ranges::find_if(
      *rows, [](const TradeRow& row) { return row.knob == "inverse" && row.choice == "full"; });
  EXPECT_EQ(full->error, full->by_speed[0].error);
  EXPECT_TRUE(std::isnan(full->by_speed[1].error) && std::isnan(full->by_speed[2].error));
  const auto nothing = measure_realtime(one_line(24000), *schema::read_transducer("wiertlewski2011"));
  ASSERT_FALSE(nothing);
  EXPECT_NE(nothing.error().what.find("25, 100, 200 mm/s"), std::string::npos) << nothing.error().what;
}

// At the worst place, u = 1/2, the error of linear is 1 - cos(w / 2) and that of nearest 2 sin(w / 4). The
// tested places are 1/509 apart.
TEST(RealtimeChoices, AreWhatTheClosedFormsSay) {
  const auto choices = measure_reading_choices();
  const auto named = [&](const std::string& name) {
    return *std::ranges::find(choices, name, &schema::MeasuredChoice::name);
  };
  for (const schema::ErrorPoint& point : named("linear").errors)
    EXPECT_NEAR(point.error, 1 - std::cos(std::numbers::pi / point.points_per_period), 1e-5)
        << point.points_per_period;
  for (const schema::ErrorPoint& point : named("nearest").errors)
    EXPECT_NEAR(point.error, 2 * std::sin(0.5 * std::numbers::pi / point.points_per_period), 0.01)
        << point.points_per_period;
  for (const schema::MeasuredChoice& choice : choices) {
    EXPECT_TRUE(std::isfinite(choice.cost_ns) && choice.cost_ns >= 0) << choice.name << " " << choice.cost_ns;
    EXPECT_TRUE(std::ranges::is_sorted(choice.errors, std::greater<>(), &schema::ErrorPoint::error))
        << choice.name;
  }
  EXPECT_LT(named("sinc").error_at(6), 0.1 * named("hermite").error_at(6));
}

// This program measured the shipped table; errors are the same on every machine.
TEST(RealtimeChoices, AreTheShippedTables) {
  const auto shipped = schema::shipped_trade_table();
  ASSERT_TRUE(shipped);
  for (const schema::MeasuredChoice& choice : measure_reading_choices()) {
    const auto listed = shipped->at(choice.stage);
    const auto same = std::ranges::find(listed, choice.name, &schema::MeasuredChoice::name);
    ASSERT_NE(same, listed.end()) << choice.name;
    for (const schema::ErrorPoint& point : choice.errors)
      EXPECT_NEAR(same->error_at(point.points_per_period), point.error, 0.01 * point.error + 1e-7)
          << choice.name << " at " << point.points_per_period;
  }
}

}  // namespace
}  // namespace tacto::analysis
