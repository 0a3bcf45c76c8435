// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/band_share.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "spatial/texture/filtered_track.hpp"

namespace tacto::spatial {
namespace {

double square_sum(std::span<const double> values, double about) {
  double sum = 0;
  for (const double value : values) sum += (value - about) * (value - about);
  return sum;
}

double share_of(std::span<const double> taken, std::span<const double> passed) {
  const double mean = std::accumulate(taken.begin(), taken.end(), 0.0) / static_cast<double>(taken.size());
  const double all = square_sum(passed, 0);
  return all > 0 ? std::sqrt(square_sum(taken, mean) / all) : 0;
}

schema::Result<BandShare> share_of_stroke(const TouchRecord& record, FilteredTrack& filtered,
                                          FrameRange frames) {
  const auto holds = [&](const FrameRange& piece) { return piece.contains(frames); };
  const auto piece = std::ranges::find_if(record.pieces(), holds);
  if (piece == record.pieces().end())
    return schema::fail(schema::ErrorKind::unsuitable, "frames are missing inside the stroke",
                        record.where());
  const auto passed = filtered.values(record.source(), *piece, frames);
  TACTO_TRY(passed);
  std::vector<double> taken(frames.size());
  TACTO_TRY(record.source().read(Track::value, frames.begin, taken));
  for (std::size_t i = 0; i < taken.size(); ++i) taken[i] -= (*passed)[i];
  const std::size_t quarter = taken.size() / 4, half = taken.size() - 2 * quarter;
  return BandShare{share_of(taken, *passed),
                   share_of(std::span(taken).subspan(quarter, half), passed->subspan(quarter, half))};
}

}  // namespace

schema::Result<BandShare> band_share(const TouchRecord& record, const TimeFilter& filter,
                                     std::span<const Stroke> strokes) {
  FilteredTrack filtered(record.header().sample_rate_hz, filter, {});
  BandShare worst;
  for (const Stroke& stroke : strokes) {
    const auto share = share_of_stroke(record, filtered, stroke.frames);
    TACTO_TRY(share);
    worst.whole = std::max(worst.whole, share->whole);
    worst.inside = std::max(worst.inside, share->inside);
  }
  return worst;
}

}  // namespace tacto::spatial
