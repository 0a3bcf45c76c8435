// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/session/session_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "data-schema/files/files.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/wav/wav.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/session/sensor_samples.hpp"
#include "playback/session/session_rows.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kBlockRows = 65536;

constexpr std::string_view kColumns =
    "tick,time_s,encoder_count,position_m,drive_v,playing,fault,late,limited,lateness_s,energy_limited,gated,"
    "touching,gain,device_time_s,measured_m";

// Tables of all versions begin with these columns.
constexpr std::string_view kOldestColumns =
    "tick,time_s,encoder_count,position_m,drive_v,playing,fault,late,limited,lateness_s";

using schema::ErrorKind;
using schema::fail;
using schema::PendingFiles;
using schema::Result;
using schema::SessionTick;
using Heard = std::function<void(double)>;

bool is_session_table(std::string_view line) {
  return line.starts_with(kOldestColumns);
}

int flag(std::uint32_t flags, std::uint32_t which) {
  return (flags & which) != 0 ? 1 : 0;
}

std::string line_of(const SessionTick& t, const SessionRow& row, std::optional<double> measured_m) {
  const bool measured = t.lateness_ns != SessionTick::kLatenessUnknown;
  return fmt::format(
      "{},{:.9f},{},{:.12g},{:.9g},{},{},{},{},{},{},{},{},{:.9g},{:.9f},{}\n", t.tick, row.time_s, t.encoder,
      row.position_m, t.drive_v, flag(t.flags, wire::kTickPlaying), flag(t.flags, wire::kTickFault),
      flag(t.flags, wire::kTickLate), flag(t.flags, wire::kTickAmplitudeLimited | wire::kTickSlewLimited),
      measured ? fmt::format("{:.9g}", 1e-9 * t.lateness_ns) : "", flag(t.flags, wire::kTickEnergyLimited),
      flag(t.flags, wire::kTickGated), flag(t.flags, wire::kTickTouching), row.gain, row.device_time_s,
      measured_m ? fmt::format("{:.9g}", *measured_m) : "");
}

Result<std::string> write_csv(const std::string& session, const std::string& temporary,
                              const Heard& progress) {
  const auto overview = session_overview(session, part_of(progress, 0, 0.3));
  TACTO_TRY(overview);
  auto reader = schema::SessionReader::open(session);
  TACTO_TRY(reader);
  std::ofstream out(temporary, std::ios::binary);
  out << kColumns << '\n';
  RowMaker maker(*overview);
  SensorSamples sensor(*overview);
  const auto report = part_of(progress, 0.3, 1);
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block))
      for (const SessionTick& tick : *ticks)
        maker.take(tick,
                   [&](const SessionRow& row) { out << line_of(tick, row, sensor.at(row.device_time_s)); });
    if (report) report(part_read(*reader));
  }
  out.flush();
  return out ? Result<std::string>()
             : fail(ErrorKind::cannot_write, "can't be written", temporary, "is the disk full?");
}

// A WAV has samples for periods without a tick: at most as many as there are ticks, or half an hour.
Result<void> check_even(const SessionOverview& overview) {
  const auto most = std::max(overview.ticks, static_cast<std::uint64_t>(1800 * overview.header.rate_hz));
  if (overview.lost_at)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("ticks are missing from tick {} on, which a WAV can't represent", *overview.lost_at),
        overview.path, "export CSV or netCDF, which carry the time");
  if (overview.missing_periods > most)
    return fail(ErrorKind::unsuitable,
                fmt::format("{} periods have no tick, {} have one: most of the WAV would be interpolated",
                            overview.missing_periods, overview.ticks),
                overview.path, "export CSV or netCDF, which carry the time");
  return {};
}

std::string words_of_missing(const SessionOverview& overview, std::uint64_t unmeasured) {
  std::string words;
  if (overview.missing_periods > 0)
    words = fmt::format(
        "{} periods have no tick because the computer stopped: the WAV interpolates linearly over them",
        overview.missing_periods);
  if (unmeasured > 0)
    words +=
        fmt::format("{}at {} frames there is no sample of the tray's sensor: the WAV repeats the last one",
                    words.empty() ? "" : "; ", unmeasured);
  return words;
}

// Writes frames in blocks; after a failure it stops and keeps the error.
class FrameWriter {
 public:
  FrameWriter(schema::WavWriter& wav, const SessionOverview& overview) : wav_(wav) {
    if (overview.header.sensor) sensor_.emplace(overview);
  }
  void add(const SessionRow& row) {
    frames_.insert(frames_.end(), {row.drive_v, row.position_m});
    if (sensor_) frames_.push_back(measured_m(row));
    if (frames_.size() >= 3 * kBlockRows) write();
  }
  std::uint64_t unmeasured() const { return unmeasured_; }
  Result<void> close() {
    write();
    return written_ ? wav_.close() : written_;
  }

