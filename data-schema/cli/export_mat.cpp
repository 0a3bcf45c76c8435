// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/cli/export_mat.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "data-schema/cli/describe.hpp"
#include "data-schema/exchange/mat_file.hpp"
#include "data-schema/recording/recording_frames.hpp"
#include "data-schema/session/session_reader.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/version.hpp"

namespace tacto::schema {
namespace {

// What is common to all kinds; the kind's own members follow.
MatMembers provenance_of(const StoredFile& file, const std::string& simulated, const std::string& created) {
  return {{"file", file.path},
          {"kind", std::string(kind_name(file.kind))},
          {"simulated", simulated},
          {"created", created},
          {"exported_by", std::string(kCreator)}};
}

void append(MatMembers& members, MatMembers more) {
  for (auto& member : more) members.push_back(std::move(member));
}

Result<MatWriter> mat_writer(const std::string& temporary, const std::string& output,
                             std::uint64_t largest_bytes) {
  return MatWriter::create(temporary, output, mat_version_for(largest_bytes));
}

Result<cli::Report> recording_to_mat(const StoredFile& file, const std::string& temporary,
                                     const std::string& output) {
  const auto recording = open_recording(file.path);
  TACTO_TRY(recording);
  const RecordingHeader& header = recording->header;
  auto frames = RecordingFrames::open(*recording);
  TACTO_TRY(frames);
  auto mat = mat_writer(temporary, output, header.frames * sizeof(double));
  TACTO_TRY(mat);
  std::vector<double> values(header.frames);
  for (std::uint64_t i = 0; i < header.frames; ++i) values[i] = frame_time_s(header, i);
  TACTO_TRY(mat->put("time_s", values));
  std::vector<std::string> columns{"time_s"};
  for (std::size_t k = 0; k < header.channels.size(); ++k) {
    columns.push_back(key_in(header.channels[k].name, header.channels[k].unit));
    TACTO_TRY(frames->read(k, 0, values));
    TACTO_TRY(mat->put(columns.back(), values));
  }
  TACTO_TRY(mat->put("sample_rate_hz", std::vector{header.sample_rate_hz}));
  MatMembers members = provenance_of(file, header.simulated, header.created);
  append(members, {{"sha256", header.sha256},
                   {"recorded", header.recorded},
                   {"device", header.device},
                   {"clock", header.clock},
                   {"source_file", header.source_file},
                   {"source_sha256", header.source_sha256},
                   {"subject", header.subject},
                   {"finger", header.finger},
                   {"surface", header.surface},
                   {"notes", header.notes}});
  TACTO_TRY(mat->put("provenance", members));
  TACTO_TRY(mat->close());
  cli::Report report = report_of(file.kind, file.path, header.simulated);
  report.add("rows", header.frames).add("variables", columns).add("gaps", header.gaps.size());
  return report.add("marks_not_in_file", header.marks.size());
}

Result<cli::Report> texture_to_mat(const StoredFile& file, const std::string& temporary,
                                   const std::string& output) {
  const auto texture = read_texture(file.path);
  TACTO_TRY(texture);
  const auto& values = texture->signal.values;
  auto mat = mat_writer(temporary, output, values.size() * sizeof(double));
  TACTO_TRY(mat);
  std::vector<double> position_m(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    position_m[i] = static_cast<double>(i) * texture->signal.pitch_m;
  std::vector<std::string> columns{"position_m", key_in(texture->quantity, texture->unit)};
  TACTO_TRY(mat->put(columns[0], position_m));
  TACTO_TRY(mat->put(columns[1], std::vector<double>(values.begin(), values.end())));
  if (texture->average) {
    const auto& spread = texture->average->spread;
    columns.push_back(key_in("spread", texture->unit));
    TACTO_TRY(mat->put(columns[2], std::vector<double>(spread.begin(), spread.end())));
  }
  TACTO_TRY(mat->put("pitch_m", std::vector{texture->signal.pitch_m}));
  MatMembers members = provenance_of(file, texture->simulated, texture->created);
  append(members, {{"recording", texture->source.recording},
                   {"recording_sha256", texture->source.recording_sha256},
                   {"from_s", texture->source.from_s},
                   {"to_s", texture->source.to_s},
                   {"stroke", static_cast<double>(texture->source.stroke)},
                   {"low_hz", texture->source.low_hz},
                   {"high_hz", texture->source.high_hz},
                   {"mean_speed_mps", texture->source.mean_speed_mps},
                   {"direction", static_cast<double>(texture->direction)},
                   {"source_origin_m", texture->source_origin_m},
                   {"subject", texture->subject},
                   {"finger", texture->finger},
                   {"surface", texture->surface},
                   {"notes", texture->notes}});
  TACTO_TRY(mat->put("provenance", members));
  TACTO_TRY(mat->close());
  cli::Report report = report_of(file.kind, file.path, texture->simulated);
  return report.add("rows", values.size()).add("variables", columns);
}

// The matrix has a row for each spatial frequency and a column for each position, as MATLAB's
// imagesc(position, frequency, matrix) draws it; in the file that is row after row of the spectrogram.
Result<cli::Report> spectrogram_to_mat(const StoredFile& file, const std::string& temporary,
                                       const std::string& output) {
  const auto spectrogram = read_spectrogram_nc(file.path);
  TACTO_TRY(spectrogram);
  const Spectrogram& s = *spectrogram;
  auto mat = mat_writer(temporary, output, s.cells.size() * sizeof(float));
  TACTO_TRY(mat);
  std::vector<double> frequency_per_m(s.bins);
  for (std::size_t k = 0; k < s.bins; ++k) frequency_per_m[k] = s.frequency_per_m(k);
  std::vector<std::string> columns{"position_m", "spatial_frequency_per_m",
                                   s.scaling == Scaling::density ? "density" : "amplitude"};
  TACTO_TRY(mat->put(columns[0], s.position_m));
  TACTO_TRY(mat->put(columns[1], frequency_per_m));
  TACTO_TRY(mat->put(columns[2], std::span<const float>(s.cells), s.position_m.size()));
  if (!s.known.empty()) {  // limits of the band that the recording could know, by position
    std::vector<double> from_per_m, to_per_m;
    for (const KnownBand& band : s.known) {
      from_per_m.push_back(band.low_per_m);
      to_per_m.push_back(band.high_per_m);
    }
    columns.insert(columns.end(), {"known_from_per_m", "known_to_per_m"});
    TACTO_TRY(mat->put(columns[3], from_per_m));
    TACTO_TRY(mat->put(columns[4], to_per_m));
  }
  MatMembers members = provenance_of(file, s.simulated, "");
  append(members, {{"texture", s.name},
                   {"quantity", s.quantity},
                   {"unit", s.scaling == Scaling::density ? "(" + s.unit + ")^2 m" : s.unit},
                   {"window", s.window},
                   {"detrend", s.detrend},
                   {"window_m", s.window_m},
                   {"hop_m", s.hop_m},
                   {"strokes_in_file", static_cast<double>(s.strokes)}});
  TACTO_TRY(mat->put("provenance", members));
  TACTO_TRY(mat->close());
  cli::Report report = report_of(file.kind, file.path, s.simulated);
  return report.add("rows", s.position_m.size())
      .add("variables", columns)
      .add("strokes_not_in_file", s.strokes - 1);
}

// The ticks, as stored; a lost tick has no row.
struct TickColumns {
  std::vector<double> tick, time_s, encoder_count, drive_v, flags;
  std::int64_t first_ns = 0;
  void add(const SessionTick& t) {
    if (tick.empty()) first_ns = t.time_ns;
    tick.push_back(static_cast<double>(t.tick));
    time_s.push_back(1e-9 * static_cast<double>(t.time_ns - first_ns));
    encoder_count.push_back(t.encoder);
    drive_v.push_back(static_cast<double>(t.drive_v));
    flags.push_back(t.flags);
  }
};

Result<cli::Report> session_to_mat(const StoredFile& file, const std::string& temporary,
                                   const std::string& output) {
  auto reader = SessionReader::open(file.path);
  TACTO_TRY(reader);
  const SessionHeader& header = reader->header();
  if (header.forces)
    return fail(ErrorKind::unsuitable, "is a session of forces, which is exported as a table only", file.path,
                "use tactograph session NAME -o NAME.csv");
  TickColumns ticks;
  while (const auto block = reader->next())
    if (const auto* several = std::get_if<std::vector<SessionTick>>(&*block))
      for (const SessionTick& tick : *several) ticks.add(tick);
  if (ticks.tick.empty()) return fail(ErrorKind::unsuitable, "has no ticks", file.path);
  auto mat = mat_writer(temporary, output, ticks.tick.size() * sizeof(double));
  TACTO_TRY(mat);
  TACTO_TRY(mat->put("tick", ticks.tick));
  TACTO_TRY(mat->put("time_s", ticks.time_s));
  TACTO_TRY(mat->put("encoder_count", ticks.encoder_count));
  TACTO_TRY(mat->put("drive_v", ticks.drive_v));
  TACTO_TRY(mat->put("flags", ticks.flags));
  TACTO_TRY(mat->put("sample_rate_hz", std::vector{header.rate_hz}));
  TACTO_TRY(mat->put("metres_per_count", std::vector{header.metres_per_count}));
  MatMembers members = provenance_of(file, header.simulated, header.created);
  append(members, {{"device", header.device_uri},
                   {"transducer", header.transducer.name},
                   {"texture", header.textures.empty() ? std::string() : header.textures[0].file}});
  TACTO_TRY(mat->put("provenance", members));
  TACTO_TRY(mat->close());
  cli::Report report = report_of(file.kind, file.path, header.simulated);
  return report.add("rows", ticks.tick.size())
      .add("variables", std::vector<std::string>{"tick", "time_s", "encoder_count", "drive_v", "flags"});
}

}  // namespace

bool is_mat_kind(FileKind kind) {
  return kind == FileKind::recording || kind == FileKind::texture || kind == FileKind::spectrogram ||
         kind == FileKind::session;
}

Result<cli::Report> export_mat(const StoredFile& file, const std::string& output, Existing existing) {
  TACTO_TRY(check_table_free(output, existing, is_own_mat));
  PendingFiles files;
  const auto temporary = files.add(output);
  TACTO_TRY(temporary);
  const auto write = file.kind == FileKind::recording     ? recording_to_mat
                     : file.kind == FileKind::texture     ? texture_to_mat
                     : file.kind == FileKind::spectrogram ? spectrogram_to_mat
                                                          : session_to_mat;
  auto report = write(file, *temporary, output);
  TACTO_TRY(report);
  TACTO_TRY(files.commit(existing));
  return report->add("written", output);
}

}  // namespace tacto::schema
