// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/results/results.hpp"

namespace tacto::schema {

Result<cli::Report> describe_results(const std::string& path) {
  const auto file = read_results(path);
  TACTO_TRY(file);
  warn_of_unknown(path, *file);
  cli::Report report = report_of(FileKind::results, path, file->simulated);
  report.add("verb", file->verb).add("inputs", file->inputs);
  add_text(report, "device", file->device);
  add_text(report, "created", file->created);
  add_text(report, "creator", file->creator);
  std::vector<cli::Report> rows;
  for (const ResultFigure& figure : file->figures)
    rows.push_back(cli::Report().add("name", figure.name).add("value", figure.value));
  return report.add("figures", std::move(rows));
}

}  // namespace tacto::schema
