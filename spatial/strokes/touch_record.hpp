// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as the spatial rooms see it: where the finger was, and its strokes.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "spatial/strokes/monotone_path.hpp"
#include "spatial/strokes/position_facts.hpp"
#include "spatial/strokes/position_jumps.hpp"
#include "spatial/strokes/position_track.hpp"
#include "spatial/strokes/strokes.hpp"
#include "spatial/strokes/touch_source.hpp"

namespace tacto::spatial {

/// Knows a record of any length by its strokes, and reads the rest when it is asked for: little memory, and
/// not shared between threads.
class TouchRecord {
 public:
  /// Reads the position (six times, once more for each stroke), finds the strokes, and where there is a
  /// normal force tells those with the finger up. `channel` (by name) is what is to become a texture. Errors:
  /// unsuitable, without such a channel, without a position or with one that never moves; of reading.
  static schema::Result<TouchRecord> open(const schema::Recording& recording, const std::string& channel);
  /// From any source; `where` names it in messages.
  static schema::Result<TouchRecord> open(std::unique_ptr<TouchSource> source, schema::RecordingHeader header,
                                          std::string where);

  const schema::RecordingHeader& header() const { return header_; }
  const schema::Channel& channel() const { return *source_->channel(Track::value); }
  const std::string& where() const { return where_; }  ///< the recording's stem, for messages
  TouchSource& source() const { return *source_; }
  const PositionFacts& facts() const { return facts_; }
  const CounterWraps& counter_wraps() const { return track_->wraps(); }
  PositionError position_error() const { return {facts_.quantum_m, facts_.noise_m}; }

  /// Strokes by time; may be none.
  const std::vector<Stroke>& strokes() const { return strokes_; }
  /// Runs that are no strokes for being shorter than 5 % of the longest.
  std::size_t short_runs() const { return short_runs_; }
  /// What tells the finger up; absent without a normal force.
  std::optional<double> finger_up_below_n() const { return up_below_n_; }
  /// Where the position steps as no finger does.
  const std::vector<PositionJump>& jumps() const { return jumps_; }
  /// "the position jumps by 1 m from sample 3999 to 4000, at 0.4 s ..."
  schema::Error refusal(const PositionJump& jump) const;
  /// The stretches between gaps.
  const std::vector<FrameRange>& pieces() const { return pieces_; }

  /// Errors: of reading.
  schema::Result<std::vector<double>> position_m(FrameRange frames) const { return track_->read(frames); }
  double from_s(const Stroke& stroke) const;  ///< time of the first frame
  double to_s(const Stroke& stroke) const;    ///< time of the last frame
  double length_m(const Stroke& stroke) const;
  double mean_speed_mps(const Stroke& stroke) const;
  std::optional<double> mean_normal_force_n(const Stroke& stroke) const { return stroke.force_n; }

  /// The stroke of a 1-based number. Errors: unsuitable, with those there are.
  schema::Result<Stroke> stroke(int number) const;
  /// All frames from one time to another, both included. Errors: usage, where they do not rise;
  /// unsuitable, outside of the recording, with a gap or a jump inside, or where the finger turns round,
  /// stays where it is, or moves by less than 20 resolutions of its position; of reading.
  schema::Result<Stroke> stretch(double from_s, double to_s) const;

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
  std::vector<FrameRange> pieces_;
  std::vector<PositionJump> jumps_;
  std::vector<Stroke> strokes_;
  std::size_t short_runs_ = 0;
  std::optional<double> up_below_n_;
};

}  // namespace tacto::spatial
