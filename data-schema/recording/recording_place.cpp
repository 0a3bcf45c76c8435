// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/recording_place.hpp"

#include <filesystem>
#include <system_error>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/files/event_file.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording_json.hpp"
#include "data-schema/version.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kEventsEnding = ".events.jsonl";

}  // namespace

std::string events_path(const std::string& stem) {
  return stem + std::string(kEventsEnding);
}

std::string recording_stem_of(const std::string& name) {
  return name.ends_with(kEventsEnding) ? name.substr(0, name.size() - kEventsEnding.size())
                                       : stem_of(name, "");
}

Result<void> check_free(const std::string& stem) {
  std::error_code ignored;
  for (const std::string& path : {stem + ".json", stem + ".wav", events_path(stem)})
    if (std::filesystem::exists(path, ignored))
      return fail(ErrorKind::usage, "exists already, and is not overwritten", path, "choose another name");
  return {};
}

Result<void> check_storable(const RecordingHeader& header) {
  RecordingHeader complete = header;
  complete.sha256 = std::string(64, '0');
  complete.gaps.clear();  // they would be checked against frames that do not exist yet
  const auto text = recording_text(complete);
  return text ? Result<void>{} : forward_error(text);
}

Result<void> write_sidecar(const Recording& recording) {
  const auto text = recording_text(recording.header);
  TACTO_TRY(text);
  const std::string path = recording.stem + ".json";
  PendingFiles pending;
  TACTO_TRY(pending.write(path, *text));
  TACTO_TRY(pending.commit());
  return sync_path(folder_of(path));
}

Result<std::string> completed_sidecar(RecordingHeader& header, const std::string& wav) {
  const auto sum = sha256_of_file(wav);
  TACTO_TRY(sum);
  header.sha256 = *sum;
  header.created = creation_time();
  header.creator = kCreator;
  return recording_text(header);
}

}  // namespace tacto::schema
