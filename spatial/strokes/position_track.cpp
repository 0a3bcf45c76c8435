// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/position_track.hpp"

#include <cmath>

namespace tacto::spatial {
namespace {

constexpr std::size_t kShortFrames = 1000000;

}  // namespace

schema::Result<PositionTrack> PositionTrack::open(TouchSource& source, std::size_t frames,
                                                  std::span<const schema::Gap> gaps) {
  PositionTrack track(source);
  TACTO_TRY(track.survey(frames, gaps));
  if (frames > kShortFrames) return track;
  std::vector<double> all(frames);
  TACTO_TRY(track.read(0, all));
  track.kept_m_ = std::move(all);
  return track;
}

schema::Result<void> PositionTrack::survey(std::size_t frames, std::span<const schema::Gap> gaps) {
  CounterWrapFinder finder(gaps);
  std::vector<double> chunk(std::min(kChunkFrames, frames));
  const auto add = [&](FrameRange part) -> schema::Result<void> {
    const auto counts = std::span(chunk).first(part.size());
    if (auto done = source_->read_stored(Track::position, part.begin, counts); !done) return done;
    finder.add(counts);
    return {};
  };
  if (auto done = chunk_by_chunk({0, frames}, add); !done) return done;
  const schema::Channel& properties = *source_->channel(Track::position);
  const double counts = std::max(std::abs(finder.lowest()), std::abs(finder.highest()));
  furthest_m_ = counts * std::abs(properties.scale) + std::abs(properties.offset);
  moves_ = finder.lowest() < finder.highest() && properties.scale != 0;
  wraps_ = finder.finish();
  return {};
}

schema::Result<void> PositionTrack::read(std::size_t first, std::span<double> out) const {
  if (!kept_m_.empty()) {
    std::ranges::copy(std::span(kept_m_).subspan(first, out.size()), out.begin());
    return {};
  }
  if (auto done = source_->read_stored(Track::position, first, out); !done) return done;
  wraps_.unwrap(first, out);
  const schema::Channel& properties = *source_->channel(Track::position);
  for (double& value : out) value = properties.physical(value);
  return {};
}

schema::Result<std::vector<double>> PositionTrack::read(FrameRange frames) const {
  std::vector<double> positions(frames.size());
  TACTO_TRY(read(frames.begin, positions));
  return positions;
}

}  // namespace tacto::spatial
