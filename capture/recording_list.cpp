// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/recording_list.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "data-schema/file_kind.hpp"

namespace tacto::capture {
namespace {

namespace fs = std::filesystem;
using schema::Fault;
using schema::Result;

constexpr std::string_view kEvents = ".events.jsonl";

std::string without(const std::string& text, std::size_t ending) {
  return text.substr(0, text.size() - ending);
}

// A sidecar that is broken shows itself by the WAV beside it; other JSON is none of ours.
void add_sidecar(const std::string& path, std::vector<ListedRecording>& list) {
  const auto files = schema::stored_files(path);
  const std::string stem = without(path, 5);
  std::error_code ignored;
  if (!files && !fs::exists(stem + ".wav", ignored)) return;
  if (files && files->front().kind != schema::FileKind::recording) return;
  auto recording = schema::open_recording(path);
  if (recording)
    list.push_back({stem, std::move(recording->header), 1, ""});
  else
    list.push_back({stem, {}, 0, schema::message(recording.error())});
}

auto by_subject_and_surface(const ListedRecording& one) {
  return std::tuple(!one.trouble.empty(), one.header.subject, one.header.surface, one.header.created,
                    one.stem);
}

void count_takes(std::vector<ListedRecording>& list) {
  for (std::size_t i = 1; i < list.size(); ++i) {
    const ListedRecording& before = list[i - 1];
    const bool same = before.header.subject == list[i].header.subject &&
                      before.header.surface == list[i].header.surface && list[i].trouble.empty();
    if (same) list[i].take = before.take + 1;
  }
}

}  // namespace

Result<std::vector<ListedRecording>> list_recordings(const std::string& folder) {
  std::error_code failed;
  std::vector<ListedRecording> list;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    const std::string path = folder == "." ? at->path().filename().string() : at->path().string();
    if (path.ends_with(kEvents))
      list.push_back({without(path, kEvents.size()),
                      {},
                      0,
                      "never closed, or still being recorded: see 'tactograph recover'"});
    else if (path.ends_with(".json"))
      add_sidecar(path, list);
  }
  if (failed) return schema::fail(Fault::not_found, "can't be listed: " + failed.message(), folder);
  std::ranges::sort(list, {}, by_subject_and_surface);
  count_takes(list);
  return list;
}

}  // namespace tacto::capture
