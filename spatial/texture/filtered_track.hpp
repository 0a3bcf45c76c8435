// SPDX-License-Identifier: GPL-3.0-or-later
// A record's values after the band-pass in time, of the strokes that are asked for only.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "spatial/strokes/frame_range.hpp"
#include "spatial/strokes/touch_source.hpp"
#include "spatial/texture/block_time_filter.hpp"

namespace tacto::spatial {

/// Filters what lies between two gaps, as one, and holds what is asked for. Stretches that come by time are
/// the fast way: one that begins before the last begins its piece again. The source must outlive it.
class FilteredTrack {
 public:
  FilteredTrack(TouchSource& source, double sample_rate_hz, const TimeFilter& filter, SpectralGain equaliser);

  /// Filtered values of `frames`, which lie in `piece`, a stretch between two gaps; good until the next call.
  /// Errors: of check(filter, sample_rate_hz); of reading.
  schema::Result<std::span<const double>> values(FrameRange piece, FrameRange frames);

 private:
  schema::Result<void> begin(FrameRange piece);
  void forget_before(std::size_t frame);
  schema::Result<void> advance();

  TouchSource* source_;
  double sample_rate_hz_;
  TimeFilter filter_;
  SpectralGain equaliser_;
  FrameRange piece_;
  std::optional<BlockTimeFilter> stream_;
  std::size_t next_ = 0;       // the frame to feed next
  std::size_t kept_from_ = 0;  // the frame of kept_[0]
  std::vector<double> kept_, chunk_;
};

}  // namespace tacto::spatial
