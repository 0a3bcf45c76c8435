// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/choose/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "playback/choose/budget_words.hpp"
#include "playback/model/spatial_content.hpp"
#include "playback/prepare/pyramid_shape.hpp"
#include "playback/prepare/texture_layout.hpp"
#include "playback/prepare/undone_chain.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kOfWhatLiesBeyondTheBand = std::numbers::sqrt2;
constexpr double kAlikeError = 1.01;  // errors within a hundredth are equal
constexpr double kMostAsked = 0.1;    // the largest error that prepare() accepts of an inverse, too

using Choices = std::vector<TickChoice>;

Result<void> check_budget(const TickBudget& budget) {
  if (!budget.by_error() && !(budget.error.most_error() > 0 && budget.error.most_error() <= kMostAsked))
    return fail(ErrorKind::usage,
                fmt::format("the largest error {} is out of range", percent(budget.error.most_error())),
                "error budget", "choose above 0 and at most 10%");
  if (budget.max_tick_ns && !(*budget.max_tick_ns > 0))
    return fail(ErrorKind::usage, "the time of a tick has to be above 0", "time budget",
                "a tick takes about 100ns");
  return {};
}

// If the hysteresis stays, or its inverse is approximate, a part of the error cannot be predicted.
Result<void> check_hysteresis(const schema::Transducer& transducer, const PrepareOptions& options) {
  if (!transducer.hysteresis) return {};
  const auto refused = [](const char* what, const char* remedy) {
    return fail(ErrorKind::unsuitable, fmt::format("the error can't be predicted: {}", what), "transducer",
                remedy);
  };
  if (!options.undo_hysteresis)
    return refused("the bender's hysteresis is not inverted", "play without --keep-hysteresis");
  if (options.reconstruction != Reconstruction::none || transducer.reconstruction_cutoff_hz)
    return refused(
        "the filter behind the converter removes the corners of the drive that invert the hysteresis",
        "play without the filter, or without a budget");
  const auto play_operators =
      std::ranges::count_if(transducer.hysteresis->weights, [](double w) { return w > 0; });
  if (play_operators > static_cast<std::ptrdiff_t>(wire::kMaxPlays) + 1)
    return refused("its hysteresis has more play operators than the kernel can invert",
                   "identify it with fewer operators");
  return {};
}

/// The interpolations in the table with each density, and their cost. Those that need more memory than there
/// is are left out.
struct Readings {
  Choices choices;
  std::size_t least_samples = 0;  ///< the fewest of all, whether they fit or not
};

Readings readings_of(std::span<const PlacedTexture> textures, const PrepareOptions& options,
                     double passes_to_hz, const schema::TradeTable& table, bool keep_reading) {
  const schema::SpaceSignal path = one_period(textures, options.ends, options.seam_m);
  const double highest_per_m = highest_spatial_frequency(path);
  Readings readings;
  for (const schema::MeasuredChoice& measured : table.at("reading")) {
    const auto kind = interpolation_of(measured.name);
    if (!kind || (keep_reading && *kind != options.interpolation)) continue;
    for (const schema::ErrorPoint& point : measured.errors) {
      TickChoice choice{*kind, kStopOverPass * point.points_per_period, {}, point.error, 0, measured.cost_ns,
                        0};
      const std::size_t samples =
          pyramid_size(path, pyramid_shape(highest_per_m, passes_to_hz, choice.in(options)));
      choice.memory_bytes = static_cast<double>(samples * sizeof(float));
      readings.least_samples =
          readings.least_samples == 0 ? samples : std::min(readings.least_samples, samples);
      if (samples <= options.most_samples) readings.choices.push_back(choice);
    }
  }
  return readings;
}

double cost_of(const schema::TradeTable& table, const std::string& stage) {
  const auto measured = table.at(stage);
  return measured.empty() ? 0 : measured.front().cost_ns;
}

