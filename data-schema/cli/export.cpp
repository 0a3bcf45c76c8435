// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/cli/verbs.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/exchange/hjif.hpp"
#include "data-schema/exchange/mat_file.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/kinds/file_kind.hpp"
#include "data-schema/recording/recording_frames.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/session/session_reader.hpp"
#include "data-schema/spectrogram/spectrogram.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/version.hpp"

namespace tacto::schema {
namespace {

// A stored file as a MATLAB file.

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

// Whether export_mat() takes this kind: recording, texture, spectrogram, session.
bool is_mat_kind(FileKind kind) {
  return kind == FileKind::recording || kind == FileKind::texture || kind == FileKind::spectrogram ||
         kind == FileKind::session;
}

// SI units, names with their unit. Memory: one channel of a recording, all ticks of a session. Errors: of
// reading the file; usage, for an existing file; cannot_write.
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

constexpr std::uint64_t kBlockFrames = 8192;

struct ExportOptions {
  std::string name, output;
  double max_error = 0.005;
  CLI::Option* asked_error = nullptr;
  Existing existing = Existing::keep;
};

/// A text file, or stdout.
class TableFile {
 public:
  explicit TableFile(const std::string& path)
      : path_(path), file_(path.empty() ? stdout : std::fopen(path.c_str(), "wb")) {}
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;
  ~TableFile() {
    if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  }
  Result<void> write(std::string_view text) {
    if (file_ == nullptr || std::fwrite(text.data(), 1, text.size(), file_) != text.size() ||
        std::fflush(file_) != 0)
      return fail(ErrorKind::cannot_write, "can't be written", path_.empty() ? "stdout" : path_,
                  "is the disk full?");
    return {};
  }

 private:
  std::string path_;
  std::FILE* file_;
};

std::string head_of(std::vector<std::string> columns, const std::string& simulated) {
  if (!simulated.empty()) columns.emplace_back("simulated");
  return fmt::format("{}\n", fmt::join(columns, ","));
}

bool is_exported(std::string_view head) {
  return head.starts_with("time_s,") || head.starts_with("position_m,");
}

// Numbers have as many digits as give the same double again.
Result<cli::Report> export_recording(const std::string& path, TableFile& table) {
  const auto recording = open_recording(path);
  TACTO_TRY(recording);
  const RecordingHeader& header = recording->header;
  auto frames = RecordingFrames::open(*recording);
  TACTO_TRY(frames);
  std::vector<std::string> columns{"time_s"};
  for (const Channel& channel : header.channels) columns.push_back(key_in(channel.name, channel.unit));
  TACTO_TRY(table.write(head_of(columns, header.simulated)));
  cli::Progress progress("exporting");
  std::vector<std::vector<double>> values(header.channels.size());
  for (std::uint64_t first = 0; first < header.frames; first += kBlockFrames) {
    const std::uint64_t count = std::min(kBlockFrames, header.frames - first);
    for (std::size_t c = 0; c < values.size(); ++c) {
      values[c].resize(count);
      TACTO_TRY(frames->read(c, first, values[c]));
    }
    std::string text;
    for (std::uint64_t i = 0; i < count; ++i) {
      fmt::format_to(std::back_inserter(text), "{:.9f}", frame_time_s(header, first + i));
      for (const auto& channel : values) fmt::format_to(std::back_inserter(text), ",{}", channel[i]);
      text += header.simulated.empty() ? "\n" : ",1\n";
    }
    TACTO_TRY(table.write(text));
    progress.update(static_cast<double>(first + count) / static_cast<double>(header.frames));
  }
  cli::Report report = report_of(FileKind::recording, path, header.simulated);
  report.add("rows", header.frames).add("columns", columns).add("gaps", header.gaps.size());
  if (!header.gaps.empty())
    report.add("missing_frames", header.gaps.back().device_sequence - header.gaps.back().frame);
  report.add("marks_not_in_table", header.marks.size());
  return report;
}

Result<cli::Report> export_texture(const std::string& path, TableFile& table) {
  const auto texture = read_texture(path);
  TACTO_TRY(texture);
  std::vector<std::string> columns{"position_m", key_in(texture->quantity, texture->unit)};
  if (texture->average) columns.push_back(key_in("spread", texture->unit));
  std::string text = head_of(columns, texture->simulated);
  const auto& values = texture->signal.values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:.12g},{}", static_cast<double>(i) * texture->signal.pitch_m,
                   values[i]);
    if (texture->average) fmt::format_to(std::back_inserter(text), ",{}", texture->average->spread[i]);
    text += texture->simulated.empty() ? "\n" : ",1\n";
  }
  TACTO_TRY(table.write(text));
  cli::Report report = report_of(FileKind::texture, path, texture->simulated);
  return report.add("rows", values.size()).add("columns", columns);
}