 private:
  // If there is no sample, the last one is repeated.
  double measured_m(const SessionRow& row) {
    const auto measured_m = sensor_->at(row.device_time_s);
    unmeasured_ += !measured_m;
    return last_m_ = measured_m.value_or(last_m_);
  }
  void write() {
    if (written_) written_ = wav_.write(frames_);
    frames_.clear();
  }
  schema::WavWriter& wav_;
  std::optional<SensorSamples> sensor_;
  double last_m_ = 0;
  std::uint64_t unmeasured_ = 0;
  std::vector<double> frames_;
  Result<void> written_;
};

Result<std::string> write_wav(const std::string& session, const std::string& temporary,
                              const Heard& progress) {
  const auto overview = session_overview(session, part_of(progress, 0, 0.3));
  TACTO_TRY(overview);
  TACTO_TRY(check_even(*overview));
  const unsigned channels = overview->header.sensor ? 3 : 2;
  auto wav =
      schema::WavWriter::create(temporary, overview->header.rate_hz, channels, schema::SampleFormat::float64);
  TACTO_TRY(wav);
  FrameWriter frames(*wav, *overview);
  RowMaker maker(*overview, UINT64_MAX);
  const auto read = read_rows(
      maker, session, [&](const SessionRow& row) { frames.add(row); }, part_of(progress, 0.3, 1));
  TACTO_TRY(read);
  TACTO_TRY(frames.close());
  return words_of_missing(*overview, frames.unmeasured());
}

std::vector<schema::SessionTurn> named_turns(const RowMaker& maker, double rate_hz) {
  std::vector<schema::SessionTurn> turns;
  for (const TextureChange& turn : maker.turns())
    turns.push_back({turn.time_s, turn.fade_ticks / rate_hz,
                     turn.brings ? turn.brings->textures : std::vector<schema::SessionTexture>()});
  return turns;
}

Result<std::string> write_netcdf(const std::string& session, const std::string& temporary,
                                 const Heard& progress) {
  const auto overview = session_overview(session, part_of(progress, 0, 0.3));
  TACTO_TRY(overview);
  std::vector<schema::SessionVariable> variables{
      {"tick", "1", "tick since arming"},
      {"encoder_count", "1", "encoder's count"},
      {"position", "m", "position of the finger: the middle of the count"},
      {"drive", "V", "drive at the amplifier's input"},
      {"gain", "1", "factor on the textures' gains"},
      {"flags", "1", "flags of the wire's ticks"},
      {"device_time", "s", "time by the device's own clock"}};
  if (overview->header.sensor)
    variables.push_back(
        {"measured", "m", "displacement of the tray by its sensor, at the tick; NaN: no sample"});
  schema::SessionNetcdf file(temporary, overview->header, overview->ticks, variables);
  RowMaker maker(*overview);
  SensorSamples sensor(*overview);
  const auto add = [&](const SessionRow& row) {
    const double values[] = {static_cast<double>(row.tick),
                             static_cast<double>(row.encoder),
                             row.position_m,
                             row.drive_v,
                             row.gain,
                             static_cast<double>(row.flags),
                             row.device_time_s,
                             sensor.at(row.device_time_s).value_or(NAN)};
    file.add(row.time_s, std::span(values).first(variables.size()));
  };
  TACTO_TRY(read_rows(maker, session, add, part_of(progress, 0.3, 1)));
  const auto written = file.close(named_turns(maker, overview->header.rate_hz));
  return written ? Result<std::string>() : schema::forward_error(written);
}

Result<void> check_table(const std::string& file, schema::Existing existing) {
  return schema::check_table_free(file, existing, is_session_table);
}

Result<void> check_netcdf(const std::string& file, schema::Existing existing) {
  if (!schema::is_file(file) || schema::is_session_netcdf(file))
    return schema::check_output_free(file, existing);
  return fail(ErrorKind::usage, "has other content, which would be overwritten", file,
              "choose another name, or remove it first");
}

struct Format {
  std::string_view ending;
  Result<void> (*check)(const std::string& file, schema::Existing existing);
  Result<std::string> (*write)(const std::string& session, const std::string& temporary,
                               const Heard& progress);
};
constexpr Format kFormats[] = {{".csv", check_table, write_csv},
                               {".wav", schema::check_wav_free, write_wav},
                               {".nc", check_netcdf, write_netcdf}};

Result<const Format*> format_of(const std::string& file) {
  for (const Format& format : kFormats)
    if (file.ends_with(format.ending)) return &format;
  return fail(ErrorKind::usage, fmt::format("a session can't be exported to '{}'", file), "output",
              "name a file that ends in .csv, .wav or .nc");
}

}  // namespace

Result<void> check_session_output(const std::string& file, schema::Existing existing) {
  const auto format = format_of(file);
  return format ? (*format)->check(file, existing) : schema::forward_error(format);
}

Result<std::string> export_session(const std::string& session, const std::string& file,
                                   schema::Existing existing, const std::function<void(double)>& progress) {
  TACTO_TRY(check_session_output(file, existing));
  PendingFiles pending;
  const auto temporary = pending.add(file);
  TACTO_TRY(temporary);
  auto said = (*format_of(file))->write(session, *temporary, progress);
  if (!said) return said;
  const auto kept = pending.commit(existing);
  return kept ? said : schema::forward_error(kept);
}

}  // namespace tacto::playback
