// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>

#include "analysis/cli/verbs.hpp"
#include "analysis/extremes/extreme.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::analysis {
namespace {

struct ExtremesOptions {
  bool all = false;
};

// An error of 0 has no margin in dB.
double margin_of(const Extreme& extreme) {
  return extreme.error > 0 && extreme.most > 0 ? extreme.margin_db() : std::nan("");
}

cli::Report row_of_extreme(const Extreme& extreme) {
  cli::Report row;
  row.add("room", extreme.room).add("condition", extreme.condition);
  row.add("error", extreme.error).add("most", extreme.most).add("margin_db", margin_of(extreme));
  row.add("holds", extreme.holds());
  return row.add("reference", extreme.reference).add("note", extreme.note);
}

schema::Result<cli::Report> try_extremes(const ExtremesOptions& options) {
  cli::Progress progress("extremes");
  const auto extremes = all_extremes(options.all, [&](double part) { progress.update(part); });
  std::vector<cli::Report> rows;
  std::size_t broken = 0;
  for (const Extreme& extreme : extremes) {
    rows.push_back(row_of_extreme(extreme));
    broken += !extreme.holds();
  }
  cli::Report report;
  report.add("extremes", std::move(rows)).add("conditions", extremes.size()).add("broken", broken);
  if (broken > 0) report.ends_with(schema::ErrorKind::unsuitable);
  return report;
}

cli::Action declare_extremes(CLI::App& app) {
  auto options = std::make_shared<ExtremesOptions>();
  app.add_flag("--all", options->all, "Also test a stroke of 1e8 samples (a minute more)");
  return [options] { return try_extremes(*options); };
}

}  // namespace

const cli::Verb kExtremesVerb{
    "extremes",
    "Test the methods of all modules with extreme input, each against an exact result, and print the errors",
    "tactograph extremes\n  tactograph extremes --all --json > extremes.json", declare_extremes};

}  // namespace tacto::analysis
