// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/describe.hpp"
#include "data-schema/corpus/corpus_plan.hpp"

namespace tacto::schema {

Result<cli::Report> describe_corpus(const std::string& path) {
  const auto plan = read_corpus_plan(path);
  TACTO_TRY(plan);
  warn_of_unknown(path, *plan);
  cli::Report report = report_of(FileKind::corpus, path, "");
  add_text(report, "created", plan->created);
  add_text(report, "creator", plan->creator);
  report.add("recordings", plan->recordings.size());
  std::vector<cli::Report> rows;
  for (const CorpusStep& step : plan->steps)
    rows.push_back(cli::Report().add("step", step.step).add("options", step.options));
  return report.add("steps", std::move(rows));
}

}  // namespace tacto::schema
