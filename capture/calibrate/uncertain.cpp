// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/calibrate/uncertain.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "data-schema/base/statistics.hpp"

namespace tacto::capture {
namespace {

constexpr std::size_t kBlocks = 20;
constexpr std::uint64_t kTopBit = 1ULL << 62U;

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double squares_about(std::span<const double> values, double centre) {
  double sum = 0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum;
}

std::vector<double> block_means(std::span<const double> samples) {
  const std::size_t length = samples.size() / kBlocks;
  std::vector<double> means;
  for (std::size_t i = 0; i < kBlocks; ++i) means.push_back(mean(samples.subspan(i * length, length)));
  return means;
}

double scatter(std::span<const double> values) {
  return std::sqrt(squares_about(values, mean(values)) / static_cast<double>(values.size() - 1));
}

double scatter_within(std::span<const double> samples, const std::vector<double>& means) {
  const std::size_t length = samples.size() / kBlocks;
  double sum = 0;
  for (std::size_t i = 0; i < kBlocks; ++i)
    sum += squares_about(samples.subspan(i * length, length), means[i]);
  return std::sqrt(sum / static_cast<double>(kBlocks * length));
}

}  // namespace

double coverage_factor_95(double degrees_of_freedom) {
  return schema::student_t(degrees_of_freedom, schema::kTwoSided95);
}

double step_of(std::span<const double> samples) {
  std::uint64_t step = 0;
  for (const double sample : samples) {
    const double away = std::abs(sample - samples.front());
    if (away != std::floor(away) || away > 0x1p53) return 1;
    step = std::gcd(step, static_cast<std::uint64_t>(away));
  }
  if (step == 0) step = std::gcd(static_cast<std::uint64_t>(std::abs(samples.front())), kTopBit);
  return step == kTopBit ? 0 : static_cast<double>(step);
}

Uncertain mean_of(std::span<const double> samples) {
  const std::vector<double> means = block_means(samples);
  const double step = step_of(samples), noise = scatter(means) / std::sqrt(kBlocks);
  const double steps = step > 0 ? scatter_within(samples, means) / step : 0;
  const double rounding = step / std::sqrt(12.0) * std::exp(-2 * std::pow(std::numbers::pi * steps, 2));
  return {mean(means), std::hypot(noise, rounding), kBlocks - 1};
}

double drift_ratio(std::span<const double> samples) {
  const std::vector<double> means = block_means(samples);
  const double within = scatter_within(samples, means);
  return scatter(means) == 0 ? 0 : scatter(means) / within;
}

}  // namespace tacto::capture
