// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>

#include "analysis/cli/results_output.hpp"
#include "analysis/cli/verbs.hpp"
#include "analysis/report/project.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/progress.hpp"

namespace tacto::analysis {
namespace {

using cli::Report;
using schema::Result;

struct ReportVerbOptions {
  std::string folder, output;
  schema::Existing existing = schema::Existing::keep;
};

Report file_row(const ProjectFile& file) {
  Report row;
  row.add("file", file.path).add("kind", schema::kind_name(file.kind)).add("date", file.date);
  return row.add("source", file.origin)
      .add("simulated", !file.simulated.empty())
      .add("sha256", file.checksum);
}

Report project_report(const Project& project, const std::string& output) {
  Report report;
  std::vector<Report> rows, broken;
  for (const ProjectFile& file : project.files) rows.push_back(file_row(file));
  report.add("files", std::move(rows)).add("page", output);
  for (const BrokenFile& file : project.broken)
    broken.push_back(Report().add("file", file.path).add("fault", schema::message(file.error)));
  if (project.broken.empty()) return report;
  report.add("broken", std::move(broken)).ends_with(project.broken.front().error.kind);
  return report;
}

// The first names only; the page has all of them.
std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 6;
  const std::span shown(names.data(), std::min(kNamed, names.size()));
  const std::string words = fmt::format("{}", fmt::join(shown, ", "));
  return names.size() <= kNamed ? words : fmt::format("{}, and {} others", words, names.size() - kNamed);
}

void tell(const Project& project) {
  for (const BrokenFile& file : project.broken) cli::warn("left out: " + schema::message(file.error));
  if (!project.foreign.empty())
    cli::warn("not described on the page, only named: " + some_of(project.foreign));
}

Result<void> write_page(const Project& project, const ReportVerbOptions& o) {
  schema::PendingFiles files;
  if (auto written = files.write(o.output, project_page(project)); !written) return written;
  return files.commit(o.existing);
}

Result<Report> run_report(const ReportVerbOptions& o) {
  if (!o.output.ends_with(".html"))
    return schema::fail(schema::ErrorKind::usage, "doesn't end in .html", o.output,
                        "a report is an HTML page");
  TACTO_TRY(check_outputs({o.output}, o.existing));
  cli::Progress progress("reading");
  auto project = read_project(o.folder, o.output, [&](double part) { progress.update(part); });
  TACTO_TRY(project);
  draw_pictures(*project);
  tell(*project);
  TACTO_TRY(write_page(*project, o));
  return project_report(*project, o.output);
}

cli::Action declare_report(CLI::App& app) {
  auto options = std::make_shared<ReportVerbOptions>();
  options->output = "report.html";
  app.add_option("FOLDER", options->folder,
                 "A project: recordings, textures, transducers, sessions, results ...")
      ->required();
  app.add_option("-o,--output", options->output, "The page: NAME.html")->capture_default_str();
  cli::declare_force(app, options->existing);
  return [options] { return run_report(*options); };
}

}  // namespace

const cli::Verb kReportVerb{"report",
                            "Describe all files of a folder on one page: origin, main figures and pictures",
                            "tactograph report study -o study.html", declare_report};

}  // namespace tacto::analysis
