// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/recording_list.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <tuple>

#include "data-schema/kinds/file_kind.hpp"

namespace tacto::capture {
namespace {

namespace fs = std::filesystem;
using schema::ErrorKind;
using schema::Result;

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

}  // namespace

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

}  // namespace tacto::capture
