// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/daemon/session_export.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "data-schema/files.hpp"
#include "data-schema/session_netcdf.hpp"
#include "data-schema/wav.hpp"
#include "firmware-host/core/wire/message_types.hpp"
#include "playback/daemon/session_columns.hpp"

namespace tacto::playback {
namespace {

constexpr std::string_view kColumns =
    "tick,time_s,encoder_count,position_m,drive_v,playing,fault,late,limited,lateness_s,energy_limited,gated,"
    "touching";

// With which a table begins in every version.
constexpr std::string_view kOldestColumns =
    "tick,time_s,encoder_count,position_m,drive_v,playing,fault,late,limited,lateness_s";

using schema::fail;
using schema::Fault;
using schema::PendingFiles;
using schema::Result;
using schema::SessionTick;

bool is_session_table(std::string_view line) {
  return line.starts_with(kOldestColumns);
}

int flag(std::uint32_t flags, std::uint32_t which) {
  return (flags & which) != 0 ? 1 : 0;
}

std::string lines_of(const std::vector<SessionTick>& ticks, const schema::SessionHeader& header) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const SessionTick& t : ticks) {
    const bool measured = t.lateness_ns != SessionTick::kLatenessUnknown;
    fmt::format_to(
        out, "{},{:.9f},{},{:.9g},{:.9g},{},{},{},{},{},{},{},{}\n", t.tick,
        1e-9 * static_cast<double>(t.time_ns), t.encoder, header.metres_per_count * (t.encoder + 0.5),
        t.drive_v, flag(t.flags, wire::kTickPlaying), flag(t.flags, wire::kTickFault),
        flag(t.flags, wire::kTickLate), flag(t.flags, wire::kTickAmplitudeLimited | wire::kTickSlewLimited),
        measured ? fmt::format("{:.9g}", 1e-9 * t.lateness_ns) : "", flag(t.flags, wire::kTickEnergyLimited),
        flag(t.flags, wire::kTickGated), flag(t.flags, wire::kTickTouching));
  }
  return text;
}

Result<std::string> write_csv(const std::string& session, const std::string& temporary) {
  auto reader = schema::SessionReader::open(session);
  if (!reader) return schema::forward_error(reader);
  std::ofstream out(temporary, std::ios::binary);
  out << kColumns << '\n';
  while (const auto block = reader->next())
    if (const auto* ticks = std::get_if<std::vector<SessionTick>>(&*block))
      out << lines_of(*ticks, reader->header());
  out.flush();
  return out ? Result<std::string>()
             : fail(Fault::cannot_write, "can't be written", temporary, "is the disk full?");
}

Result<std::string> write_wav(const std::string& session, const std::string& temporary) {
  const auto columns = read_session_columns(session);
  if (!columns) return schema::forward_error(columns);
  if (columns->lost_at)
    return fail(Fault::unsuitable,
                fmt::format("ticks are missing from {} on, which a WAV can't show", *columns->lost_at),
                session, "export CSV or netCDF, which carry the time");
  const auto even = evened(*columns);
  if (!even) return schema::forward_error(even);
  auto wav = schema::WavWriter::create(temporary, columns->header.rate_hz, 2, schema::SampleFormat::float64);
  if (!wav) return schema::forward_error(wav);
  std::vector<double> frames;
  for (std::size_t i = 0; i < even->columns.tick.size(); ++i)
    frames.insert(frames.end(), {even->columns.drive_v[i], even->columns.position_m[i]});
  auto written = wav->write(frames);
  if (written) written = wav->close();
  if (!written) return schema::forward_error(written);
  return even->added == 0 ? std::string()
                          : fmt::format(
                                "{} ticks were never made, for the computer stood still: the WAV goes "
                                "straight from one neighbour to the other",
                                even->added);
}

std::vector<schema::SessionTurn> turns_of(const SessionColumns& columns) {
  std::vector<schema::SessionTurn> turns;
  for (const TextureTurn& turn : columns.turns)
    turns.push_back({columns.time_s[turn.row], turn.fade_ticks / columns.header.rate_hz,
                     turn.brings ? turn.brings->textures : std::vector<schema::SessionTexture>()});
  return turns;
}

Result<std::string> write_netcdf(const std::string& session, const std::string& temporary) {
  auto columns = read_session_columns(session);
  if (!columns) return schema::forward_error(columns);
  const std::vector<double> ticks(columns->tick.begin(), columns->tick.end());
  const std::vector<double> encoder(columns->encoder.begin(), columns->encoder.end());
  const std::vector<double> flags(columns->flags.begin(), columns->flags.end());
  const auto written = schema::write_session_netcdf(
      temporary, columns->header, turns_of(*columns),
      {{"tick", "1", "tick since arming", &ticks},
       {"encoder_count", "1", "encoder's count", &encoder},
       {"position", "m", "position of the finger: the middle of the count", &columns->position_m},
       {"drive", "V", "drive at the amplifier's input", &columns->drive_v},
       {"gain", "1", "factor on the textures' gains", &columns->gain},
       {"flags", "1", "flags of the wire's ticks", &flags}},
      columns->time_s);
  return written ? Result<std::string>() : schema::forward_error(written);
}

struct Format {
  std::string_view ending;
  Result<std::string> (*write)(const std::string& session, const std::string& temporary);
};
constexpr Format kFormats[] = {{".csv", write_csv}, {".wav", write_wav}, {".nc", write_netcdf}};

}  // namespace

Result<std::string> export_session(const std::string& session, const std::string& file) {
  for (const Format& format : kFormats) {
    if (!file.ends_with(format.ending)) continue;
    const bool table = format.ending == ".csv";
    if (table)
      if (const auto free = schema::check_table_free(file, is_session_table); !free)
        return schema::forward_error(free);
    PendingFiles pending;
    const auto temporary = pending.add(file);
    if (!temporary) return schema::forward_error(temporary);
    auto said = format.write(session, *temporary);
    if (!said) return said;
    const auto kept = pending.commit(table ? schema::Existing::replace : schema::Existing::keep);
    return kept ? said : schema::forward_error(kept);
  }
  return fail(Fault::usage, fmt::format("'{}' is no format that a session can be exported to", file),
              "output", "name a file that ends in .csv, .wav or .nc");
}

}  // namespace tacto::playback