Choices all_choices(const Choices& readings, const std::vector<InverseChoice>& inverses,
                    bool undoes_hysteresis, const schema::TradeTable& table) {
  const double tap_ns = cost_of(table, "inverse");
  const double plays_ns = undoes_hysteresis ? cost_of(table, "hysteresis") : 0;
  Choices choices;
  for (const TickChoice& reading : readings)
    for (const InverseChoice& inverse : inverses) {
      TickChoice choice = reading;
      choice.inverse = inverse;
      choice.error = kOfWhatLiesBeyondTheBand * reading.reading_error + inverse.error + kKernelsOwnError;
      choice.tick_ns += tap_ns * inverse.taps + plays_ns;
      choices.push_back(choice);
    }
  return choices;
}

void keep_least(Choices& choices, double TickChoice::*member, double times, double plus) {
  const double least = (*std::ranges::min_element(choices, {}, member)).*member;
  std::erase_if(choices, [&](const TickChoice& choice) { return choice.*member > times * least + plus; });
}

Choices kept_by(const Choices& all, const TickBudget& budget, bool in_time) {
  Choices kept = all;
  std::erase_if(kept, [&](const TickChoice& choice) {
    return choice.error > budget.error.most_error() ||
           (in_time && budget.max_tick_ns && choice.tick_ns > *budget.max_tick_ns);
  });
  return kept;
}

tl::unexpected<schema::Error> no_room(const Readings& readings, const PrepareOptions& options) {
  if (readings.least_samples == 0)
    return fail(ErrorKind::unsuitable, "has none of this program's interpolations",
                "table of measured choices", "'tactograph trade --calibrate' measures them");
  return fail(ErrorKind::unsuitable,
              fmt::format("the texture needs at least {} samples, the memory holds {}",
                          readings.least_samples, options.most_samples),
              "texture", ways_to_fit(options.interpolation));
}

tl::unexpected<schema::Error> not_kept(const Choices& all, const TickBudget& budget) {
  if (const Choices slow = kept_by(all, budget, false); !slow.empty()) {
    const TickChoice best = best_of(slow, false);
    return fail(
        ErrorKind::unsuitable,
        fmt::format(
            "no choice keeps the error budget within {:.3g} ns per tick: the fastest needs {:.3g} ns ({})",
            *budget.max_tick_ns, best.tick_ns, words_of(best)),
        "time budget", "allow this time or a larger error, or use a lower rate");
  }
  const TickChoice best = best_of(all, true);
  return fail(
      ErrorKind::unsuitable,
      fmt::format("no choice has an error of at most {}: the smallest is {} ({}), because {}",
                  percent(budget.error.most_error()), percent(best.error), words_of(best), limited_by(best)),
      "error budget", fmt::format("use --max-error {} or more", percent_or_more(best.error)));
}

constexpr std::uint16_t kTapCounts[] = {8, 16, 24, 32, 48, 64, 96, 128};
constexpr double kDelaysS[] = {0.5e-3, 1e-3, 2e-3, 3e-3, 4e-3};

InverseChoice judged_choice(const UndoneChain& undone, const PrepareOptions& options) {
  const InverseFilter filter = inverse_of(undone, options);
  return {options.inverse, filter.delay_s, static_cast<std::uint16_t>(filter.taps.size()),
          largest_inverse_error(undone, filter)};
}

// The taps of a filter must extend beyond its delay.
bool reaches_answer(std::uint16_t taps, double delay_s, double rate_hz) {
  return taps > 1.25 * delay_s * rate_hz;
}

}  // namespace

PrepareOptions InverseChoice::in(PrepareOptions options) const {
  options.inverse = inverse;
  options.delay_s = delay_s;
  options.inverse_taps = taps;
  return options;
}

