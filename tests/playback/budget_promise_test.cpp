// SPDX-License-Identifier: GPL-3.0-or-later
// The promise: for any texture, transducer and path, the error of the choice stays below the requested error.
#include <gtest/gtest.h>

#include <algorithm>

#include "line_textures.hpp"
#include "playback/choose/budget.hpp"
#include "playback/choose/budget_words.hpp"
#include "playback/prepare/undone_chain.hpp"
#include "playback/render/reference/padded_spectrum.hpp"
#include "tests/measured.hpp"
#include "tests/sanitized.hpp"

namespace tacto::playback {
namespace {

constexpr double kSeconds = 0.65, kLeftOutS = 0.15;
constexpr double kTrueM = 1e-9;  // an encoder so fine that its count is the exact position
constexpr double kWindowHz = 8;  // half width of the window; nothing from outside of the band leaks into it
constexpr double kGainMPerN = 1e-4;

using Random = std::mt19937;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}
double between_logs(Random& random, double low, double high) {
  return std::exp(between(random, std::log(low), std::log(high)));
}

schema::Transducer random_transducer(Random& random) {
  schema::Transducer t = *schema::read_transducer("wiertlewski2011");
  t.mass_kg *= between_logs(random, 0.6, 1.6);
  t.bender_stiffness_n_per_m *= between_logs(random, 0.6, 1.6);
  t.flexure_stiffness_n_per_m *= between_logs(random, 0.6, 1.6);
  t.damping_n_s_per_m *= between_logs(random, 0.4, 4);
  t.capacitance_f *= between_logs(random, 0.6, 1.6);
  t.drive_limit_v = 1e3, t.slew_limit_v_per_s = 1e9;  // the promise excludes limits
  return t;
}

/// A transducer and its settings, for several textures; its filters are computed once.
struct Machine {
  schema::Transducer transducer;
  PrepareOptions options;
  std::vector<InverseChoice> inverses;
};

Machine random_machine(Random& random) {
  Machine machine{random_transducer(random), {}, {}};
  PrepareOptions& o = machine.options;
  o.rate_hz = std::array{2e3, 3e3, 5e3, 10e3}[random() % 4];
  o.metres_per_count = kTrueM;
  o.gain_m_per_n = kGainMPerN;
  o.ends = Ends::loop;
  o.seam_m = 0;
  o.onset_s = 0;
  machine.inverses = inverse_choices(machine.transducer, o, false);
  return machine;
}

/// Speed that varies around its mean; the position is its integral.
struct RandomPath {
  double mean_mps = 0, wander = 0, wander_hz = 0;
  double place_m(double t) const {
    return 0.1 + mean_mps * (t - wander / (kTwoPi * wander_hz) * std::cos(kTwoPi * wander_hz * t));
  }
};

struct Outcome {
  double error = 0;      ///< RMS re the target, in the band
  double beside = 0;     ///< RMS of what is read outside of the band, re that in the band
  double at_finger = 0;  ///< the same error, re the target at the finger's true position
};

/// Blackman-Harris window of four terms: -92 dB beyond four bins.
double window_at(double u) {
  return 0.35875 - 0.48829 * std::cos(kTwoPi * u) + 0.14128 * std::cos(2 * kTwoPi * u) -
         0.01168 * std::cos(3 * kTwoPi * u);
}

double windowed_energy(const std::vector<double>& values, double rate_hz, const spatial::Band& band) {
  const auto skipped = static_cast<std::size_t>(kLeftOutS * rate_hz);
  std::vector<double> inner(values.begin() + static_cast<std::ptrdiff_t>(skipped), values.end());
  const auto n = static_cast<double>(inner.size());
  for (std::size_t i = 0; i < inner.size(); ++i) inner[i] *= window_at(static_cast<double>(i) / n);
  return energy_in(spectrum_of(inner, rate_hz, inner.size()), band);
}

std::vector<double> through_response(const std::vector<double>& values, double rate_hz,
                                     const Response& response) {
  return signal_of(through(spectrum_of(values, rate_hz, 2 * values.size()), response));
}

/// The kernel's drive, and the target at the position that the kernel assumed.
struct Played {
  std::vector<double> drive_v, target_m;
  std::vector<double> true_m;  ///< the target at the finger's true position
};

// With an encoder this fine the rounding of its scale to 32 bits is visible: about 20 nm over 0.1 m.
double scale_of(const Prepared& prepared) {
  return std::ldexp(static_cast<double>(prepared.scale.samples_per_count_q32), -32) * prepared.pitch_m /
         kTrueM;
}

// For a varying speed the kernel predicts the position; the promise does not cover the prediction's error.
Played played(const Prepared& prepared, const PrepareOptions& o, const LineTexture& texture,
              const RandomPath& path) {
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  core::FingerTracker tracker;  // as the kernel's
  tracker.set(prepared.setup().texture.tracker);
  Played played;
  for (int i = 0; i < static_cast<int>(kSeconds * o.rate_hz); ++i) {
    const double true_m = path.place_m(i / o.rate_hz);
    const auto count = static_cast<std::int32_t>(std::floor(true_m / kTrueM));
    played.drive_v.push_back(kernel.tick({count, prepared.gain_m_per_n, true, core::kNoForce}).drive_v);
    const core::FingerPlace place = tracker.track(count);
    const double guess_m = kTrueM * (place.count + double{place.offset});
    const double ahead_m = path.wander > 0 ? guess_m : true_m + path.mean_mps * prepared.delay_s;
    const double then_m = path.place_m(i / o.rate_hz + prepared.delay_s);
    const double ratio = std::abs(place.counts_per_tick) / prepared.full_detail_counts_per_tick;
    const auto target_at = [&](double place_m) {
      return o.gain_m_per_n *
             texture.read(place_m * scale_of(prepared), ratio, prepared.finest_per_m, prepared.scale.levels);
    };
    played.target_m.push_back(target_at(ahead_m));
    played.true_m.push_back(target_at(then_m));
  }
  return played;
}

Outcome outcome_of(const Machine& machine, const PrepareOptions& o, const LineTexture& texture,
                   const RandomPath& path) {
  const auto prepared = prepare(texture.sampled(), machine.transducer, o);
  EXPECT_TRUE(prepared) << message(prepared.error());
  if (!prepared) return {1, 0};
  const Played all = played(*prepared, o, texture, path);
  const Chain chain = undone_chain(machine.transducer, o).chain;
  auto error_m = through_response(all.drive_v, o.rate_hz, [&](double f) { return chain_response(chain, f); });
  const auto target_m = through_response(
      all.target_m, o.rate_hz, [&](double f) { return std::polar(1.0, -kTwoPi * f * prepared->delay_s); });
  const auto true_m = through_response(
      all.true_m, o.rate_hz, [&](double f) { return std::polar(1.0, -kTwoPi * f * prepared->delay_s); });
  std::vector<double> finger_m = error_m;
  for (std::size_t i = 0; i < error_m.size(); ++i) error_m[i] -= target_m[i], finger_m[i] -= true_m[i];
  const spatial::Band band{o.band.low_hz + kWindowHz, prepared->passes_to_hz - kWindowHz};
  const double target = windowed_energy(target_m, o.rate_hz, band);
  const double whole = windowed_energy(target_m, o.rate_hz, {0, 0.5 * o.rate_hz});
  return {std::sqrt(windowed_energy(error_m, o.rate_hz, band) / target), std::sqrt(whole / target - 1),
          std::sqrt(windowed_energy(finger_m, o.rate_hz, band) / target)};
}

struct Case {
  LineTexture texture;
  RandomPath path;
  double asked = 0;
};

Case random_case(Random& random) {
  const double finest_per_m = between_logs(random, 1500, 25e3);
  Case c{random_lines(random, finest_per_m, random() % 2 == 0), {}, between_logs(random, 4e-4, 0.05)};
  c.path.mean_mps = std::min(0.3, between_logs(random, 0.3, 1.5) * 480 / finest_per_m);
  c.path.wander = random() % 2 == 0 ? 0 : between(random, 0.05, 0.3);
  c.path.wander_hz = between(random, 0.5, 3);
  return c;
}

struct Tally {
  int kept = 0, broken = 0, refused = 0, beside = 0;
  double nearest = 0;         ///< the largest error re the requested one
  std::vector<double> hands;  ///< for paths with varying speed: its measured effect re the estimated one

