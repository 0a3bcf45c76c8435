// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/play_reports.hpp"

#include "playback/choose/budget_words.hpp"

namespace tacto::playback {

void add_removed(cli::Report& report, const std::optional<LimitTally>& limits) {
  if (!limits) {
    report.add("removed_by_limits", "unknown");
    return;
  }
  if (limits->removed_any())
    report.add("removed_by_limits_db", limits->removed_db());
  else
    report.add("removed_by_limits", "none");
  report.add("amplitude_limited_ticks", limits->amplitude_limited())
      .add("slew_limited_ticks", limits->slew_limited());
}

schema::Result<TickBudget> AskedBudget::budget() const {
  TickBudget budget{options.budget,
                    {},
                    inverse != nullptr && inverse->count() > 0,
                    reading != nullptr && reading->count() > 0,
                    {}};
  if (max_tick_s) budget.max_tick_ns = 1e9 * *max_tick_s;
  if (options.explain && !budget.asked())
    return schema::fail(schema::ErrorKind::usage, "there is no choice to explain", "--explain",
                        "add --quality, --max-error or --max-tick");
  return budget;
}

void declare_tick_budget(CLI::App& app, AskedBudget& asked) {
  cli::declare_budget(app, asked.options, "interpolation, levels' density and the inverse's length");
  cli::add_quantity(
      app, "--max-tick", asked.max_tick_s, schema::Dimension::time,
      "Largest CPU time per tick, by the table of measured choices; alone: the smallest error within it");
}

void add_decision(cli::Report& report, const TickDecision& decision, bool explain) {
  report.add("chosen", words_of(decision.chosen))
      .add(decision.promised ? "guaranteed_error_percent" : "least_error_percent",
           100 * decision.chosen.error)
      .add("which_is", "at constant speed and exact position; --explain lists further errors")
      .add("tick_s", 1e-9 * decision.chosen.tick_ns);
  if (!explain) return;
  std::vector<cli::Report> reasons;
  for (const std::string& line : decision.reasons) reasons.push_back(cli::Report().add("reason", line));
  report.add("by_table", decision.table).add("why", std::move(reasons));
}

}  // namespace tacto::playback
