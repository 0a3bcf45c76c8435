// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/strokes/position_facts.hpp"

#include <cmath>
#include <vector>

#include "spatial/strokes/smoothed_speed.hpp"

namespace tacto::spatial {
namespace {

constexpr double kDoubleRounding = 1e-12;  // upper limit of the difference between two roundings of doubles
constexpr double kEven = 0.01;  // of the moving samples: fewer changes of step are reversals, not a grid
constexpr double kLongestLag_s = 1e-3;
constexpr std::size_t kEvery = 7;  // samples; enough values for a median, and not a factor of usual rates
const double kSigmaOfMedian = 1 / (0.6745 * std::sqrt(70.0));

}  // namespace

PositionSteps::PositionSteps(double sample_rate_hz) : sample_rate_hz_(sample_rate_hz) {}

void PositionSteps::add(std::span<const double> x, std::size_t count) {
  for (std::size_t i = 0; i < count && i + 2 < x.size(); ++i) {
    const double step = x[i + 1] - x[i];
    steps_.add(std::abs(step));
    changes_.add(std::abs(x[i + 2] - x[i + 1] - step));
  }
  for (std::size_t l = 0; l < kLags.size(); ++l) {
    const std::size_t lag = kLags[l];
    if (lag > 1 && static_cast<double>(lag) > kLongestLag_s * sample_rate_hz_) break;
    for (std::size_t i = 0; i < count && i + 4 * lag < x.size(); i += kEvery)
      bends_[l].add(
          std::abs(x[i] - 4 * x[i + lag] + 6 * x[i + 2 * lag] - 4 * x[i + 3 * lag] + x[i + 4 * lag]));
  }
}

double PositionSteps::quantum_m(double furthest_m) const {
  const double rounding = kDoubleRounding * furthest_m;
  const double moving = static_cast<double>(steps_.count_above(rounding));
  const double uneven = static_cast<double>(changes_.count_above(rounding));
  return uneven > kEven * moving ? changes_.smallest_above(rounding) : 0;
}

double PositionSteps::noise_m(double quantum_m, double furthest_m) const {
  double noise_m = 0;
  for (const LogHistogram& bends : bends_) noise_m = std::max(noise_m, bends.median() * kSigmaOfMedian);
  return noise_m > std::max(quantum_m, kDoubleRounding * furthest_m) ? noise_m : 0;
}

schema::Result<PositionFacts> position_facts(const ReadFrames& read, std::span<const FrameRange> pieces,
                                             double sample_rate_hz, double furthest_m) {
  PositionSteps steps(sample_rate_hz);
  LogHistogram speeds;
  std::vector<double> positions;
  const std::size_t window = speed_window(0, 0, sample_rate_hz);
  const auto count_speed = [&](std::size_t, double speed_mps, double) { speeds.add(std::abs(speed_mps)); };
  for (const FrameRange& piece : pieces) {
    const auto learn = [&](FrameRange part) -> schema::Result<void> {
      positions.resize(std::min(part.end + PositionSteps::kAhead, piece.end) - part.begin);
      if (auto done = read(part.begin, positions); !done) return done;
      steps.add(positions, part.size());
      return {};
    };
    TACTO_TRY(chunk_by_chunk(piece, learn));
    TACTO_TRY(visit_speeds(read, piece, piece, sample_rate_hz, window, count_speed));
  }
  PositionFacts facts;
  facts.quantum_m = steps.quantum_m(furthest_m);
  facts.noise_m = steps.noise_m(facts.quantum_m, furthest_m);
  facts.travelling_mps = speeds.median_by_sum();
  return facts;
}

}  // namespace tacto::spatial
