// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as position of the finger and strokes: the input of `spatial`.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "spatial/strokes/frame_range.hpp"
#include "spatial/strokes/monotone_path.hpp"
#include "spatial/strokes/position_facts.hpp"
#include "spatial/strokes/position_jumps.hpp"
#include "spatial/strokes/strokes.hpp"
#include "spatial/strokes/touch_source.hpp"

namespace tacto::spatial {

// Whether the finger was on the surface during a stroke, from the normal force.

/// The smallest normal force that counts as touch: 20 mN, a fifth of the lightest load of touch studies (0.1
/// N) and the weight of 2 g.
inline constexpr double kLightestTouch_n = 0.02;
/// Share of the force of the hardest pressed stroke of the record: the offset that a load cell may have if it
/// was not set to zero.
inline constexpr double kUpShareOfHardest = 0.1;

/// A stroke with a mean normal force below this was made with the finger up: a tenth of the force of the
/// hardest pressed stroke, at least 20 mN. Precondition: the strokes have a normal force.
double finger_up_below_n(std::span<const Stroke> strokes);

/// The reason for users: which of the two thresholds applies.
std::string why_finger_up(double threshold_n);

// Overflows of counters of 16, 24 or 32 bits: the frame of each, and the counts to add from there on.

/// From `frame` on, `turns` x 2^bits counts are added to the stored value.
struct CounterTurn {
  std::size_t frame = 0;
  int turns = 0;
};

/// The wraps of a counter, sorted by frame; `bits` is 0 if it never wrapped.
struct CounterWraps {
  int bits = 0;
  std::vector<CounterTurn> turns;
  /// Adds the missing counts to values that begin at frame `first`.
  void unwrap(std::size_t first, std::span<double> counts) const;
  /// Number of wraps within [begin, end).
  std::size_t count_in(std::size_t begin, std::size_t end) const;
};

/// Finds wraps in the stored numbers of a record, which are added in order. A wrap is a step of 2^16, 2^24 or
/// 2^32 whole counts within a tolerance that follows from the finger's steps before and after it: twice the
/// larger one and 16 counts, over a gap multiplied by its missing frames. The whole record must span fewer
/// counts than that. A counter that was set to 0 by hand is not a wrap, nor is a jump between numbers that
/// are not whole.
class CounterWrapFinder {
 public:
  explicit CounterWrapFinder(std::span<const schema::Gap> gaps) : gaps_(gaps) {}
  void add(std::span<const double> counts);
  /// After the last add(), once.
  CounterWraps finish();
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  // Tests a step of counts into frame `frame`; `before` and `after` are the steps on both sides.
  void judge(double before, double step, double after, std::size_t frame);
  std::uint64_t missing_before(std::size_t frame) const;

  std::span<const schema::Gap> gaps_;
  std::array<std::vector<CounterTurn>, 3> found_;  // of 16, 24, 32 bits
  double lowest_ = 0, highest_ = 0;
  double value_ = 0, step_ = 0, step_before_ = 0;
  std::size_t frames_ = 0;
};

// Short gaps of a recording, filled by interpolation, so that a stroke does not end at them.

/// A longer gap ends a stroke: in frames, and from the frame before it to the frame after it.
inline constexpr std::uint64_t kMostFilledFrames = 4;
inline constexpr double kLongestFilled_s = 0.5e-3;

struct BridgedTouch {
  std::unique_ptr<TouchSource> source;
  schema::RecordingHeader header;  ///< `frames` counts the filled ones, `gaps` are the others
  std::vector<FrameRange> filled;  ///< by frame, in the numbers of `source`
};

/// Fills gaps of at most kMostFilledFrames and kLongestFilled_s: a quarter of a period at the usual upper end
/// of the band, 500 Hz. The value by the cubic through the two frames before and after the gap; of a sine of
/// 500 Hz at 10 kHz its error is 0.2 % of the amplitude for one missing frame, 3 % for four (the remainder of
/// Lagrange's formula: prod |x - x_i| / 24 times the fourth derivative). Position and normal force on the
/// straight line: at 10 m/s^2 the error is below 0.3 um. A gap stays if fewer than two frames are between it
/// and the next one or an end, or if the position moves over it faster than a finger (kFastestFinger_mps).
/// Errors: of reading.
schema::Result<BridgedTouch> bridge_short_gaps(std::unique_ptr<TouchSource> source,
                                               schema::RecordingHeader header);

/// Reads sections of the position. A short record (1e6 frames, 8 MB) is held in memory; of a longer one only
/// what was requested. The source must outlive it.
class PositionTrack {
 public:
  /// Reads the whole record once, to find the wraps of its counter; a short one is not read again. Errors: of
  /// reading.
  static schema::Result<PositionTrack> open(TouchSource& source, std::size_t frames,
                                            std::span<const schema::Gap> gaps);

  /// Positions in m from frame `first` on. Errors: of reading.
  schema::Result<void> read(std::size_t first, std::span<double> out) const;
  schema::Result<std::vector<double>> read(FrameRange frames) const;

