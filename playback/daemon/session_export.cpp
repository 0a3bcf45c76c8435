// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "data-schema/files.hpp"
#include "data-schema/session_netcdf.hpp"
#include "data-schema/wav.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/daemon/session_rows.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kBlockRows = 65536;

constexpr std::string_view kColumns =
    "tick,time_s,encoder_count,position_m,drive_v,playing,fault,late,limited,lateness_s,energy_limited,gated,"
    "touching,gain,device_time_s";

// With which a table begins in every version.
constexpr std::string_view kOldestColumns =
    "tick,time_s,encoder_count,position_m,drive_v,playing,fault,late,limited,lateness_s";

using schema::fail;
using schema::Fault;
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

std::string line_of(const SessionTick& t, const SessionRow& row) {
  const bool measured = t.lateness_ns != SessionTick::kLatenessUnknown;
  return fmt::format(
      "{},{:.9f},{},{:.12g},{:.9g},{},{},{},{},{},{},{},{},{:.9g},{:.9f}\n", t.tick, row.time_s, t.encoder,
      row.position_m, t.drive_v, flag(t.flags, wire::kTickPlaying), flag(t.flags, wire::kTickFault),
      flag(t.flags, wire::kTickLate), flag(t.flags, wire::kTickAmplitudeLimited | wire::kTickSlewLimited),
      measured ? fmt::format("{:.9g}", 1e-9 * t.lateness_ns) : "", flag(t.flags, wire::kTickEnergyLimited),
      flag(t.flags, wire::kTickGated), flag(t.flags, wire::kTickTouching), row.gain, row.device_time_s);
}

Result<std::string> write_csv(const std::string& session, const std::string& temporary,
                              const Heard& progress) {
  const auto overview = session_overview(session, part_of(progress, 0, 0.3));
  if (!overview) return schema::forward_error(overview);
  auto reader = schema::SessionReader::open(session);
  if (!reader) return schema::forward_error(reader);
  std::ofstream out(temporary, std::ios::binary);
  out << kColumns << '\n';
  RowMaker maker(*overview);
  const auto told = part_of(progress, 0.3, 1);
  while (const auto block = reader->next()) {
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block))
      for (const SessionTick& tick : *ticks)
        maker.take(tick, [&](const SessionRow& row) { out << line_of(tick, row); });
    if (told) told(part_read(*reader));
  }
  out.flush();
  return out ? Result<std::string>()
             : fail(Fault::cannot_write, "can't be written", temporary, "is the disk full?");
}

// What a WAV would hold of periods without a tick: at most as much as of the others, or half an hour.
Result<void> check_even(const SessionOverview& overview) {
  const auto most = std::max(overview.ticks, static_cast<std::uint64_t>(1800 * overview.header.rate_hz));
  if (overview.lost_at)
    return fail(Fault::unsuitable,
                fmt::format("ticks are missing from {} on, which a WAV can't show", *overview.lost_at),
                overview.path, "export CSV or netCDF, which carry the time");
  if (overview.missing_periods > most)
    return fail(Fault::unsuitable,
                fmt::format("{} periods passed without a tick, beside {} ticks: most of the WAV would be "
                            "made up",
                            overview.missing_periods, overview.ticks),
                overview.path, "export CSV or netCDF, which carry the time");
  return {};
}

std::string words_of_missing(const SessionOverview& overview) {
  if (overview.missing_periods == 0) return {};
  return fmt::format(
      "{} ticks were never made, for the computer stood still: the WAV goes straight from one neighbour to "
      "the other",
      overview.missing_periods);
}

// Frames are written in blocks; the first failure stays.
class FrameWriter {
 public:
  explicit FrameWriter(schema::WavWriter& wav) : wav_(wav) { frames_.reserve(2 * kBlockRows); }
  void add(const SessionRow& row) {
    frames_.insert(frames_.end(), {row.drive_v, row.position_m});
    if (frames_.size() == 2 * kBlockRows) write();
  }
  Result<void> close() {
    write();
    return written_ ? wav_.close() : written_;
  }

