// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/report/project_file.hpp"

#include <fmt/format.h>

#include "analysis/report/project_readers.hpp"
#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/texture/texture_wav.hpp"
#include "playback/session/session_rows.hpp"

namespace tacto::analysis {
namespace {

using schema::FileKind;
using schema::Result;

constexpr double kChecked = 0.5;  // share of the time for one file

// The samples' path for recordings and textures, the file itself for other kinds.
std::string data_path(const schema::StoredFile& file) {
  if (file.kind == FileKind::recording)
    if (const auto recording = schema::open_recording(file.path)) return schema::wav_path(*recording);
  if (file.kind == FileKind::texture)
    if (const auto wav = schema::texture_wav(file.path)) return wav->path;
  return file.path;
}

Result<void> check(const schema::StoredFile& file, const Progress& progress) {
  const auto checked = schema::check_file(file, progress);
  TACTO_TRY(checked);
  if (checked->findings.empty()) return {};
  const auto& [where, what] = checked->findings.front();
  const std::size_t more = checked->findings.size() - 1;
  return schema::fail(schema::ErrorKind::malformed,
                      more == 0 ? what : fmt::format("{}, and {} more faults", what, more), where,
                      "'tactograph validate' lists all");
}

}  // namespace

Result<void> read_into(const std::string& path, FileKind kind, ProjectFile& file, const Progress& progress) {
  switch (kind) {
    case FileKind::recording:
      return add_recording(path, file, progress);
    case FileKind::texture:
      return add_texture_file(path, file);
    case FileKind::transducer:
      return add_transducer(path, file);
    case FileKind::spectrogram:
      return add_spectrogram(path, file);
    case FileKind::formants:
      return add_formants(path, file);
    case FileKind::descriptions:
      return add_descriptions(path, file);
    case FileKind::calibration:
      return add_calibration(path, file);
    case FileKind::scene:
      return add_scene(path, file);
    case FileKind::session:
      return add_session(path, file, progress);
    case FileKind::session_table:
      return add_session_table(path, file);
    case FileKind::height_map:
      return add_height_map(path, file);
    case FileKind::mesh:
      return add_mesh(path, file);
    case FileKind::volume:
      return add_volume(path, file);
    case FileKind::trade:
      return add_trade_table(path, file);
    case FileKind::corpus:
      return add_corpus_plan(path, file);
    case FileKind::protocol:
      return add_protocol(path, file);
    case FileKind::protocol_key:
    case FileKind::wiring:
      return {};
    case FileKind::device:
      return add_device(path, file);
    case FileKind::hand:
      return add_hand(path, file);
    case FileKind::results:
      break;
  }
  return add_results(path, file);
}

Result<ProjectFile> project_file(const schema::StoredFile& stored, const Progress& progress) {
  TACTO_TRY(check(stored, playback::part_of(progress, 0, kChecked)));
  ProjectFile file;
  file.path = stored.path;
  file.kind = stored.kind;
  file.data = data_path(stored);
  if (const auto sum = schema::sha256_of_file(file.data)) file.checksum = sum->substr(0, 12);
  const auto read = read_into(stored.path, stored.kind, file, playback::part_of(progress, kChecked, 1));
  TACTO_TRY(read);
  return file;
}

}  // namespace tacto::analysis
