// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <filesystem>
#include <memory>

#include "capture/cli/verbs.hpp"
#include "capture/record/recording_list.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::capture {
namespace {

std::uint64_t missing_frames(const schema::RecordingHeader& header) {
  std::uint64_t missing = 0;
  for (const schema::Gap& gap : header.gaps) missing += gap.count;
  return missing;
}

bool in_both_bands(const schema::StrokeFigures& stroke) {
  return schema::kTargetSpeed_mps.holds(stroke.mean_speed_mps) &&
         (!stroke.mean_normal_n || schema::kTargetLoad_n.holds(*stroke.mean_normal_n));
}

// Figures of the strokes that the sidecar stores.
void add_strokes(cli::Report& row, const schema::RecordingHeader& header) {
  if (header.strokes.empty()) return;
  const auto count = static_cast<double>(header.strokes.size());
  double speed_mps = 0, normal_n = 0;
  std::uint64_t clipped = 0;
  for (const schema::StrokeFigures& stroke : header.strokes) {
    speed_mps += stroke.mean_speed_mps / count;
    normal_n += stroke.mean_normal_n.value_or(0) / count;
    clipped += stroke.clipped_samples;
  }
  row.add("strokes", header.strokes.size());
  row.add("in_band", std::ranges::count_if(header.strokes, in_both_bands));
  row.add("mean_speed_mps", speed_mps);
  if (header.strokes.front().mean_normal_n) row.add("mean_normal_n", normal_n);
  row.add("clipped_samples", clipped);
}

cli::Report row_of(const ListedRecording& one) {
  const schema::RecordingHeader& header = one.header;
  const std::uint64_t missing = missing_frames(header);
  cli::Report row;
  row.add("subject", header.subject).add("surface", header.surface);
  if (one.take) row.add("take", *one.take);
  row.add("name", std::filesystem::path(one.stem).filename().string()).add("finger", header.finger);
  row.add("duration_s", schema::duration_s(header));
  add_strokes(row, header);
  row.add("lost_frames", missing).add("gaps", header.gaps.size()).add("marks", header.marks.size());
  return row.add("created", header.created).add("ended", header.ended);
}

schema::Result<cli::Report> run_list(const std::string& folder) {
  const auto list = list_recordings(folder);
  TACTO_TRY(list);
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

cli::Action declare_list(CLI::App& app) {
  auto folder = std::make_shared<std::string>(".");
  app.add_option("FOLDER", *folder, "Folder of the recordings");
  cli::explain_strokes(app);
  return [folder] { return run_list(*folder); };
}

}  // namespace

const cli::Verb kListVerb{"list", "List the recordings of a folder by subject, surface and date",
                          "tactograph list\n  tactograph list study-3 --json", declare_list};

}  // namespace tacto::capture
