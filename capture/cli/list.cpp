// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <tuple>
#include <vector>

#include "capture/cli/verbs.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/report/report.hpp"

namespace tacto::capture {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;

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
void add_stroke_figures(cli::Report& row, const schema::RecordingHeader& header) {
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

struct ListedRecording {
  std::string stem;
  schema::RecordingHeader header;
  std::optional<int> take;  // the number at the end of its name, as in S01_oak_2
  std::string trouble;  // the reason why it cannot be opened, or that it was never closed; otherwise empty
};

constexpr std::string_view kEvents = ".events.jsonl";

std::string without(const std::string& text, std::size_t ending) {
  return text.substr(0, text.size() - ending);
}

// "S01_oak_2": 2. A count of the recordings would change when a take is removed.
std::optional<int> take_of(const std::string& stem) {
  const auto bar = stem.find_last_of("_-");
  if (bar == std::string::npos || bar + 1 == stem.size()) return std::nullopt;
  const char* const end = stem.data() + stem.size();
  int take = 0;
  const auto [stopped, failed] = std::from_chars(stem.data() + bar + 1, end, take);
  return failed == std::errc() && stopped == end ? std::optional(take) : std::nullopt;
}

// A damaged sidecar is recognised by the WAV beside it; other JSON files are not recordings.
void add_sidecar(const std::string& path, std::vector<ListedRecording>& list) {
  const auto files = schema::stored_files(path);
  const std::string stem = without(path, 5);
  std::error_code ignored;
  if (!files && !fs::exists(stem + ".wav", ignored)) return;
  if (files && files->front().kind != schema::FileKind::recording) return;
  auto recording = schema::open_recording(path);
  if (recording)
    list.push_back({stem, std::move(recording->header), take_of(stem), ""});
  else
    list.push_back({stem, {}, {}, schema::message(recording.error())});
}

auto by_subject_and_surface(const ListedRecording& one) {
  return std::tuple(!one.trouble.empty(), one.header.subject, one.header.surface, one.header.created,
                    one.stem);
}

// All recordings in a folder, without its subfolders, by subject, surface and date; those with trouble last,
// by name. Files of other kinds are skipped. Errors: not_found.
Result<std::vector<ListedRecording>> list_recordings(const std::string& folder) {
  std::error_code failed;
  std::vector<ListedRecording> list;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string path = folder == "." ? at->path().filename().string() : at->path().string();
    if (path.ends_with(kEvents))
      list.push_back({without(path, kEvents.size()),
                      {},
                      {},
                      "not closed, or still being recorded: see 'tactograph recover'"});
    else if (path.ends_with(".json"))
      add_sidecar(path, list);
  }
  if (failed) return schema::fail(ErrorKind::not_found, "cannot be listed: " + failed.message(), folder);
  std::ranges::sort(list, {}, by_subject_and_surface);
  return list;
}

cli::Report row_of(const ListedRecording& one) {
  const schema::RecordingHeader& header = one.header;
  const std::uint64_t missing = missing_frames(header);
  cli::Report row;
  row.add("subject", header.subject).add("surface", header.surface);
  if (one.take) row.add("take", *one.take);
  row.add("name", std::filesystem::path(one.stem).filename().string()).add("finger", header.finger);
  row.add("duration_s", schema::duration_s(header));
  add_stroke_figures(row, header);
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
