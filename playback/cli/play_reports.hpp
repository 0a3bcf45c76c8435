// SPDX-License-Identifier: GPL-3.0-or-later
// What several verbs report of a playback: gain, loop, limits, the decision of a budget.
#pragma once

#include <optional>

#include "data-schema/command/budget_options.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/texture/texture.hpp"
#include "playback/choose/budget.hpp"
#include "playback/model/gain_sign.hpp"
#include "playback/model/limit_tally.hpp"

namespace tacto::playback {

/// Adds `removed_by_limits_db` and in how many ticks each limit acted; or `removed_by_limits`: none, or
/// unknown.
void add_removed(cli::Report& report, const std::optional<LimitTally>& limits);

/// Adds `loop_period_m` and `loop_seam_m`; nothing if there is no loop (a period of 0).
inline void add_loop(cli::Report& report, double period_m, double seam_m) {
  if (period_m > 0) report.add("loop_period_m", period_m).add("loop_seam_m", seam_m);
}

/// How the help of --gain ends.
inline constexpr const char* kDefaultGain = "; default: the gain in the texture's file, or 1mm/N";

/// Adds `gain_m_per_n`; `gain_times_default` if it is another than the default; `inverts_texture` if it
/// is below 0.
inline void add_gain(cli::Report& report, double gain_m_per_n, double default_m_per_n) {
  report.add("gain_m_per_n", gain_m_per_n);
  if (gain_m_per_n != default_m_per_n && default_m_per_n != 0)
    report.add("gain_times_default", gain_m_per_n / default_m_per_n);
  tell_inversion(gain_m_per_n, [&](const char* key, bool value) { report.add(key, value); });
}

/// Adds `gain_set_by` and `gain_set_on` if the gain is stored with the texture.
inline void add_kept_gain(cli::Report& report, const std::optional<schema::PlaybackGain>& kept) {
  if (!kept) return;
  report.add("gain_set_by", kept->who.empty() ? "unknown" : kept->who);
  if (!kept->when.empty()) report.add("gain_set_on", kept->when);
}

/// The options --quality, --max-error and --max-tick.
struct AskedBudget {
  cli::BudgetOptions options;
  std::optional<double> max_tick_s;
  /// The verb's --inverse and --interpolation, if make_program() does not get them: a given option is kept.
  CLI::Option *inverse = nullptr, *reading = nullptr;

  /// Errors: usage, for --explain without a budget.
  schema::Result<TickBudget> budget() const;
};

/// `asked` must outlive the parser.
void declare_tick_budget(CLI::App& app, AskedBudget& asked);

/// What was chosen; with `explain` also the reasons and the table.
void add_decision(cli::Report& report, const TickDecision& decision, bool explain);

}  // namespace tacto::playback
