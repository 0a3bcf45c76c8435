// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/results/trade_table.hpp"

namespace tacto::schema {

Result<cli::Report> describe_trade(const std::string& path) {
  const auto file = read_trade_table(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::trade, path, {});
  add_text(report, "machine", file->machine);
  add_text(report, "created", file->created);
  add_text(report, "creator", file->creator);
  std::vector<cli::Report> rows;
  for (const MeasuredChoice& choice : file->choices)
    rows.push_back(cli::Report()
                       .add("stage", choice.stage)
                       .add("choice", choice.name)
                       .add("per", choice.per)
                       .add("cost_ns", choice.cost_ns)
                       .add("error_at_10_points", choice.error_at(10)));
  return report.add("choices", std::move(rows));
}

}  // namespace tacto::schema
