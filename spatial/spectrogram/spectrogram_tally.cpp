// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/spectrogram/spectrogram_tally.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tacto::spatial {
namespace {

constexpr std::size_t kLanes = 8;  // independent sums and maxima, for vector instructions

struct SumAndMaximum {
  double sum = 0;  // of cells, or of their squares
  float maximum = -1;
};

template <bool kSquares>
SumAndMaximum sum_and_maximum(std::span<const float> cells) {
  double sums[kLanes] = {};
  float maxima[kLanes] = {};
  const auto add = [&](float cell, std::size_t lane) {
    const auto value = static_cast<double>(cell);
    sums[lane] += kSquares ? value * value : value;
    maxima[lane] = maxima[lane] < cell ? cell : maxima[lane];
  };
  std::size_t i = 0;
  for (; i + kLanes <= cells.size(); i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(cells[i + lane], lane);
  for (; i < cells.size(); ++i) add(cells[i], 0);
  SumAndMaximum both{0, *std::ranges::max_element(maxima)};
  for (const double sum : sums) both.sum += sum;
  return both;
}

}  // namespace

SpectrogramTally::SpectrogramTally(const schema::SpectrogramHeader& header, double settled_per_m)
    : header_(header),
      first_merged_bin_(first_bin(header, settled_per_m)),
      low_powers_(first_merged_bin_, 0.0),
      low_peaks_(first_merged_bin_) {}

void SpectrogramTally::add_low(std::size_t row, std::span<const float> cells) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    low_powers_[k] += power_of(header_, k, static_cast<double>(cells[k]));
    if (cells[k] > low_peaks_[k].cell && is_valid(header_, row, k)) low_peaks_[k] = {cells[k], row, k};
  }
}

void SpectrogramTally::add_high(std::size_t row, std::span<const float> cells) {
  const bool squares = header_.scaling == schema::Scaling::amplitude;
  const auto [sum, maximum] = squares ? sum_and_maximum<true>(cells) : sum_and_maximum<false>(cells);
  high_power_ += squares ? sum * power_of(header_, first_merged_bin_, 1) : sum;
  if (maximum <= high_peak_.cell) return;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] > high_peak_.cell && is_valid(header_, row, first_merged_bin_ + i))
      high_peak_ = {cells[i], row, first_merged_bin_ + i};
}

void SpectrogramTally::add(std::size_t first, std::span<const float> cells) {
  for (std::size_t at = 0; at < cells.size(); at += header_.bins) {
    const auto row = cells.subspan(at, header_.bins);
    add_low(first + at / header_.bins, row.first(first_merged_bin_));
    add_high(first + at / header_.bins, row.subspan(first_merged_bin_));
    ++rows_;
  }
}

SpectralPeak SpectrogramTally::strongest_peak(double min_frequency_per_m) const {
  const std::size_t first = first_bin(header_, min_frequency_per_m);
  assert(first <= first_merged_bin_ && rows_ > 0);
  Peak best = high_peak_;
  for (std::size_t k = first; k < first_merged_bin_; ++k)
    if (low_peaks_[k].cell > best.cell) best = low_peaks_[k];
  if (best.cell < 0) return {NAN, NAN, NAN};
  return {header_.position_m[best.row], header_.frequency_per_m(best.bin), static_cast<double>(best.cell)};
}

double SpectrogramTally::band_rms(double min_frequency_per_m) const {
  double sum = high_power_;
  for (std::size_t k = first_bin(header_, min_frequency_per_m); k < first_merged_bin_; ++k)
    sum += low_powers_[k];
  return std::sqrt(sum / static_cast<double>(rows_) * header_.frequency_step_per_m);
}

}  // namespace tacto::spatial
