// SPDX-License-Identifier: GPL-3.0-or-later
// A session row by row, in memory that its length has no part in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/session/session_reader.hpp"

namespace tacto::playback {

/// The encoder counts in which a device reads a texture; elsewhere its drive is zero (core::reach_counts).
struct ProfileReach {
  std::int32_t origin_count = 0;
  std::int64_t counts = INT64_MAX;  ///< to either side; older sessions may not say

  bool holds(std::int32_t encoder) const;
};

/// A change of texture.
struct TextureTurn {
  std::uint64_t row = 0;                         ///< the first that another texture is in
  double fade_ticks = 0;                         ///< over which it comes in (core::TexturePlayer)
  std::optional<schema::SessionProgram> brings;  ///< none: the session does not say, as older ones
  double time_s = 0;                             ///< of that row
  ProfileReach reach = {};
};

/// A command that steers, in the order of the session.
struct SteeringStep {
  std::optional<double> gain;       ///< the factor on the textures' own gains, where it is a gain
  std::optional<TextureTurn> turn;  ///< where it is a change, its row yet to be found
};

/// What has to be known of a session before its first row.
struct SessionOverview {
  schema::SessionHeader header;
  std::string path;
  std::vector<SteeringStep> steps;
  ProfileReach reach;                ///< of the textures that it begins with
  double look_ahead_ticks = 0;       ///< the drive is of where the finger will be then
  float onset_s = 0, release_s = 0;  ///< in which it rises and falls
  std::uint64_t ticks = 0;
  std::optional<std::uint64_t> lost_at;  ///< the first tick that is missing
  std::uint64_t lost = 0;                ///< also after the last one
  std::string not_uploaded;              ///< UploadWatch::missing
  /// The byte from which on the file is damaged; what comes after it is not read.
  std::optional<std::uint64_t> damaged_at;
  bool closed = false;  ///< by its last block; else its writer is still at it, or was killed
  /// A computer that closes the loop may stand still: then periods pass without a tick, as the times tell.
  std::uint64_t missing_periods = 0;
  std::size_t stops = 0;          ///< stretches of over 10 ms of them
  std::uint64_t blind_ticks = 0;  ///< that play, in which no count had come for 10 ms
};

/// Reads all of it once. `progress` hears fractions. Errors: as SessionReader::open; no_ticks_in.
schema::Result<SessionOverview> session_overview(const std::string& name,
                                                 const std::function<void(double)>& progress = {});

/// What to say of a session without a tick: unsuitable; malformed where it is damaged, from a byte on.
schema::Error no_ticks_in(const std::string& path, const std::optional<std::uint64_t>& damaged_at);

struct SessionRow {
  std::uint64_t tick = 0;
  double time_s = 0;         ///< since the first tick, by the device's clock
  double device_time_s = 0;  ///< what that clock says
  double position_m = 0;     ///< the middle of the encoder's count, which may have passed 2^31
  double drive_v = 0;
  double gain = 1;  ///< factor on the textures' own gains
  std::uint32_t flags = 0;
  std::int32_t encoder = 0;
  std::uint32_t turns = 0;  ///< changes of texture up to this row
  bool put_in = false;      ///< no tick: a period that passed without one
};

/// Makes rows of ticks. Periods that passed without a tick are left out, or put in: place, drive and time on
/// a line between the neighbours, of a stop over 10 ms as not playing, and of one stop at most so many.
class RowMaker {
 public:
  using Sink = std::function<void(const SessionRow&)>;
  /// The overview stays where it is.
  explicit RowMaker(const SessionOverview& overview, std::uint64_t most_put_in = 0);

  /// Rows up to this tick's, in their order.
  void take(const schema::SessionTick& tick, const Sink& sink);
  /// Changes of texture so far.
  const std::vector<TextureTurn>& turns() const { return turns_; }
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
  std::int64_t count_ = 0;  // the encoder's, its turns of 2^32 counted
  SessionRow last_;
  double gain_;
  std::uint8_t taken_ = 0;
  std::size_t next_step_ = 0;
  std::vector<TextureTurn> turns_;
};

/// Every row of a session, into `sink`. Errors: as SessionReader::open.
schema::Result<void> read_rows(RowMaker& maker, const std::string& name, const RowMaker::Sink& sink,
                               const std::function<void(double)>& progress = {});

/// How far a reader has come, 0 to 1.
double part_read(const schema::SessionReader& reader);

/// What hears of a whole hears of a part of it, which goes from `from` to `to`.
std::function<void(double)> part_of(const std::function<void(double)>& whole, double from, double to);

}  // namespace tacto::playback
