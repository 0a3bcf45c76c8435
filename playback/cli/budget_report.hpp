// SPDX-License-Identifier: GPL-3.0-or-later
// A budget's decision for people: what play and render say of it.
#pragma once

#include "data-schema/cli/budget_options.hpp"
#include "playback/budget.hpp"

namespace tacto::playback {

/// What --quality, --max-error and --max-tick are, on the command line.
struct AskedBudget {
  cli::BudgetOptions options;
  std::optional<double> max_tick_s;
  CLI::Option* inverse = nullptr;  ///< the verb's --inverse: where it was given, it stays

  /// Errors: usage, for --explain with nothing to explain.
  schema::Result<TickBudget> budget() const;
};

/// `inverse` is the verb's own option. `asked` must outlive the parser.
void declare_tick_budget(CLI::App& app, AskedBudget& asked, CLI::Option* inverse);

/// What was chosen; with `explain` also why, and by which table.
void add_decision(cli::Report& report, const TickDecision& decision, bool explain);

}  // namespace tacto::playback