 private:
  void write() {
    if (written_) written_ = wav_.write(frames_);
    frames_.clear();
  }
  schema::WavWriter& wav_;
  std::vector<double> frames_;
  Result<void> written_;
};

Result<std::string> write_wav(const std::string& session, const std::string& temporary,
                              const Heard& progress) {
  const auto overview = session_overview(session, part_of(progress, 0, 0.3));
  if (!overview) return schema::forward_error(overview);
  if (const auto even = check_even(*overview); !even) return schema::forward_error(even);
  auto wav = schema::WavWriter::create(temporary, overview->header.rate_hz, 2, schema::SampleFormat::float64);
  if (!wav) return schema::forward_error(wav);
  FrameWriter frames(*wav);
  RowMaker maker(*overview, UINT64_MAX);
  const auto read = read_rows(
      maker, session, [&](const SessionRow& row) { frames.add(row); }, part_of(progress, 0.3, 1));
  if (!read) return schema::forward_error(read);
  if (const auto written = frames.close(); !written) return schema::forward_error(written);
  return words_of_missing(*overview);
}

std::vector<schema::SessionTurn> named_turns(const RowMaker& maker, double rate_hz) {
  std::vector<schema::SessionTurn> turns;
  for (const TextureTurn& turn : maker.turns())
    turns.push_back({turn.time_s, turn.fade_ticks / rate_hz,
                     turn.brings ? turn.brings->textures : std::vector<schema::SessionTexture>()});
  return turns;
}

Result<std::string> write_netcdf(const std::string& session, const std::string& temporary,
                                 const Heard& progress) {
  const auto overview = session_overview(session, part_of(progress, 0, 0.3));
  if (!overview) return schema::forward_error(overview);
  schema::SessionNetcdf file(temporary, overview->header, overview->ticks,
                             {{"tick", "1", "tick since arming"},
                              {"encoder_count", "1", "encoder's count"},
                              {"position", "m", "position of the finger: the middle of the count"},
                              {"drive", "V", "drive at the amplifier's input"},
                              {"gain", "1", "factor on the textures' gains"},
                              {"flags", "1", "flags of the wire's ticks"},
                              {"device_time", "s", "time by the device's own clock"}});
  RowMaker maker(*overview);
  const auto add = [&](const SessionRow& row) {
    const double values[] = {static_cast<double>(row.tick),
                             static_cast<double>(row.encoder),
                             row.position_m,
                             row.drive_v,
                             row.gain,
                             static_cast<double>(row.flags),
                             row.device_time_s};
    file.add(row.time_s, values);
  };
  if (const auto read = read_rows(maker, session, add, part_of(progress, 0.3, 1)); !read)
    return schema::forward_error(read);
  const auto written = file.close(named_turns(maker, overview->header.rate_hz));
  return written ? Result<std::string>() : schema::forward_error(written);
}

struct Format {
  std::string_view ending;
  Result<std::string> (*write)(const std::string& session, const std::string& temporary,
                               const Heard& progress);
};
constexpr Format kFormats[] = {{".csv", write_csv}, {".wav", write_wav}, {".nc", write_netcdf}};

}  // namespace

Result<std::string> export_session(const std::string& session, const std::string& file,
                                   const std::function<void(double)>& progress) {
  for (const Format& format : kFormats) {
    if (!file.ends_with(format.ending)) continue;
    const bool table = format.ending == ".csv";
    if (table)
      if (const auto free = schema::check_table_free(file, is_session_table); !free)
        return schema::forward_error(free);
    PendingFiles pending;
    const auto temporary = pending.add(file);
    if (!temporary) return schema::forward_error(temporary);
    auto said = format.write(session, *temporary, progress);
    if (!said) return said;
    const auto kept = pending.commit(table ? schema::Existing::replace : schema::Existing::keep);
    return kept ? said : schema::forward_error(kept);
  }
  return fail(Fault::usage, fmt::format("'{}' is no format that a session can be exported to", file),
              "output", "name a file that ends in .csv, .wav or .nc");
}

}  // namespace tacto::playback
