// SPDX-License-Identifier: GPL-3.0-or-later
// A budget's decision for people: what play and render say of it.
#pragma once

#include "data-schema/command/budget_options.hpp"
#include "playback/choose/budget.hpp"

namespace tacto::playback {

/// What --quality, --max-error and --max-tick are, on the command line.
struct AskedBudget {
  cli::BudgetOptions options;
  std::optional<double> max_tick_s;
  /// The verb's --inverse and --interpolation, where make_program() is not told of them: what was given
  /// stays.
  CLI::Option *inverse = nullptr, *reading = nullptr;

  /// Errors: usage, for --explain with nothing to explain.
  schema::Result<TickBudget> budget() const;
};

/// `asked` must outlive the parser.
void declare_tick_budget(CLI::App& app, AskedBudget& asked);

/// What was chosen; with `explain` also why, and by which table.
void add_decision(cli::Report& report, const TickDecision& decision, bool explain);

}  // namespace tacto::playback
