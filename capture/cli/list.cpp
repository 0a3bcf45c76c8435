// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <memory>

#include "capture/cli/verbs.hpp"
#include "capture/recording_list.hpp"
#include "data-schema/cli/report.hpp"

namespace tacto::capture {
namespace {

std::uint64_t missing_frames(const schema::RecordingHeader& header) {
  std::uint64_t missing = 0;
  for (const schema::Gap& gap : header.gaps) missing += gap.count;
  return missing;
}

cli::Report row_of(const ListedRecording& one) {
  const schema::RecordingHeader& header = one.header;
  const std::uint64_t missing = missing_frames(header);
  cli::Report row;
  row.add("subject", header.subject).add("surface", header.surface).add("take", one.take);
  row.add("name", std::filesystem::path(one.stem).filename().string()).add("finger", header.finger);
  row.add("duration_s", static_cast<double>(header.frames + missing) / header.sample_rate_hz);
  row.add("gaps", header.gaps.size()).add("marks", header.marks.size());
  return row.add("created", header.created).add("ended", header.ended);
}

schema::Result<cli::Report> run(const std::string& folder) {
  const auto list = list_recordings(folder);
  if (!list) return schema::forward_error(list);
  std::vector<cli::Report> rows, troubled;
  for (const ListedRecording& one : *list)
    if (one.trouble.empty())
      rows.push_back(row_of(one));
    else
      troubled.push_back(cli::Report().add("name", one.stem).add("trouble", one.trouble));
  cli::Report report;
  report.add("folder", folder).add("recordings", rows.size());
  if (!rows.empty()) report.add("list", std::move(rows));
  if (!troubled.empty()) report.add("in_trouble", std::move(troubled));
  return report;
}

cli::Action declare(CLI::App& app) {
  auto folder = std::make_shared<std::string>(".");
  app.add_option("FOLDER", *folder, "Where the recordings are");
  return [folder] { return run(*folder); };
}

}  // namespace

const cli::Verb kListVerb{"list", "Table the recordings of a folder by subject, surface and take",
                          "tactograph list\n  tactograph list study-3 --json", declare};

}  // namespace tacto::capture
