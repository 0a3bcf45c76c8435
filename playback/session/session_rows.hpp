// SPDX-License-Identifier: GPL-3.0-or-later
// A session row by row; memory does not depend on its length.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/session/session_reader.hpp"

namespace tacto::playback {

/// The range of encoder counts in which a device reads a texture; outside its drive is zero
/// (core::reach_counts).
struct ProfileReach {
  std::int32_t origin_count = 0;
  std::int64_t counts = INT64_MAX;  ///< to each side; none stated: all

  bool holds(std::int32_t encoder) const;
};

/// A change of texture.
struct TextureChange {
  std::uint64_t row = 0;                         ///< the first that contains the new texture
  double fade_ticks = 0;                         ///< duration of the fade (core::TexturePlayer)
  std::optional<schema::SessionProgram> brings;  ///< none: the file lacks it, because it could not be written
  double time_s = 0;                             ///< of that row
  ProfileReach reach = {};
};

/// A steering command, in the order of the session.
struct SteeringStep {
  std::optional<double> gain;         ///< factor of the textures' own gains, if the command is a gain
  std::optional<TextureChange> turn;  ///< if it is a change of texture; its row is found later
};

/// What a reader of rows needs to know of the whole session.
struct SessionOverview {
  schema::SessionHeader header;
  std::string path;
  std::vector<SteeringStep> steps;
  ProfileReach reach;                ///< of the first textures
  double look_ahead_ticks = 0;       ///< the drive belongs to the finger's place this much later
  float onset_s = 0, release_s = 0;  ///< of the envelope
  std::uint64_t ticks = 0;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;                ///< includes those after the last tick
  std::string not_uploaded;              ///< UploadWatch::missing
  /// Offset of the first damaged byte; nothing is read from there on.
  std::optional<std::uint64_t> damaged_at;
  bool closed = false;  ///< has its last block; otherwise it is still being written, or its writer was killed
  /// If a computer closes the loop and stalls, periods pass without a tick; the times show them.
  std::uint64_t missing_periods = 0;
  std::size_t stops = 0;          ///< sections of over 10 ms of them
  std::uint64_t blind_ticks = 0;  ///< ticks that play without a new count for 10 ms
};

/// Reads the whole session once. `progress` receives fractions. Errors: as SessionReader::open;
/// no_ticks_in; unsuitable, for a session of forces.
schema::Result<SessionOverview> session_overview(const std::string& name,
                                                 const std::function<void(double)>& progress = {});

/// The error for a session without ticks: unsuitable; malformed, with the byte, if it is damaged.
schema::Error no_ticks_in(const std::string& path, const std::optional<std::uint64_t>& damaged_at);

struct SessionRow {
  std::uint64_t tick = 0;
  double time_s = 0;         ///< since the first tick, by the device's clock
  double device_time_s = 0;  ///< time of that clock
  double position_m = 0;     ///< the middle of the encoder's count; continues beyond 2^31
  double drive_v = 0;
  double gain = 1;  ///< factor of the textures' own gains
  std::uint32_t flags = 0;
  std::int32_t encoder = 0;
  std::uint32_t turns = 0;  ///< changes of texture up to this row
  bool put_in = false;      ///< not a tick: fills a period without one
};

/// Makes rows from ticks. Periods without a tick are omitted or filled: place, drive and time are
/// interpolated linearly between the neighbours. A stop over 10 ms is filled as not playing, and with at most
/// `most_filled` rows.
class RowMaker {
 public:
  using Sink = std::function<void(const SessionRow&)>;
  /// The overview must outlive this.
  explicit RowMaker(const SessionOverview& overview, std::uint64_t most_filled = 0);

  /// Passes on the rows up to this tick's, in order.
  void take(const schema::SessionTick& tick, const Sink& sink);
  /// Changes of texture so far.
  const std::vector<TextureChange>& turns() const { return turns_; }
  std::uint64_t rows() const { return rows_; }

 private:
  void begin_at(const schema::SessionTick& tick);
  void count_to(std::int32_t encoder);
  SessionRow row_of(const schema::SessionTick& tick) const;
  void put_in_before(const SessionRow& row, const Sink& sink);
  double time_between(double to_s, std::uint64_t i, std::uint64_t periods, std::uint64_t missing) const;
  void steer(SessionRow& row);

  const SessionOverview& overview_;
  std::uint64_t most_put_in_, rows_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t count_ = 0;  // the encoder's count, continued beyond 2^31
  SessionRow last_;
  double gain_;
  std::uint8_t taken_ = 0;
  std::size_t next_step_ = 0;
  std::vector<TextureChange> turns_;
};

/// Passes each row of a session to `sink`. Errors: as SessionReader::open.
schema::Result<void> read_rows(RowMaker& maker, const std::string& name, const RowMaker::Sink& sink,
                               const std::function<void(double)>& progress = {});

/// The fraction of the file that was read, 0 to 1.
double part_read(const schema::SessionReader& reader);

/// A progress function for a part of the whole, mapped to the range `from` to `to`.
std::function<void(double)> part_of(const std::function<void(double)>& whole, double from, double to);

// The ticks of a session in memory, as columns.

/// One row per tick; all columns have the same length.
struct SessionColumns {
  schema::SessionHeader header;
  std::vector<std::uint64_t> tick;
  std::vector<double> position_m;  ///< as SessionRow::position_m
  std::vector<double> drive_v;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;                ///< includes those after the last tick
};

/// A whole session. Errors: as session_overview; unsuitable: more than 2^24 ticks (28 min at 10 kHz; memory).
schema::Result<SessionColumns> read_session_columns(const std::string& name);

}  // namespace tacto::playback
