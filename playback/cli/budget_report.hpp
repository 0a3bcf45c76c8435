// SPDX-License-Identifier: GPL-3.0-or-later
// The decision of a budget in the reports of play and render.
#pragma once

#include "data-schema/command/budget_options.hpp"
#include "playback/choose/budget.hpp"

namespace tacto::playback {

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