  void add(const Outcome& outcome, double asked, const std::string& words) {
    if (outcome.beside > 1) {
      ++beside;
      return;
    }
    const double used = outcome.error / asked;
    nearest = std::max(nearest, used);
    ++(used <= 1 ? kept : broken);
    if (used > 1) last = words + ": " + percent(outcome.error) + ", asked: " + percent(asked);
  }
  std::string last;  ///< the last broken promise
};

void try_case(Tally& tally, const Machine& machine, const Case& c, const schema::FoundTradeTable& table) {
  const schema::Texture sampled = c.texture.sampled();
  const PlacedTexture placed{&sampled, 0, 1};
  const auto decision = decide(std::span(&placed, 1), machine.inverses, false, machine.options,
                               TickBudget{{std::nullopt, c.asked}, {}}, table);
  if (!decision) {
    EXPECT_NE(message(decision.error()).find("error budget"), std::string::npos) << message(decision.error());
    ++tally.refused;
    return;
  }
  EXPECT_LE(decision->chosen.error, c.asked);
  const Outcome outcome = outcome_of(machine, decision->chosen.in(machine.options), c.texture, c.path);
  tally.add(outcome, c.asked, words_of(decision->chosen));
  if (!(c.path.wander > 0) || outcome.beside > 1) return;
  const double hand =
      unsteady_speed_error(std::span(&placed, 1), {c.path.mean_mps, c.path.wander, c.path.wander_hz},
                           machine.options, decision->chosen.inverse.delay_s);
  tally.hands.push_back(
      std::sqrt(std::max(0.0, outcome.at_finger * outcome.at_finger - outcome.error * outcome.error)) / hand);
}

Tally tried(int machines, int cases, const schema::TradeTable& table) {
  Random random(20261122);
  Tally tally;
  for (int m = 0; m < machines; ++m) {
    const Machine machine = random_machine(random);
    for (int i = 0; i < cases; ++i) try_case(tally, machine, random_case(random), {table, "a test"});
  }
  std::printf("%d kept, %d broken, %d refused, %d mostly beside the band; nearest %.2f of what was asked\n",
              tally.kept, tally.broken, tally.refused, tally.beside, tally.nearest);
  return tally;
}

TEST(BudgetPromise, HoldsForRandomTexturesPathsAndTransducers) {
  const Tally tally = tried(draws(8, 4), draws(75, 15), *schema::shipped_trade_table());
  measured("budget_promise.promises", tally.kept + tally.broken);
  measured("budget_promise.closest", tally.nearest);
  EXPECT_EQ(tally.broken, 0) << tally.last;
  EXPECT_GE(tally.kept, draws(500, 50));
  std::vector<double> hands = tally.hands;
  ASSERT_GE(std::ssize(hands), draws(200, 20));
  std::ranges::sort(hands);
  std::printf("what wandering hands cost re the estimate: median %.2f, of all %.2f to %.2f\n",
              hands[hands.size() / 2], hands.front(), hands.back());
  EXPECT_LT(hands.back(), 1) << "more than wandering_error() says";
  EXPECT_GT(hands.back(), 0.3) << "an estimate that nothing comes near";
  EXPECT_GT(tally.nearest, 0.2) << "a promise that nothing comes near says nothing about the table";
}

// A check of the test: a table that is ten times too good is detected.
TEST(BudgetPromise, BreaksWithATableThatIsTooGood) {
  schema::TradeTable table = *schema::shipped_trade_table();
  for (schema::MeasuredChoice& choice : table.choices)
    for (schema::ErrorPoint& point : choice.errors) point.error /= 10;
  const Tally tally = tried(2, 50, table);
  measured("budget_promise.wrong_table_broken_percent", 100.0 * tally.broken / (tally.kept + tally.broken));
  EXPECT_GT(tally.broken, 0);
}

}  // namespace
}  // namespace tacto::playback
