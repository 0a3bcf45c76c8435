// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as the spatial rooms see it: what was felt and where the finger was, frame by frame, and its
// strokes.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/error.hpp"
#include "data-schema/recording.hpp"
#include "spatial/strokes.hpp"

namespace tacto::spatial {

/// Holds the channels in memory, in SI units.
class TouchRecord {
 public:
  /// Reads `channel` (by name), the position and, where there is one, the normal force, and finds the
  /// strokes. Errors: unsuitable, without such a channel, without a position or with one that never moves; of
  /// reading.
  static schema::Result<TouchRecord> open(const schema::Recording& recording, const std::string& channel);

  const schema::RecordingHeader& header() const { return header_; }
  const schema::Channel& channel() const { return channel_; }
  const std::string& where() const { return where_; }  ///< the recording's stem, for messages
  double quantum_m() const { return quantum_m_; }      ///< of the position; 0 where none shows
  /// Strokes by time; may be none.
  const std::vector<Stroke>& strokes() const { return strokes_; }
  /// The stretches between gaps.
  const std::vector<FrameRange>& pieces() const { return pieces_; }

  std::span<const double> values(FrameRange frames) const;
  std::span<const double> position_m(FrameRange frames) const;
  double from_s(const Stroke& stroke) const;  ///< time of the first frame
  double to_s(const Stroke& stroke) const;    ///< time of the last frame
  double length_m(const Stroke& stroke) const;
  double mean_speed_mps(const Stroke& stroke) const;
  std::optional<double> mean_normal_force_n(const Stroke& stroke) const;

  /// The stroke of a 1-based number. Errors: unsuitable, with those there are.
  schema::Result<Stroke> stroke(int number) const;
  /// All frames from one time to another, both included. Errors: usage, where they do not rise;
  /// unsuitable, outside of the recording, with a gap inside, or where the finger turns round or stays where
  /// it is.
  schema::Result<Stroke> stretch(double from_s, double to_s) const;

 private:
  TouchRecord() = default;
  schema::Result<void> read(const schema::Recording& recording);
  schema::Result<FrameRange> frames_between(double from_s, double to_s) const;
  schema::Result<void> check_gapless(FrameRange frames) const;
  schema::Result<Stroke> directed(FrameRange frames) const;
  std::string list_of_strokes() const;

  schema::RecordingHeader header_;
  schema::Channel channel_;
  std::string where_;
  std::vector<double> position_m_, values_, normal_force_n_;
  std::vector<FrameRange> pieces_;
  std::vector<Stroke> strokes_;
  double quantum_m_ = 0;
};

}  // namespace tacto::spatial
