// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/command/budget_options.hpp"

#include <fmt/format.h>

namespace tacto::cli {
namespace {

// CLI11's callbacks report a wrong value by an exception.
double share_above_nothing(const std::string& text) {
  const auto share = schema::parse_quantity(text, schema::Dimension::share);
  if (!share) throw CLI::ValidationError("--max-error", schema::message(share.error()));
  if (!(*share > 0)) throw CLI::ValidationError("--max-error", fmt::format("'{}' is not above 0", text));
  return *share;
}

}  // namespace

void declare_budget(CLI::App& app, BudgetOptions& options, const std::string& chosen) {
  using schema::Quality;
  auto* quality = add_choice<std::optional<Quality>>(
      app, "--quality", options.budget.quality,
      {{"fast", Quality::fast}, {"balanced", Quality::balanced}, {"exact", Quality::exact}},
      fmt::format("Choose {} by measured errors: the fastest with at most 1 % (fast) or 0.1 % (balanced) of "
                  "the RMS, or that with the smallest error (exact). Given options are not changed",
                  chosen));
  auto* most = app.add_option_function<std::string>(
      "--max-error",
      [&options](const std::string& text) { options.budget.max_error = share_above_nothing(text); },
      "The same for another largest error, for example 0.1% of the RMS");
  most->type_name(fmt::format("NUMBER+UNIT({})", schema::units_of(schema::Dimension::share)))
      ->excludes(quality);
  app.add_flag("--explain", options.explain,
               "Report the choice of --quality or --max-error, its reason, and its table");
}

}  // namespace tacto::cli
