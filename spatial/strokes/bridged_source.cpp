// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/bridged_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "data-schema/base/lagrange.hpp"
#include "spatial/strokes/position_jumps.hpp"

namespace tacto::spatial {
namespace {

using schema::Result;

constexpr std::array kTracks = {Track::position, Track::value, Track::normal_force};
constexpr std::size_t kBeside = 2;  // frames on each side of a gap

struct Bridge {
  std::size_t first = 0;   // in the numbers of the bridged source
  std::size_t count = 0;   // filled frames
  std::size_t stored = 0;  // the frame behind the gap, in the numbers of the recording
  std::array<std::vector<double>, kTracks.size()> values = {};  // by Track

  std::size_t end() const { return first + count; }
};

class BridgedSource : public TouchSource {
 public:
  BridgedSource(std::unique_ptr<TouchSource> stored, std::vector<Bridge> bridges)
      : stored_(std::move(stored)), bridges_(std::move(bridges)) {}

  const schema::Channel* channel(Track track) const override { return stored_->channel(track); }

  Result<void> read_stored(Track track, std::size_t first, std::span<double> out) override {
    const std::size_t end = first + out.size();
    for (std::size_t at = first; at < end;) {
      const auto next = std::ranges::upper_bound(bridges_, at, {}, &Bridge::first);
      const Bridge& before = next == bridges_.begin() ? none_ : *std::prev(next);
      if (at < before.end()) {
        out[at - first] = before.values[static_cast<std::size_t>(track)][at - before.first];
        ++at;
        continue;
      }
      const std::size_t until = next == bridges_.end() ? end : std::min(end, next->first);
      const std::size_t stored = at - before.end() + before.stored;
      TACTO_TRY(stored_->read_stored(track, stored, out.subspan(at - first, until - at)));
      at = until;
    }
    return {};
  }

 private:
  std::unique_ptr<TouchSource> stored_;
  std::vector<Bridge> bridges_;
  const Bridge none_ = {};
};

Result<Bridge> filled(TouchSource& source, const schema::Gap& gap, std::size_t before) {
  Bridge bridge{gap.frame + before, gap.count, gap.frame};
  const auto missing = static_cast<double>(gap.count);
  for (const Track track : kTracks) {
    if (source.channel(track) == nullptr) continue;
    std::array<double, 2 * kBeside> y{};
    TACTO_TRY(source.read_stored(track, gap.frame - kBeside, y));
    for (std::size_t i = 1; i <= gap.count; ++i) {
      const auto x = static_cast<double>(i);
      bridge.values[static_cast<std::size_t>(track)].push_back(
          track == Track::value ? schema::lagrange({-1, 0, missing + 1, missing + 2}, y, x)
                                : std::lerp(y[1], y[2], x / (missing + 1)));
    }
  }
  return bridge;
}

double across_s(const schema::Gap& gap, double sample_rate_hz) {
  return static_cast<double>(gap.count + 1) / sample_rate_hz;
}

bool can_be_filled(const schema::RecordingHeader& header, std::size_t i) {
  constexpr double kRounding = 1 + 1e-9;
  const schema::Gap& gap = header.gaps[i];
  const std::uint64_t from = i == 0 ? 0 : header.gaps[i - 1].frame;
  const std::uint64_t to = i + 1 == header.gaps.size() ? header.frames : header.gaps[i + 1].frame;
  return gap.count <= kMostFilledFrames &&
         across_s(gap, header.sample_rate_hz) <= kRounding * kLongestFilled_s &&
         from + kBeside <= gap.frame && gap.frame + kBeside <= to;
}

Result<bool> moves_as_a_finger(TouchSource& source, const schema::Gap& gap, double sample_rate_hz) {
  std::array<double, 2> position_m{};
  TACTO_TRY(source.read(Track::position, gap.frame - 1, position_m));
  return std::abs(position_m[1] - position_m[0]) <= kFastestFinger_mps * across_s(gap, sample_rate_hz);
}

}  // namespace

Result<BridgedTouch> bridge_short_gaps(std::unique_ptr<TouchSource> source, schema::RecordingHeader header) {
  std::vector<Bridge> bridges;
  std::vector<FrameRange> ranges;
  std::vector<schema::Gap> left;
  std::size_t before = 0;
  for (std::size_t i = 0; i < header.gaps.size(); ++i) {
    const schema::Gap& gap = header.gaps[i];
    bool bridged = can_be_filled(header, i);
    if (bridged) {
      const auto moves = moves_as_a_finger(*source, gap, header.sample_rate_hz);
      TACTO_TRY(moves);
      bridged = *moves;
    }
    if (!bridged) {
      left.push_back({gap.frame + before, gap.device_sequence, gap.count});
      continue;
    }
    auto bridge = filled(*source, gap, before);
    TACTO_TRY(bridge);
    ranges.push_back({bridge->first, bridge->end()});
    before += gap.count;
    bridges.push_back(std::move(*bridge));
  }
  if (bridges.empty()) return BridgedTouch{std::move(source), std::move(header), {}};
  header.frames += before;
  header.gaps = std::move(left);
  return BridgedTouch{std::make_unique<BridgedSource>(std::move(source), std::move(bridges)),
                      std::move(header), std::move(ranges)};
}

}  // namespace tacto::spatial