Result<cli::Report> export_hjif(const ExportOptions& o, const StoredFile& file) {
  if (file.kind != FileKind::texture)
    return fail(ErrorKind::unsuitable, "is a recording; a .hjif file holds a texture", file.path,
                "make textures with 'tactograph spatial', or export NAME.csv");
  TACTO_TRY(check_table_free(o.output, o.existing, [](std::string_view line) {
    return line.starts_with("{\"version\":\"2023\",\"profile\":\"Main\"");
  }));
  const auto texture = read_texture(file.path);
  TACTO_TRY(texture);
  const std::string by = texture->simulated.empty() ? "" : "; simulated " + texture->simulated;
  const auto hjif = hjif_of(*texture, file.path + by, o.max_error);
  TACTO_TRY(hjif);
  PendingFiles files;
  TACTO_TRY(files.write(o.output, hjif->text));
  TACTO_TRY(files.commit(o.existing));
  cli::Report report = report_of(FileKind::texture, file.path, texture->simulated);
  report.add("error_percent", 100 * hjif->error).add("error_db", amplitude_db(hjif->error));
  report.add("keyframes", hjif->keyframes).add("keyframe_distance_m", 1e-6 * hjif->step_um);
  report.add("length_m", hjif->length_m).add("peak_n", hjif->peak_n);
  return report
      .add("lost",
           "unit of force, valid band, origin on the bench, direction, spread: the format has no member for "
           "them")
      .add("written", o.output);
}

Result<StoredFile> exportable(const std::string& name, bool mat) {
  const auto files = stored_files(name);
  TACTO_TRY(files);
  for (const StoredFile& file : *files)
    if (file.kind == FileKind::recording || file.kind == FileKind::texture || (mat && is_mat_kind(file.kind)))
      return file;
  const bool session = files->front().kind == FileKind::session;
  return fail(
      ErrorKind::unsuitable,
      fmt::format(
          "is a {}, and only recordings and textures are exported (as .mat also spectrograms and sessions)",
          kind_name(files->front().kind)),
      files->front().path,
      session ? fmt::format("export a session with 'tactograph session {0} -o {0}.csv'", name)
              : "name a recording or a texture");
}

Result<cli::Report> run_export(const ExportOptions& o) {
  const bool hjif = o.output.ends_with(".hjif"), mat = o.output.ends_with(".mat");
  const auto file = exportable(o.name, mat);
  TACTO_TRY(file);
  if (!hjif && o.asked_error->count() > 0)
    return fail(ErrorKind::usage, "only a .hjif file has an error", "--max-error",
                "add -o NAME.hjif, or leave it out");
  if (hjif) return export_hjif(o, *file);
  if (mat) return export_mat(*file, o.output, o.existing);
  const auto write = file->kind == FileKind::recording ? export_recording : export_texture;
  if (o.output == "-") {
    TableFile table("");
    const auto written = write(file->path, table);
    return written ? Result<cli::Report>(cli::Report()) : written;
  }
  const std::string output = o.output.empty() ? stem_of(file->path, "") + ".csv" : o.output;
  TACTO_TRY(
      cli::check_ending(output, {".csv"}, "name NAME.csv, NAME.mat, NAME.hjif, or - for a table on stdout"));
  TACTO_TRY(check_table_free(output, o.existing, is_exported));
  PendingFiles files;
  const auto temporary = files.add(output);
  TACTO_TRY(temporary);
  auto report = [&] {
    TableFile table(*temporary);
    return write(file->path, table);
  }();
  TACTO_TRY(report);
  TACTO_TRY(files.commit(o.existing));
  return report->add("written", output);
}

cli::Action declare_export(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  app.add_option("FILE", options->name,
                 "Recording or texture, for a .mat file also a spectrogram or session: stem or file name")
      ->required();
  app.add_option(
      "-o,--output", options->output,
      "Output: NAME.csv; NAME.mat (MATLAB, Octave); - for the table on stdout, without a report; of a "
      "texture also NAME.hjif "
      "(MPEG haptics). "
      "Default: the input's name as .csv");
  options->asked_error =
      cli::add_quantity(app, "--max-error", options->max_error, Dimension::share,
                        "Of a .hjif file: RMS of its curve minus the texture, over the texture's RMS");
  cli::declare_force(app, options->existing);
  app.footer(
      app.get_footer() +
      "\nSI units; the header names quantity and unit. Of a recording: time_s and a column for each "
      "channel; a lost sample has no row. Of a texture: position_m, its values and, of an average, "
      "their spread. Simulated data have a last column 'simulated' of ones.\n"
      "A .hjif file (ISO/IEC 23090-31) has one curve through keyframes, as far apart as --max-error "
      "permits.\n"
      "A .mat file has a variable for each column, single numbers such as sample_rate_hz or pitch_m, and the "
      "struct provenance: version 5, or 7.3 if a variable has 2 GB or more.");
  return [options] { return run_export(*options); };
}

}  // namespace

const cli::Verb kExportVerb{"export",
                            "Write a recording or a texture for other programs: CSV, MATLAB, or MPEG haptics",
                            "tactograph export oak\n  tactograph export oak-01 -o - | head\n"
                            "  tactograph export oak -o oak.mat\n"
                            "  tactograph export oak-01 -o oak.hjif --max-error 0.5%",
                            declare_export};

}  // namespace tacto::schema
