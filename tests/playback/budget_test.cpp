// SPDX-License-Identifier: GPL-3.0-or-later
// The choices of a budget, and its refusals.
#include "playback/choose/budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "made_textures.hpp"
#include "playback/choose/budget_words.hpp"
#include "tests/playback/rayleigh_law.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorPoint;
using schema::MeasuredChoice;

/// Arbitrary costs; hermite's errors are near the true ones.
schema::FoundTradeTable priced(double linear_ns, double hermite_ns, double sinc_ns) {
  schema::TradeTable table;
  table.choices = {{"reading", "linear", "tick", linear_ns, 0, {{16, 2e-2}, {64, 1.3e-3}}},
                   {"reading", "hermite", "tick", hermite_ns, 0, {{8, 2e-3}, {16, 8e-5}, {32, 5e-6}}},
                   {"reading", "sinc", "tick", sinc_ns, 0, {{4, 1.6e-2}, {6, 6e-4}}},
                   {"reading", "splines", "tick", 0, 0, {{2, 0}}},
                   {"inverse", "tap", "tap", 0.5, 0, {}},
                   {"hysteresis", "undone", "tick", 20, 0, {}}};
  return {table, "made up"};
}

class Budgets : public testing::Test {
 protected:
  schema::Result<TickDecision> decided(const TickBudget& budget, const schema::FoundTradeTable& table) {
    const PlacedTexture placed{&texture_, 0, 1};
    return decide(std::span(&placed, 1), transducer_, options_, budget, table);
  }
  std::string refusal(const TickBudget& budget) {
    const auto decision = decided(budget, priced(50, 60, 70));
    return decision ? "" : message(decision.error());
  }

  schema::Texture texture_ = sine_texture(0.02, 3000, 0.02);
  schema::Transducer transducer_ = *schema::read_transducer("wiertlewski2011");
  PrepareOptions options_;
};

TEST_F(Budgets, TakeTheCheapestThatKeepsThePromise) {
  const auto fast = decided({{{}, 1e-2}, {}}, priced(50, 60, 70));
  ASSERT_TRUE(fast) << message(fast.error());
  EXPECT_EQ(fast->chosen.interpolation, wire::Interpolation::linear);
  EXPECT_EQ(fast->chosen.samples_per_period, 1.25 * 64);
  const auto balanced = decided({{{}, 1e-3}, {}}, priced(50, 60, 70));
  EXPECT_EQ(balanced->chosen.interpolation, wire::Interpolation::hermite);
  EXPECT_EQ(balanced->chosen.samples_per_period, 1.25 * 16);
  EXPECT_LE(balanced->chosen.error, 1e-3);
  EXPECT_EQ(balanced->table, "made up");
  EXPECT_EQ(decided({{{}, 1e-2}, {}}, priced(50, 60, 40))->chosen.interpolation, wire::Interpolation::sinc);
  EXPECT_GT(balanced->chosen.inverse.taps, fast->chosen.inverse.taps);
  EXPECT_DOUBLE_EQ(balanced->chosen.tick_ns, 60 + 0.5 * balanced->chosen.inverse.taps);
}

TEST_F(Budgets, AQualityIsAnError) {
  const auto fast = decided({{schema::Quality::fast, {}}, {}}, priced(50, 60, 70));
  EXPECT_EQ(fast->chosen.error, decided({{{}, 1e-2}, {}}, priced(50, 60, 70))->chosen.error);
  const auto balanced = decided({{schema::Quality::balanced, {}}, {}}, priced(50, 60, 70));
  EXPECT_EQ(balanced->chosen.error, decided({{{}, 1e-3}, {}}, priced(50, 60, 70))->chosen.error);
}

// A texture that replaces a playing one has to use its filter.
TEST_F(Budgets, AFilterThatPlaysStays) {
  TickBudget budget{{{}, 1e-3}, {}};
  budget.filter = decided({{{}, 1e-2}, {}}, priced(50, 60, 70))->chosen.inverse;
  EXPECT_NE(refusal(budget), "") << "a filter of 1 % can't keep 0.1 %";
  budget.error.max_error = 2e-2;
  const auto decision = decided(budget, priced(50, 60, 70));
  ASSERT_TRUE(decision) << message(decision.error());
  EXPECT_EQ(decision->chosen.inverse.taps, budget.filter->taps);
}

TEST_F(Budgets, OfEqualCostLessMemoryDecides) {
  const auto choice = decided({{{}, 1e-2}, {}}, priced(60, 60, 60))->chosen;
  EXPECT_EQ(choice.interpolation, wire::Interpolation::sinc);
  EXPECT_EQ(choice.samples_per_period, 1.25 * 6);
}

