// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/fit/outlier.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "data-schema/base/statistics.hpp"

namespace tacto::analysis {
namespace {

constexpr double kTakes = 0.1;
constexpr double kNeverNoise = 1e-9;   // of tables
constexpr double kParameters = 4;      // longer models have more; then the test is a little too strict
constexpr std::size_t kTried = 3;      // of each kind of suspect
constexpr std::ptrdiff_t kBeside = 2;  // neighbours to each side

// Logarithmic distance of each amplitude from the median of its neighbours and itself.
std::vector<double> off_neighbours(const BodeData& data) {
  std::vector<double> off, sizes;
  for (const auto& value : data.response) sizes.push_back(std::abs(value));
  const auto count = static_cast<std::ptrdiff_t>(sizes.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const auto from = std::clamp<std::ptrdiff_t>(i - kBeside, 0, count - 2 * kBeside - 1);
    std::vector<double> near(sizes.begin() + from, sizes.begin() + from + 2 * kBeside + 1);
    off.push_back(
        std::abs(std::log(sizes[static_cast<std::size_t>(i)] / schema::upper_median(std::span(near)))));
  }
  return off;
}

void add_largest(std::span<const double> values, std::vector<std::size_t>& list) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::partial_sort(order, order.begin() + kTried, std::greater{},
                            [&](std::size_t i) { return values[i]; });
  list.insert(list.end(), order.begin(), order.begin() + kTried);
}

// With two values fewer, left^((2 n - p - 2) / 2) is the probability of the F test.
bool is_never_noise(const BodeData& data, const RestOfFit& rest, double part_left) {
  const double n = static_cast<double>(data.size()), freedom = 2 * n - kParameters - 2;
  return data.noise_from_residuals && rest.is_noise && n * std::pow(part_left, freedom / 2) < kNeverNoise;
}

}  // namespace

BodeData without_value(const BodeData& data, std::size_t index) {
  std::vector<std::size_t> kept(data.size());
  std::iota(kept.begin(), kept.end(), std::size_t{0});
  std::erase(kept, index);
  return part_of(data, kept);
}

std::optional<Outlier> outlier_of(const BodeData& data, std::span<const double> shares, double left_by_all,
                                  const LeftByFit& left_by_fit) {
  if (data.size() < 2 * kLeastFrequencies) return std::nullopt;
  std::vector<std::size_t> suspects;
  add_largest(shares, suspects);
  add_largest(off_neighbours(data), suspects);
  std::ranges::sort(suspects);
  const auto same = std::ranges::unique(suspects);
  suspects.erase(same.begin(), same.end());
  std::optional<Outlier> found;
  for (const std::size_t index : suspects) {
    const RestOfFit rest = left_by_fit(without_value(data, index));
    const double left = rest.left / left_by_all;
    const bool takes = left < kTakes || is_never_noise(data, rest, left);
    if (takes && (!found || left < found->left)) found = Outlier{index, left, rest};
  }
  return found;
}

}  // namespace tacto::analysis
