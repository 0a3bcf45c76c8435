// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/resample/hermite_resampler.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "spatial/dsp/fourier/simd_clones.hpp"
#include "spatial/dsp/resample/hermite.hpp"
#include "spatial/dsp/resample/hermite_inverse.hpp"

namespace tacto::spatial {
namespace {

// Two of Halley's steps from the secant are accurate to 12 digits if the slopes at the ends of a segment are
// within this factor of its secant.
constexpr double kSteepest = 1.5;
// Number of places that are solved together, and number of places of one segment that are written at once: a
// little more than a usual segment has, because writing too many costs less than counting them.
constexpr std::size_t kBlock = 256, kLanes = 8;

// c1 u + c2 u^2 + c3 u^3; plus c0 for a value.
struct Cubic {
  double c0, c1, c2, c3;
};

TACTO_SIMD_INLINE Cubic cubic_of(const HermiteSegment& s) {
  const double dy = s.y1 - s.y0;
  return {s.y0, s.m0, 3 * dy - 2 * s.m0 - s.m1, s.m0 + s.m1 - 2 * dy};
}

// Places that are solved together: for each its fraction of the height of its segment, and the cubics of
// position and value.
struct Block {
  using Column = double[kBlock + kLanes];
  Column target, c1, c2, c3, value0, value1, value2, value3;
  std::size_t begin = 0;
};

TACTO_SIMD_CLONES
void solve(const Block& block, std::size_t count, double* out) {
  for (std::size_t k = 0; k < count; ++k) {
    const double target = block.target[k], c1 = block.c1[k], c2 = block.c2[k], c3 = block.c3[k];
    double u = target;
    for (int step = 0; step < 2; ++step) {
      const double miss = u * (c1 + u * (c2 + u * c3)) - target;
      const double slope = c1 + u * (2 * c2 + u * (3 * c3)), bend = c2 + u * (3 * c3);
      u -= miss * slope / (slope * slope - miss * bend);
    }
    out[k] = block.value0[k] + u * (block.value1[k] + u * (block.value2[k] + u * block.value3[k]));
  }
}

TACTO_SIMD_INLINE void fill(double* lanes, double value) {
  for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = value;
}

// The lanes that were written beyond a full block become the first of the next one.
TACTO_SIMD_INLINE void carry_over(Block& block) {
  for (double* column :
       {block.target, block.c1, block.c2, block.c3, block.value0, block.value1, block.value2, block.value3})
    std::copy_n(column + kBlock, kLanes, column);
  block.begin += kBlock;
}

// The inputs of walk().
struct Curves {
  std::span<const double> t, x, x_slopes, values, value_slopes;
  double margin;

  HermiteSegment way(std::size_t i) const {
    const double h = t[i + 1] - t[i];
    return {x[i], x[i + 1], x_slopes[i] * h, x_slopes[i + 1] * h};
  }
  HermiteSegment value(std::size_t i) const {
    return {values[i], values[i + 1], value_slopes[i], value_slopes[i + 1]};
  }
  double value_at(double time) const {
    const double place = time + margin;
    const double i = std::clamp(std::floor(place), 0.0, static_cast<double>(values.size() - 2));
    return value(static_cast<std::size_t>(i)).value(place - i);
  }
};

// One segment of S_x, scaled to width 1 and height 1, with the segment of S_f at the same time.
struct Piece {
  Cubic way, value;
  double per_x;
  bool easy;
};

TACTO_SIMD_INLINE Piece piece_of(const Curves& curves, std::size_t i) {
  const HermiteSegment way = curves.way(i);
  const double per_x = 1 / (way.y1 - way.y0), m0 = way.m0 * per_x, m1 = way.m1 * per_x;
  const double place = curves.t[i] + curves.margin;
  const auto k = std::min(static_cast<std::size_t>(place), curves.values.size() - 2);
  const auto gentle = [](double m) { return m * kSteepest > 1 && m < kSteepest; };
  // A rounding error can move places of the end segments outside the knots; these are solved and clamped one
  // by one.
  const bool inner = i > 0 && i + 2 < curves.t.size();
  const bool one_sample = static_cast<double>(k) == place && curves.t[i + 1] - curves.t[i] == 1;
  return {cubic_of({0, 1, m0, m1}), cubic_of(curves.value(k)), per_x,
          inner && one_sample && gentle(m0) && gentle(m1)};
}

// `target` is the fraction of the segment's height at the first place, `step` the distance between places.
TACTO_SIMD_INLINE void write_lanes(Block& block, std::size_t at, const Piece& piece, double target,
                                   double step) {
  for (std::size_t k = 0; k < kLanes; ++k) block.target[at + k] = target + static_cast<double>(k) * step;
  fill(block.c1 + at, piece.way.c1);
  fill(block.c2 + at, piece.way.c2);
  fill(block.c3 + at, piece.way.c3);
  fill(block.value0 + at, piece.value.c0);
  fill(block.value1 + at, piece.value.c1);
  fill(block.value2 + at, piece.value.c2);
  fill(block.value3 + at, piece.value.c3);
}

// The first place beyond x, except for rounding: at a knot both segments give the same value.
TACTO_SIMD_INLINE std::size_t places_up_to(double x, const EvenPlaces& places, double per_pitch) {
  const double last = x * per_pitch - places.first;
  if (!(last >= 0)) return 0;
  return last < static_cast<double>(places.count) ? static_cast<std::size_t>(last) + 1 : places.count;
}

// Solves all places except those that it adds to `hard`.
TACTO_SIMD_CLONES
void walk(const Curves& curves, const EvenPlaces& places, double* out, std::vector<IterativePlaces>& hard) {
  const double per_pitch = 1 / places.pitch;
  const std::size_t last = curves.t.size() - 2;
  Block block;
  std::size_t k = 0;
  for (std::size_t i = 0; i <= last && k < places.count; ++i) {
    const std::size_t end = i == last ? places.count : places_up_to(curves.x[i + 1], places, per_pitch);
    if (end <= k) continue;
    const Piece piece = piece_of(curves, i);
    if (!piece.easy) hard.push_back({k, end, i});
    while (k < end) {
      const double target = (places.at(k) - curves.x[i]) * piece.per_x;
      write_lanes(block, k - block.begin, piece, target, places.pitch * piece.per_x);
      k = std::min(end, k + kLanes);
      if (k - block.begin < kBlock) continue;
      solve(block, kBlock, out + block.begin);
      carry_over(block);
    }
  }
  solve(block, k - block.begin, out + block.begin);
}

}  // namespace

void HermiteResampler::operator()(std::span<const double> t, std::span<const double> x,
                                  std::span<const double> values, std::size_t margin,
                                  const EvenPlaces& places, std::span<double> out) {
  assert(t.size() == x.size() && t.size() >= 2 && values.size() >= 2 && out.size() == places.count);
  x_slopes_.resize(x.size());
  value_slopes_.resize(values.size());
  hermite_slopes(t, x, x_slopes_);
  hermite_slopes_uniform(1, values, value_slopes_);
  const Curves curves{t, x, x_slopes_, values, value_slopes_, static_cast<double>(margin)};
  hard_.clear();
  walk(curves, places, out.data(), hard_);
  for (const auto [begin, end, i] : hard_)
    for (std::size_t k = begin; k < end; ++k)
      out[k] = curves.value_at(t[i] + solve_segment(curves.way(i), places.at(k)) * (t[i + 1] - t[i]));
}

}  // namespace tacto::spatial
