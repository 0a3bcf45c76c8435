// SPDX-License-Identifier: GPL-3.0-or-later
// --quality, --max-error and --explain, alike in every verb that chooses by them.
#pragma once

#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/results/budget.hpp"

namespace tacto::cli {

struct BudgetOptions {
  schema::Budget budget;
  bool explain = false;
};

/// `chosen` says in words what the budget chooses, for the help. Both must outlive the parser.
void declare_budget(CLI::App& app, BudgetOptions& options, const std::string& chosen);

}  // namespace tacto::cli
