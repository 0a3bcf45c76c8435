// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "capture/cli/verbs.hpp"
#include "capture/record/store_strokes.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/files/leftover_files.hpp"
#include "data-schema/recording/live_recording.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::capture {
namespace {

std::vector<std::string> lines_on(const std::vector<schema::Leftover>& removed) {
  std::vector<std::string> lines;
  for (const schema::Leftover& one : removed)
    lines.push_back(fmt::format("{}, {} bytes", one.path, one.bytes));
  return lines;
}

cli::Report report_on(const schema::Recovered& recovered) {
  const schema::RecordingHeader& header = recovered.recording.header;
  const std::string& stem = recovered.recording.stem;
  cli::Report report;
  report.add("recording", stem).add("frames", header.frames);
  report.add("duration_s", static_cast<double>(header.frames) / header.sample_rate_hz);
  report.add("gaps", header.gaps.size())
      .add("marks", header.marks.size())
      .add("faults", header.faults.size());
  if (!recovered.notes.empty()) report.add("notes", recovered.notes);
  report.add("files", std::vector{stem + ".wav", stem + ".json"});
  return report;
}

// A killed run may have left only temporary files. Their removal is then complete recovery.
cli::Report report_on_nothing() {
  return cli::Report().add("recording", "no recording was found that needs recovery");
}

schema::Result<cli::Report> run_recover(const std::string& name) {
  const std::string stem = schema::stem_of(name, "");
  const auto removed = schema::remove_ended(schema::leftovers_of(stem));
  auto recovered = schema::recover_recording(name);
  if (recovered) TACTO_TRY(store_strokes(recovered->recording));
  const bool nothing_else = !removed.empty() && !schema::is_file(stem + ".events.jsonl");
  if (!recovered && !nothing_else) return schema::forward_error(recovered);
  cli::Report report = recovered ? report_on(*recovered) : report_on_nothing();
  if (!removed.empty()) report.add("removed_temporary_files", lines_on(removed));
  return recovered ? report.add("next", "tactograph validate " + cli::shell_word(recovered->recording.stem))
                   : report;
}

cli::Action declare_recover(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  app.add_option("FILE", *name, "The interrupted recording, by its stem or one of its files")->required();
  app.footer(app.get_footer() +
             "\nIt also removes hidden temporary files (.NAME...tmp) of killed runs with this name.");
  return [name] { return run_recover(*name); };
}

}  // namespace

const cli::Verb kRecoverVerb{"recover",
                             "Complete a recording that was interrupted by a crash, a kill or a power cut",
                             "tactograph recover oak", declare_recover};

}  // namespace tacto::capture
