// SPDX-License-Identifier: GPL-3.0-or-later
// The promise of --max-error: for random surfaces, fingers and rates the true error stays below the requested
// one.
#include "spatial/spectrogram/budget.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "playback/model/texture_lookup.hpp"
#include "spatial/dsp/resample/thinned.hpp"
#include "spatial/texture/make_texture.hpp"
#include "tests/measured.hpp"

namespace tacto::spatial {
namespace {

constexpr double kBudgetTurn = 2 * std::numbers::pi;

struct BudgetLine {
  double frequency, amplitude, phase;  // 1/m, or of vibrations in time: cycles a frame
};

// A surface, a finger on it with exactly known position, and the requested error.
struct BudgetCase {
  TextureNeed need;
  double wander = 0, wander_frames = 0, asked = 0;
  std::size_t frames = 0;
  std::vector<BudgetLine> lines;
  bool in_time = false;  // vibrations; their spatial frequency is highest where the finger is slowest

  double force_at_frame(double frame) const { return sum_of(in_time ? frame : way_m(frame)); }
  double force_at(double x_m) const { return sum_of(in_time ? frame_at(x_m) : x_m); }
  double sum_of(double place) const {
    double sum = 0;
    for (const BudgetLine& line : lines)
      sum += line.amplitude * std::sin(kBudgetTurn * line.frequency * place + line.phase);
    return sum;
  }
  // By bisection; the position increases with each frame.
  double frame_at(double x_m) const {
    double low = 0, high = static_cast<double>(frames);
    for (int i = 0; i < 60; ++i) (way_m((low + high) / 2) < x_m ? low : high) = (low + high) / 2;
    return low;
  }
  double way_m(double frame) const {
    const double turn = kBudgetTurn / wander_frames;
    return need.slowest_mps / need.sample_rate_hz * (frame + wander * std::sin(turn * frame) / turn);
  }
};

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double even(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double logarithmic(double low, double high) { return std::exp(even(std::log(low), std::log(high))); }

 private:
  std::mt19937_64 random_;
};

BudgetCase drawn_case(unsigned seed) {
  Draw draw(seed);
  BudgetCase made;
  made.need.sample_rate_hz = draw.logarithmic(2e3, 50e3);
  made.need.highest_hz = made.need.sample_rate_hz / draw.logarithmic(4, 100);
  made.need.slowest_mps = draw.logarithmic(0.01, 0.3);
  made.wander = draw.even(0, 0.5);
  made.wander_frames = draw.even(kSteadyFrames, 3000);
  made.asked = draw.logarithmic(3e-6, 3e-2);
  made.frames = 2500;
  // No content outside of the band where the finger is fastest; half of the surfaces are a single line at its
  // edge.
  made.in_time = draw.even(0, 1) < 0.4;
  const double highest = made.in_time ? made.need.highest_hz / made.need.sample_rate_hz
                                      : made.need.highest_hz / (made.need.slowest_mps * (1 + made.wander));
  const int lines = draw.even(0, 1) < 0.5 ? 1 : 12;
  for (int i = 0; i < lines; ++i)
    made.lines.push_back(
        {highest * (i == 0 ? 1 : draw.even(0.02, 1)), draw.even(0.1, 1), draw.even(0, kBudgetTurn)});
  return made;
}

// As TextureMaker does: on a finer grid if the band requires one, then decimated.
schema::SpaceSignal texture_by(const TextureChoice& choice, const BudgetCase& from) {
  MonotonePath path;
  std::vector<double> force;
  for (std::size_t i = 0; i < from.frames; ++i) {
    path.sample.push_back(static_cast<double>(i));
    path.way_m.push_back(from.way_m(static_cast<double>(i)));
    force.push_back(from.force_at_frame(static_cast<double>(i)));
  }
  const std::size_t finer = finer_grid(choice.pitch_m, from.need.highest_hz, from.need.slowest_mps);
  const auto grid = grid_along(path, 1, choice.pitch_m / static_cast<double>(finer));
  auto values = resample(path, 1, *grid, force, 0, choice.method);
  if (finer > 1) values = thinned(values, finer);
  return {choice.pitch_m, grid->origin_m(), std::move(values)};
}

// RMS error of playback's interpolation, re the RMS, away from the ends.
double real_error(const TextureChoice& choice, const BudgetCase& from) {
  const schema::SpaceSignal texture = texture_by(choice, from);
  const playback::TextureLookup lookup(texture, texture.origin_m);
  const double length_m = texture.length_m();
  double off = 0, all = 0;
  constexpr int kPlaces = 3000;
  for (int i = 0; i < kPlaces; ++i) {
    const double x_m = texture.origin_m + length_m * (0.15 + 0.7 * (i + 0.37) / kPlaces);
    const double exact = from.force_at(x_m);
    off += std::pow(lookup(x_m) - exact, 2);
    all += exact * exact;
  }
  return std::sqrt(off / all);
}

schema::Budget budget_of(double error) {
  schema::Budget budget;
  budget.max_error = error;
  return budget;
}

TEST(Budget, KeepsItsPromiseForRandomSurfacesAndFingers) {
  const auto table = schema::shipped_trade_table();
  ASSERT_TRUE(table) << schema::message(table.error());
  std::size_t kept = 0, refused = 0;
  double closest = 0;
  for (unsigned seed = 0; seed < 700; ++seed) {
    const BudgetCase drawn = drawn_case(seed);
    const auto choices = choose_texture(*table, drawn.need, budget_of(drawn.asked));
    if (!choices) {
      ++refused;
      continue;
    }
    const double error = real_error(choices->taken, drawn);
    EXPECT_LE(error, drawn.asked) << "seed " << seed << " " << name_of(choices->taken.method) << " on "
                                  << choices->taken.pitch_m << ", promised " << choices->taken.error
                                  << ", points " << drawn.need.sample_rate_hz / drawn.need.highest_hz;
    EXPECT_LE(error, choices->taken.error) << "seed " << seed;
    closest = std::max(closest, error / drawn.asked);
    ++kept;
  }
  measured("spatial_budget.promises", static_cast<double>(kept));
  measured("spatial_budget.closest", closest);
  // Promises that always need the most expensive choice, or are mostly refused, would be useless.
  EXPECT_GT(kept, 500U);
  EXPECT_GT(closest, 0.3);
  std::cout << kept << " promises kept, " << refused << " refused; the closest at " << closest
            << " of what was asked\n";
}

TEST(Budget, TakesTheCheapestThatIsExactEnough) {
  const auto table = schema::shipped_trade_table();
  ASSERT_TRUE(table);
  const TextureNeed need{10e3, 500, 0.05, {}, {}};
  const auto choices = choose_texture(*table, need, budget_of(1e-3));
  ASSERT_TRUE(choices) << schema::message(choices.error());
  for (const TextureChoice& each : choices->tried) {
    const bool exact_enough = each.error <= 1e-3;
    EXPECT_FALSE(exact_enough && each.cost_ns_per_m < choices->taken.cost_ns_per_m) << name_of(each.method);
  }
  EXPECT_LE(choices->taken.error, 1e-3);
}

TEST(Budget, NamesWhatIsAttainableWhereItRefuses) {
  const auto table = schema::shipped_trade_table();
  ASSERT_TRUE(table);
  const auto refused =
      choose_texture(*table, {10e3, 500, 0.05, ResampleMethod::hermite, {}}, budget_of(1e-4));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, schema::ErrorKind::unsuitable);
  EXPECT_NE(refused.error().what.find("hermite"), std::string::npos) << refused.error().what;
}

TEST(Budget, LeavesWhatIsNamed) {
  const auto table = schema::shipped_trade_table();
  ASSERT_TRUE(table);
  const auto choices = choose_texture(*table, {10e3, 200, 0.05, {}, 2e-6}, budget_of(1e-2));
  ASSERT_TRUE(choices);
  EXPECT_EQ(choices->taken.pitch_m, 2e-6);
  for (const TextureChoice& each : choices->tried) EXPECT_EQ(each.pitch_m, 2e-6);
}

TEST(Budget, ExactMeansTheLeastError) {
  const auto table = schema::shipped_trade_table();
  ASSERT_TRUE(table);
  schema::Budget exact;
  exact.quality = schema::Quality::exact;
  const auto choices = choose_texture(*table, {10e3, 500, 0.05, {}, {}}, exact);
  ASSERT_TRUE(choices);
  for (const TextureChoice& each : choices->tried) EXPECT_GE(each.error, choices->taken.error);
  const auto resolution = choose_resolution(*table, std::nullopt, exact);
  ASSERT_TRUE(resolution);
  EXPECT_EQ(resolution->resolution, Resolution::whole);
  EXPECT_FALSE(choose_resolution(*table, std::nullopt, budget_of(1e-12)));
}

TEST(Budget, SaysWhatTheTableLacks) {
  schema::TradeTable empty;
  const auto refused = choose_texture(empty, {10e3, 500, 0.05, {}, {}}, budget_of(1e-2));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().remedy.find("--calibrate"), std::string::npos);
}

}  // namespace
}  // namespace tacto::spatial
