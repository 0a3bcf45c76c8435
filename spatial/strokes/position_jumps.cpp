// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/position_jumps.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/numbers/log_histogram.hpp"

namespace tacto::spatial {
namespace {

constexpr double kLongestHold_s = 0.05;
constexpr double kOfMedianStep = 20;
constexpr double kRare = 0.01;

// Calls visit(frame, step) for each frame of a piece except the first.
template <class Visit>
schema::Result<void> visit_steps(const ReadFrames& read, FrameRange piece, const Visit& visit) {
  std::vector<double> positions;
  return chunk_by_chunk(piece, [&](FrameRange part) -> schema::Result<void> {
    const std::size_t begin = part.begin == piece.begin ? part.begin : part.begin - 1;
    positions.resize(part.end - begin);
    if (auto done = read(begin, positions); !done) return done;
    for (std::size_t i = 1; i < positions.size(); ++i) visit(begin + i, positions[i] - positions[i - 1]);
    return {};
  });
}

schema::Result<double> largest_step(const ReadFrames& read, std::span<const FrameRange> pieces) {
  double largest = 0;
  const auto visit = [&](std::size_t, double step) { largest = std::max(largest, std::abs(step)); };
  for (const FrameRange& piece : pieces) TACTO_TRY(visit_steps(read, piece, visit));
  return largest;
}

schema::Result<LogHistogram> moving_steps(const ReadFrames& read, std::span<const FrameRange> pieces) {
  LogHistogram steps;
  const auto visit = [&](std::size_t, double step) {
    if (step != 0) steps.add(std::abs(step));
  };
  for (const FrameRange& piece : pieces) TACTO_TRY(visit_steps(read, piece, visit));
  return steps;
}

}  // namespace

schema::Result<std::vector<PositionJump>> find_position_jumps(const ReadFrames& read,
                                                              std::span<const FrameRange> pieces,
                                                              double sample_rate_hz) {
  std::vector<PositionJump> jumps;
  const auto largest = largest_step(read, pieces);
  TACTO_TRY(largest);
  if (*largest <= kFastestFinger_mps / sample_rate_hz) return jumps;
  const auto steps = moving_steps(read, pieces);
  TACTO_TRY(steps);
  const double least_m = kOfMedianStep * steps->median();
  const double hold = std::max(1.0, kLongestHold_s * sample_rate_hz);
  for (const FrameRange& piece : pieces) {
    std::size_t changed = piece.begin;
    const auto visit = [&](std::size_t frame, double step) {
      if (step == 0) return;
      const double held = std::min(static_cast<double>(frame - changed), hold);
      changed = frame;
      if (std::abs(step) > std::max(least_m, kFastestFinger_mps * held / sample_rate_hz))
        jumps.push_back({frame, step});
    };
    TACTO_TRY(visit_steps(read, piece, visit));
  }
  const bool rare =
      static_cast<double>(jumps.size()) <= std::max(1.0, kRare * static_cast<double>(steps->count()));
  return rare ? jumps : std::vector<PositionJump>{};
}

std::vector<FrameRange> pieces_between_jumps(std::span<const FrameRange> pieces,
                                             std::span<const PositionJump> jumps) {
  std::vector<FrameRange> cut;
  auto jump = jumps.begin();
  for (FrameRange piece : pieces) {
    for (; jump != jumps.end() && jump->frame < piece.end; ++jump) {
      cut.push_back({piece.begin, jump->frame});
      piece.begin = jump->frame;
    }
    cut.push_back(piece);
  }
  return cut;
}

}  // namespace tacto::spatial
