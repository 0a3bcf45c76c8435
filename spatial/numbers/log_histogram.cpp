// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/numbers/log_histogram.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace tacto::spatial {
namespace {

// The exponent and the first 6 bits of a double's mantissa are its bin, so no logarithm is computed.
constexpr int kMantissaBits = 6, kShift = 52 - kMantissaBits;
constexpr double kSmallest = 0x1p-80, kLargest = 0x1p40;
constexpr std::uint64_t kFirst = std::bit_cast<std::uint64_t>(kSmallest) >> kShift;
constexpr std::uint64_t kLast = std::bit_cast<std::uint64_t>(kLargest) >> kShift;

std::size_t bin_of(double size) {
  return static_cast<std::size_t>((std::bit_cast<std::uint64_t>(std::min(size, kLargest)) >> kShift) -
                                  kFirst);
}

}  // namespace

LogHistogram::LogHistogram() : bins_(kLast - kFirst + 1) {}

void LogHistogram::add(double size) {
  if (size < kSmallest) {
    ++zeros_;
    return;
  }
  Bin& bin = bins_[bin_of(size)];
  bin.smallest = bin.count == 0 ? size : std::min(bin.smallest, size);
  ++bin.count;
  bin.sum += size;
}

std::uint64_t LogHistogram::above_zero() const {
  return std::accumulate(bins_.begin(), bins_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Bin& bin) { return sum + bin.count; });
}

double LogHistogram::median() const {
  const std::uint64_t half = (count() + 1) / 2;
  std::uint64_t below = zeros_;
  if (below >= half) return 0;
  for (const Bin& bin : bins_) {
    below += bin.count;
    if (below >= half) return bin.mean();
  }
  return 0;
}

double LogHistogram::median_by_sum() const {
  const double half = std::accumulate(bins_.begin(), bins_.end(), 0.0,
                                      [](double sum, const Bin& bin) { return sum + bin.sum; }) /
                      2;
  double below = 0;
  for (const Bin& bin : bins_) {
    below += bin.sum;
    if (bin.count > 0 && below >= half) return bin.mean();
  }
  return 0;
}

double LogHistogram::smallest_above(double limit) const {
  for (const Bin& bin : bins_)
    if (bin.count > 0 && bin.mean() > limit) return bin.smallest;
  return std::numeric_limits<double>::infinity();
}

std::uint64_t LogHistogram::count_above(double limit) const {
  std::uint64_t above = 0;
  for (const Bin& bin : bins_)
    if (bin.count > 0 && bin.mean() > limit) above += bin.count;
  return above;
}

}  // namespace tacto::spatial