std::vector<InverseChoice> inverse_choices(const schema::Transducer& transducer,
                                           const PrepareOptions& options, bool keep_inverse) {
  const UndoneChain undone = undone_chain(transducer, options);
  PrepareOptions shaping = options, flat = options;
  if (!keep_inverse) shaping.inverse = Inverse::full, flat.inverse = Inverse::gain;
  const bool shapes = shaping.inverse == Inverse::full || shaping.inverse == Inverse::magnitude;
  std::vector<InverseChoice> choices;
  if (!keep_inverse || !shapes) choices.push_back(judged_choice(undone, flat));
  for (const std::uint16_t taps : kTapCounts)
    for (const double delay_s : kDelaysS)
      if (shapes && reaches_answer(taps, delay_s, options.rate_hz))
        choices.push_back(
            judged_choice(undone, InverseChoice{shaping.inverse, delay_s, taps, 0}.in(shaping)));
  return choices;
}

TickChoice best_of(std::vector<TickChoice> choices, bool most_exact) {
  if (most_exact) keep_least(choices, &TickChoice::error, kAlikeError, 0);
  keep_least(choices, &TickChoice::tick_ns, 1, kAlikeNs);
  keep_least(choices, &TickChoice::memory_bytes, 1, 0);
  return *std::ranges::min_element(
      choices, {}, [](const TickChoice& choice) { return std::pair(choice.inverse.delay_s, choice.error); });
}

PrepareOptions TickChoice::in(PrepareOptions options) const {
  if (inverse.taps > 0) options = inverse.in(options);
  options.interpolation = interpolation;
  options.samples_per_period = samples_per_period;
  return options;
}

Result<TickDecision> decide(std::span<const PlacedTexture> textures,
                            const std::vector<InverseChoice>& inverses, bool undoes_hysteresis,
                            const PrepareOptions& options, const TickBudget& budget,
                            const schema::FoundTradeTable& found) {
  TACTO_TRY(check_budget(budget));
  TACTO_TRY(check_prepare(textures, options));
  const double passes_to_hz = undone_chain({}, options).band.high_hz;
  const Readings readings = readings_of(textures, options, passes_to_hz, found.table, budget.keep_reading);
  if (readings.choices.empty()) return no_room(readings, options);
  const Choices all = all_choices(readings.choices, inverses, undoes_hysteresis, found.table);
  const Choices kept = kept_by(all, budget, true);
  if (kept.empty()) return not_kept(all, budget);
  TickDecision decision{best_of(kept, budget.by_error()), {}, found.origin, !budget.by_error()};
  decision.reasons = reasons_for(decision.chosen, all, budget);
  const double delay_s = decision.chosen.inverse.delay_s;
  decision.reasons.push_back(words_of_unsteady_speed(unsteady_speed_error(textures, {}, options, delay_s), {},
                                                     delay_s + options.loop_delay_s));
  return decision;
}

Result<TickDecision> decide(std::span<const PlacedTexture> textures, const schema::Transducer& transducer,
                            const PrepareOptions& options, const TickBudget& budget,
                            const schema::FoundTradeTable& found) {
  TACTO_TRY(check_prepare(textures, options));
  TACTO_TRY(check_hysteresis(transducer, options));
  const auto inverses =
      budget.filter ? std::vector{*budget.filter} : inverse_choices(transducer, options, budget.keep_inverse);
  return decide(textures, inverses, undoes_hysteresis(transducer, options), options, budget, found);
}

Result<double> tick_cost_ns(const schema::TradeTable& table, wire::Interpolation interpolation,
                            std::size_t taps, bool undoes_hysteresis) {
  for (const schema::MeasuredChoice& measured : table.at("reading"))
    if (interpolation_of(measured.name) == interpolation)
      return measured.cost_ns + cost_of(table, "inverse") * static_cast<double>(taps) +
             (undoes_hysteresis ? cost_of(table, "hysteresis") : 0);
  return fail(ErrorKind::unsuitable, fmt::format("has no cost of {}", to_string(interpolation)),
              "table of measured choices", "'tactograph trade --calibrate' measures it");
}

}  // namespace tacto::playback
