// SPDX-License-Identifier: GPL-3.0-or-later
// --quality, --max-error and --explain, the same in every verb that has them.
#pragma once

#include <string>

#include "data-schema/command/verb.hpp"
#include "data-schema/results/budget.hpp"

namespace tacto::cli {

struct BudgetOptions {
  schema::Budget budget;
  bool explain = false;
};

/// `chosen` describes for the help what the budget chooses. Both must outlive the parser.
void declare_budget(CLI::App& app, BudgetOptions& options, const std::string& chosen);

}  // namespace tacto::cli
