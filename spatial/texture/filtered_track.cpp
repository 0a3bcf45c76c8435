// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/filtered_track.hpp"

#include <algorithm>
#include <cassert>

namespace tacto::spatial {

FilteredTrack::FilteredTrack(double sample_rate_hz, const TimeFilter& filter, SpectralGain equaliser,
                             Track track)
    : sample_rate_hz_(sample_rate_hz), filter_(filter), equaliser_(std::move(equaliser)), track_(track) {}

schema::Result<void> FilteredTrack::begin(FrameRange piece) {
  stream_.reset();
  auto stream = BlockTimeFilter::open(sample_rate_hz_, filter_, equaliser_, piece.size());
  TACTO_TRY(stream);
  stream_ = std::move(*stream);
  piece_ = piece;
  next_ = kept_from_ = piece.begin;
  kept_.clear();
  return {};
}

void FilteredTrack::drop_before(std::size_t frame) {
  const std::size_t gone = std::min(frame - kept_from_, kept_.size());
  if (2 * gone < kept_.size())
    return;  // erase half at least, so that moving the rest costs no more than computing it
  kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(gone));
  kept_from_ += gone;
}

schema::Result<void> FilteredTrack::advance(TouchSource& source) {
  if (next_ == piece_.end) {
    stream_->finish(kept_);
    ++next_;
    return {};
  }
  const std::size_t size = std::min(kChunkFrames, piece_.end - next_);
  chunk_.resize(size);
  if (auto done = source.read(track_, next_, chunk_); !done) return done;
  if (auto done = stream_->push(chunk_, kept_); !done) return done;
  next_ += size;
  return {};
}

schema::Result<std::span<const double>> FilteredTrack::values(TouchSource& source, FrameRange piece,
                                                              FrameRange frames) {
  assert(piece.contains(frames));
  const bool goes_on = stream_ && piece.begin == piece_.begin && frames.begin >= kept_from_;
  if (!goes_on) TACTO_TRY(begin(piece));
  drop_before(frames.begin);
  while (kept_from_ + kept_.size() < frames.end) {
    assert(next_ <= piece_.end);
    if (auto done = advance(source); !done) {
      stream_.reset();
      return schema::forward_error(done);
    }
    drop_before(frames.begin);
  }
  return std::span<const double>(kept_).subspan(frames.begin - kept_from_, frames.size());
}

}  // namespace tacto::spatial