TEST_F(Budgets, TheMostExactHasTheLeastError) {
  const auto exact = decided({{schema::Quality::exact, {}}, {}}, priced(50, 60, 70));
  ASSERT_TRUE(exact);
  EXPECT_LT(exact->chosen.error, decided({{{}, 1e-3}, {}}, priced(50, 60, 70))->chosen.error);
  const auto hurried = decided({{}, 75}, priced(50, 60, 70));
  ASSERT_TRUE(hurried);
  EXPECT_LE(hurried->chosen.tick_ns, 75);
  EXPECT_GT(hurried->chosen.error, exact->chosen.error);
}

// The prediction for the filter is the error of the filter that prepare() makes.
TEST_F(Budgets, TheChosenFilterIsTheOneThatIsMade) {
  const auto decision = decided({{{}, 1e-3}, {}}, priced(50, 60, 70));
  const auto prepared = prepare(texture_, transducer_, decision->chosen.in(options_));
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->taps.size(), decision->chosen.inverse.taps);
  EXPECT_LE(std::pow(10, prepared->inverse_error_db / 20), decision->chosen.inverse.error);
  EXPECT_EQ(static_cast<double>(prepared->samples.size() * sizeof(float)), decision->chosen.memory_bytes);
}

TEST_F(Budgets, RefuseWithTheBestThereIs) {
  const std::string exacting = refusal({{{}, 1e-5}, {}});
  EXPECT_NE(exacting.find("0.001 %"), std::string::npos) << exacting;
  EXPECT_NE(exacting.find("(hermite, 40 "), std::string::npos) << exacting;
  EXPECT_NE(exacting.find("inverse"), std::string::npos) << exacting;
  const std::string hurried = refusal({{{}, 1e-3}, 40});
  EXPECT_NE(hurried.find("40 ns"), std::string::npos) << hurried;
  EXPECT_NE(refusal({{{}, 0.5}, {}}), "");
  EXPECT_NE(refusal({{{}, 1e-3}, -1}), "");
  options_.most_samples = 100;
  EXPECT_NE(refusal({{{}, 1e-2}, {}}).find(" 100"), std::string::npos);
}

// The error that a refusal suggests is possible.
TEST_F(Budgets, TheRefusalsRemedyHelps) {
  const std::string words = refusal({{{}, 1e-5}, {}});
  const auto at = words.find("--max-error ");
  ASSERT_NE(at, std::string::npos) << words;
  EXPECT_EQ(refusal({{{}, std::stod(words.substr(at + 12)) / 100}, {}}), "");
}

TEST_F(Budgets, KeepWhatWasNamed) {
  options_.inverse = Inverse::gain;
  const std::string words = refusal({{{}, 1e-2}, {}, true});
  EXPECT_NE(words.find("gain only"), std::string::npos) << words;
  options_.inverse = Inverse::magnitude;
  EXPECT_NE(refusal({{{}, 1e-2}, {}, true}), "") << "its phase is off by more";
  EXPECT_EQ(refusal({{{}, 1e-2}, {}, false}), "");
}

TEST_F(Budgets, PromiseNothingOfAHysteresisThatStays) {
  transducer_.hysteresis = rayleigh(0.16, 5, 16);
  const double straight_ns = 60 + 0.5 * 24;
  const auto undone = decided({{{}, 1e-3}, {}}, priced(50, 60, 70));
  ASSERT_TRUE(undone) << message(undone.error());
  EXPECT_GT(undone->chosen.tick_ns, straight_ns);
  options_.undo_hysteresis = false;
  EXPECT_NE(refusal({{{}, 1e-2}, {}}).find("--keep-hysteresis"), std::string::npos);
}

TEST_F(Budgets, SayWhy) {
  const auto decision = decided({{{}, 1e-3}, {}}, priced(50, 60, 70));
  const auto said = [&](const std::string& words) {
    return std::ranges::any_of(
        decision->reasons, [&](const std::string& line) { return line.find(words) != std::string::npos; });
  };
  EXPECT_TRUE(said("hermite, 20 samples per period"));
  EXPECT_TRUE(said("linear: ")) << "what was not exact enough";
  EXPECT_TRUE(said("at best"));
  EXPECT_TRUE(said("an inverse of 128 taps: "));
  EXPECT_TRUE(said("more time per tick"));
  EXPECT_TRUE(said("gain only: "));
  EXPECT_TRUE(said("not included"));
}

TEST_F(Budgets, KnowWhatATickCosts) {
  const auto table = priced(50, 60, 70).table;
  EXPECT_DOUBLE_EQ(*tick_cost_ns(table, wire::Interpolation::hermite, 24, true), 60 + 12 + 20);
  EXPECT_FALSE(tick_cost_ns(table, wire::Interpolation::nearest, 24, false));
}

}  // namespace
}  // namespace tacto::playback
