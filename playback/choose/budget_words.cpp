// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/choose/budget_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "playback/model/spatial_content.hpp"

namespace tacto::playback {
namespace {

double speed_lag_s(double rate_hz) {
  const double alpha = std::min(double{core::kMostAlpha}, 1 / (1 + kTrackerS * rate_hz));
  const double beta = alpha * alpha / (2 - alpha);
  return (alpha - beta / 2) / beta / rate_hz;
}

constexpr std::pair<std::string_view, wire::Interpolation> kInterpolations[] = {
    {"nearest", wire::Interpolation::nearest},
    {"linear", wire::Interpolation::linear},
    {"hermite", wire::Interpolation::hermite},
    {"sinc", wire::Interpolation::sinc}};

constexpr const char* kNotPromised =
    "not included: the encoder's steps, changes of speed during look-ahead, speeds beyond the maximum, a "
    "texture's ends, a drive at its limits, a finger or transducer that differs from the file, and a tick's "
    "time on a device that closes the loop itself";

std::string words_of_inverse(const InverseChoice& inverse) {
  if (inverse.inverse == Inverse::gain) return "gain only";
  if (inverse.inverse == Inverse::none) return "no inverse";
  return fmt::format("{} taps, {:g} ms", inverse.taps, 1e3 * inverse.delay_s);
}

// The best of the other choices, compared with the chosen one.
std::string verdict_on(const std::vector<TickChoice>& others, const TickChoice& chosen,
                       const TickBudget& budget) {
  std::vector<TickChoice> kept = others;
  std::erase_if(kept, [&](const TickChoice& other) {
    return other.error > (budget.by_error() ? chosen.error : budget.error.most_error());
  });
  if (kept.empty()) return fmt::format("an error of {} at best", percent(best_of(others, true).error));
  const TickChoice best = best_of(kept, false);
  const std::string how = fmt::format("{:.3g} ns per tick, {:.3g} MB, error {}", best.tick_ns,
                                      1e-6 * best.memory_bytes, percent(best.error));
  if (budget.max_tick_ns && best.tick_ns > *budget.max_tick_ns) return how + ": too slow";
  if (best.tick_ns > chosen.tick_ns + kAlikeNs) return how + ": more time per tick";
  return how +
         (best.memory_bytes > chosen.memory_bytes ? ": same time, more memory" : ": same time, more delay");
}

template <class Key>
std::vector<TickChoice> those(const std::vector<TickChoice>& all, Key key) {
  std::vector<TickChoice> some;
  std::ranges::copy_if(all, std::back_inserter(some), key);
  return some;
}

void add_other_readings(std::vector<std::string>& reasons, const TickChoice& chosen,
                        const std::vector<TickChoice>& all, const TickBudget& budget) {
  for (const auto& [word, kind] : kInterpolations) {
    const auto others = those(all, [kind = kind](const TickChoice& c) { return c.interpolation == kind; });
    if (kind == chosen.interpolation || others.empty()) continue;
    reasons.push_back(fmt::format("{}: {}", word, verdict_on(others, chosen, budget)));
  }
}

void add_other_inverses(std::vector<std::string>& reasons, const TickChoice& chosen,
                        const std::vector<TickChoice>& all, const TickBudget& budget) {
  std::set<std::uint16_t> counts;
  for (const TickChoice& choice : all) counts.insert(choice.inverse.taps);
  for (const std::uint16_t taps : counts) {
    if (taps == chosen.inverse.taps) continue;
    const auto others = those(all, [&](const TickChoice& c) {
      return c.inverse.taps == taps && c.interpolation == chosen.interpolation;
    });
    reasons.push_back(fmt::format(
        "{}: {}",
        taps == 1 ? words_of_inverse(others.front().inverse) : fmt::format("an inverse of {} taps", taps),
        verdict_on(others, chosen, budget)));
  }
}

std::string asked_for(const TickBudget& budget) {
  std::string asked = budget.by_error() ? "the smallest possible" : percent(budget.error.most_error());
  if (budget.max_tick_ns) asked += fmt::format(", {:.3g} ns per tick", *budget.max_tick_ns);
  return asked;
}

// RMS error of the place by looking ahead, m: with a delay d, a constant acceleration a gives an error of a
// d (d / 2 + t), where t is the delay of the tracker's speed (for an alpha-beta filter (alpha - beta / 2) /
// beta ticks; core FingerTracker). Valid for changes that are slow relative to both.
double missed_place_m(const UnsteadySpeed& hand, const PrepareOptions& options, double delay_s) {
  const double acceleration =
      std::numbers::sqrt2 * std::numbers::pi * hand.rate_hz * hand.part * hand.speed_mps;
  const double ahead_s = delay_s + options.loop_delay_s;
  if (!options.look_ahead) return hand.speed_mps * ahead_s;
  return acceleration * ahead_s * (ahead_s / 2 + speed_lag_s(options.rate_hz));
}

}  // namespace

double unsteady_speed_error(std::span<const PlacedTexture> textures, const UnsteadySpeed& hand,
                            const PrepareOptions& options, double delay_s) {
  double steepest = 0;
  for (const PlacedTexture& placed : textures)
    steepest = std::max(steepest, relative_slope(placed.texture->signal, options.band.low_hz / hand.speed_mps,
                                                 options.band.high_hz / hand.speed_mps));
  return steepest * missed_place_m(hand, options, delay_s);
}

std::string_view to_string(wire::Interpolation interpolation) {
  return std::ranges::find(kInterpolations, interpolation,
                           &std::pair<std::string_view, wire::Interpolation>::second)
      ->first;
}

std::optional<wire::Interpolation> interpolation_of(std::string_view word) {
  for (const auto& [name, kind] : kInterpolations)
    if (name == word) return kind;
  return std::nullopt;
}

std::string percent(double part) {
  return fmt::format("{:.3g} %", 100 * part);
}

std::string words_of_unsteady_speed(double error, const UnsteadySpeed& hand, double delay_s) {
  return fmt::format(
      "a hand at {:g} mm/s whose speed varies by {} at {:g} Hz adds an error of up to {:.2g} % (estimated, "
      "without the encoder's steps: look-ahead by the delay of {:.2g} ms)",
      1e3 * hand.speed_mps, percent(hand.part), hand.rate_hz, 100 * error, 1e3 * delay_s);
}

std::string percent_or_more(double part) {
  const double digit = std::pow(10, std::floor(std::log10(100 * part)) - 1);
  return fmt::format("{:.2g}%", digit * std::ceil(100 * part / digit));
}

std::string words_of(const TickChoice& choice) {
  return fmt::format("{}, {:.3g} samples per period, {}", to_string(choice.interpolation),
                     choice.samples_per_period, words_of_inverse(choice.inverse));
}

std::string limited_by(const TickChoice& choice) {
  if (choice.inverse.error > 0.5 * choice.error)
    return fmt::format("the inverse of the transducer leaves an error of {}", percent(choice.inverse.error));
  if (choice.reading_error > 0.25 * choice.error)
    return fmt::format("interpolation between samples leaves an error of {}", percent(choice.reading_error));
  return fmt::format("single precision leaves an error of {}", percent(kKernelsOwnError));
}

std::vector<std::string> reasons_for(const TickChoice& chosen, const std::vector<TickChoice>& all,
                                     const TickBudget& budget) {
  std::vector<std::string> reasons{
      fmt::format("{}: error at most {} (requested: {}), {:.3g} ns per tick, {:.3g} MB", words_of(chosen),
                  percent(chosen.error), asked_for(budget), chosen.tick_ns, 1e-6 * chosen.memory_bytes),
      fmt::format("parts of the error: inverse {}, interpolation {}, single precision {}",
                  percent(chosen.inverse.error),
                  percent(chosen.error - chosen.inverse.error - kKernelsOwnError),
                  percent(kKernelsOwnError))};
  add_other_readings(reasons, chosen, all, budget);
  add_other_inverses(reasons, chosen, all, budget);
  reasons.emplace_back(kNotPromised);
  return reasons;
}

}  // namespace tacto::playback