  bool moves() const { return moves_; }
  double furthest_m() const { return furthest_m_; }  ///< largest stored |position|, for rounding
  const CounterWraps& wraps() const { return wraps_; }

 private:
  explicit PositionTrack(TouchSource& source) : source_(&source) {}
  /// Stored numbers from frame `first` on.
  void to_metres(std::size_t first, std::span<double> counts) const;

  TouchSource* source_;
  std::vector<double> kept_m_;
  CounterWraps wraps_;
  bool moves_ = false;
  double furthest_m_ = 0;
};

/// Holds the strokes of a record of any length and reads the rest on demand, so it needs little memory. Not
/// shared between threads.
class TouchRecord {
 public:
  /// Reads the position (once; of a long record six times, and once more for each stroke), finds the strokes
  /// and, if there is a normal force, the strokes with the finger up. `channel` (by name) is what is to
  /// become a texture. Errors: unsuitable, without such a channel, without a position or with one that never
  /// moves; of reading.
  static schema::Result<TouchRecord> open(const schema::Recording& recording, const std::string& channel);
  /// From any source; `where` is its name in messages.
  static schema::Result<TouchRecord> open(std::unique_ptr<TouchSource> source, schema::RecordingHeader header,
                                          std::string where);

  const schema::RecordingHeader& header() const { return header_; }
  const schema::Channel& channel() const { return *source_->channel(Track::value); }
  /// The tracks of the value: one, or the three axes that become one signal.
  std::span<const Track> value_tracks() const {
    return std::span(kValueTracks).first(source_->channel(Track::third_axis) == nullptr ? 1 : 3);
  }
  const std::string& where() const { return where_; }  ///< the recording's stem, for messages
  TouchSource& source() const { return *source_; }
  const PositionFacts& facts() const { return facts_; }
  const CounterWraps& counter_wraps() const { return track_->wraps(); }
  PositionError position_error() const { return {facts_.quantum_m, facts_.noise_m}; }

  /// Strokes by time; may be empty.
  const std::vector<Stroke>& strokes() const { return strokes_; }
  /// Number of motions that are too short for a stroke.
  std::size_t short_runs() const { return short_runs_; }
  /// The longest motion, a stroke or not, m.
  double longest_m() const { return longest_m_; }
  /// The force below which the finger is up; absent without a normal force.
  std::optional<double> finger_up_below_n() const { return up_below_n_; }
  /// The steps of the position that are too fast for a finger.
  const std::vector<PositionJump>& jumps() const { return jumps_; }
  /// "the position jumps by 1 m from sample 3999 to 4000, at 0.4 s ..."
  schema::Error refusal(const PositionJump& jump) const;
  /// The sections between gaps that were not filled.
  const std::vector<FrameRange>& pieces() const { return pieces_; }
  /// Short gaps that were filled (bridge_short_gaps). Frames here are numbered with the filled ones.
  const std::vector<FrameRange>& filled() const { return filled_; }
  std::size_t filled_in(FrameRange frames) const;
  /// The frame's number in the recording.
  std::size_t stored_frame(std::size_t frame) const { return frame - filled_in({0, frame}); }

  /// Errors: of reading.
  schema::Result<std::vector<double>> position_m(FrameRange frames) const { return track_->read(frames); }
  double from_s(const Stroke& stroke) const;  ///< time of the first frame
  double to_s(const Stroke& stroke) const;    ///< time of the last frame
  double length_m(const Stroke& stroke) const;
  double mean_speed_mps(const Stroke& stroke) const;
  std::optional<double> mean_normal_force_n(const Stroke& stroke) const { return stroke.force_n; }

  /// The stroke with a number from 1 on. Errors: unsuitable, with the numbers that exist.
  schema::Result<Stroke> stroke(int number) const;
  /// All frames from one time to another, both included. Errors: usage, if the times do not increase;
  /// unsuitable, outside the recording, with a gap or a jump inside, or if the finger reverses, rests, or
  /// moves by less than 20 resolutions of its position; of reading.
  schema::Result<Stroke> section(double from_s, double to_s) const;

 private:
  TouchRecord() = default;
  schema::Result<void> survey();
  void mark_cut_strokes();
  schema::Result<void> weigh(Stroke& stroke) const;
  schema::Result<FrameRange> frames_between(double from_s, double to_s) const;
  schema::Result<void> check_gapless(FrameRange frames) const;
  schema::Result<void> check_jumpless(FrameRange frames) const;
  schema::Result<Stroke> directed(FrameRange frames) const;
  std::string list_of_strokes() const;

  schema::RecordingHeader header_;
  std::string where_;
  std::unique_ptr<TouchSource> source_;
  std::optional<PositionTrack> track_;
  PositionFacts facts_;
  std::vector<FrameRange> filled_, pieces_;
  std::vector<PositionJump> jumps_;
  std::vector<Stroke> strokes_;
  std::size_t short_runs_ = 0;
  double longest_m_ = 0;
  std::optional<double> up_below_n_;
};

}  // namespace tacto::spatial
