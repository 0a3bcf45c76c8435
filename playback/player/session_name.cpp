// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/session_name.hpp"

#include <fmt/format.h>

#include <ctime>
#include <filesystem>

#include "data-schema/files/files.hpp"
#include "data-schema/session/session.hpp"

namespace tacto::playback {

std::string dated_session(const std::string& before) {
  std::tm parts{};
  const std::time_t now = std::time(nullptr);
  gmtime_r(&now, &parts);
  char date[32];
  std::strftime(date, sizeof date, "%Y%m%dT%H%M%SZ", &parts);
  const std::string stem = before + date;
  std::string path = schema::session_path(stem);
  for (int i = 2; schema::is_file(path); ++i) path = schema::session_path(fmt::format("{}-{}", stem, i));
  return path;
}

std::string session_named_after(const std::string& played) {
  std::string name = std::filesystem::path(played).filename().string();
  for (const std::string_view kind : {".texture", ".scene"}) name = schema::stem_of(name, kind);
  return dated_session(name + "-");
}

}  // namespace tacto::playback
