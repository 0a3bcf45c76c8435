// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/spectrum/short_time_transform.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "spatial/dsp/filter/trend.hpp"

namespace tacto::spatial {
namespace {

// A block spans this many windows after its first one: long enough that few samples are prepared twice, short
// enough that the level of a drifting signal is close to that of each window.
constexpr std::size_t kWindowsPerBlock = 3;

// Magnitudes from 2^-20 to 2^20 are not scaled, because their squares fit single precision.
constexpr int kUsualExponent = 20;
constexpr int kSmallestExponent = -1000;

std::size_t rows_per_block(const FrameShape& shape) {
  return 2 + kWindowsPerBlock * shape.window / shape.hop / 2 * 2;  // even: rows go in pairs
}

std::vector<float> every_nth(std::span<const double> window, std::size_t n, double factor) {
  std::vector<float> weights;
  for (std::size_t i = 0; i < window.size(); i += n)
    weights.push_back(static_cast<float>(factor * window[i]));
  return weights;
}

int exponent_of(double largest) {
  if (largest == 0) return 0;
  const int exponent = std::ilogb(largest);
  return std::abs(exponent) <= kUsualExponent ? 0 : std::max(exponent, kSmallestExponent);
}

using EitherFft = std::variant<PackedFft<float>, PackedFft<double>>;

EitherFft fft_for(const FrameShape& shape, const Decimation& decimation, std::size_t rows) {
  const std::size_t length = shape.padded / decimation.factor, transforms = (rows + 1) / 2;
  if (decimation.factor > 1 || is_short_job(length, transforms)) return PackedFft<double>(length, transforms);
  return PackedFft<float>(length, transforms);
}

}  // namespace

void PackedRows::powers(std::span<float> a, std::span<float> b) const {
  std::visit([&](auto spectrum) { unpack_powers(spectrum, a, b); }, spectrum_);
}

void PackedRows::spectra(std::span<std::complex<float>> a, std::span<std::complex<float>> b) const {
  std::visit([&](auto spectrum) { unpack_spectra(spectrum, a, b); }, spectrum_);
}

ShortTimeTransform::ShortTimeTransform(const FrameShape& shape, const Decimation& decimation,
                                       std::span<const double> window, double gain, bool detrend,
                                       std::size_t rows)
    : shape_(shape),
      decimation_(decimation),
      detrend_(detrend),
      rows_per_block_(rows_per_block(shape)),
      window_(every_nth(window, decimation.factor, gain * static_cast<double>(decimation.factor))),
      fft_(fft_for(shape, decimation, rows)),
      means_(rows_per_block_) {
  assert(window.size() == shape.window && shape.padded % decimation.factor == 0);
  const std::size_t longest = (rows_per_block_ - 1) * shape.hop + shape.window;
  if (decimation.factor > 1) decimator_.emplace(decimation, longest);
  samples_.resize(longest + (decimator_ ? 2 * decimator_->reach() + decimation.grid : 0));
}

std::size_t ShortTimeTransform::rows_of(std::size_t samples) const {
  return samples < shape_.window ? 0 : 1 + (samples - shape_.window) / shape_.hop;
}

// Without detrending the level is part of the result, so the scale has to include it.
ShortTimeTransform::Block ShortTimeTransform::block_at(std::span<const double> signal, std::size_t first_row,
                                                       std::size_t rows) const {
  Block block{first_row, std::min(rows_per_block_, rows - first_row), first_row * shape_.hop};
  block.length = (block.rows - 1) * shape_.hop + shape_.window;
  const auto inside = signal.subspan(block.start, block.length);
  const Trend trend = trend_of(inside);
  block.exponent = exponent_of(detrend_ ? trend.largest : trend.largest + std::abs(trend.mean));
  if (!detrend_) return block;
  if (decimator_) block.slope = trend.slope;
  block.level = trend.mean - block.slope * 0.5 * static_cast<double>(inside.size() - 1);
  return block;
}

// Converts the block's samples to single precision. Beyond the signal's ends the last value continues; the
// window almost excludes it.
void ShortTimeTransform::load(std::span<const double> signal, const Block& block) {
  const std::size_t reach = decimator_ ? decimator_->reach() : 0;
  const std::size_t count = block.length + (decimator_ ? 2 * reach + decimation_.grid : 0);
  const double scale = std::ldexp(1.0, -block.exponent);
  const std::size_t before = reach - std::min(reach, block.start);
  const std::size_t begin = block.start + before - reach;
  const std::size_t inside = std::min(count - before, signal.size() - begin);
  const double at_begin = block.level - block.slope * static_cast<double>(block.start - begin);
  const auto values = std::span(samples_).first(count);
  subtract_line(signal.subspan(begin, inside), at_begin, block.slope, scale, values.subspan(before, inside));
  std::ranges::fill(values.first(before), values[before]);
  std::ranges::fill(values.subspan(before + inside), values[before + inside - 1]);
  if (decimator_) decimator_->run(values, block.length);
}

// Each row's mean minus the block's line at the row's start. If neighbouring rows share most samples, a row's
// sum is updated from the one before.
void ShortTimeTransform::find_means(std::span<const double> signal, const Block& block) {
  const std::size_t hop = shape_.hop, window = shape_.window;
  const double scale = std::ldexp(1.0, -block.exponent);
  double sum = 0;
  for (std::size_t row = 0; row < block.rows; ++row) {
    const std::size_t start = block.start + row * hop;
    if (row == 0 || 2 * hop > window)
      sum = sum_above(signal.subspan(start, window), block.level);
    else
      sum += sum_above(signal.subspan(start + window - hop, hop), block.level) -
             sum_above(signal.subspan(start - hop, hop), block.level);
    const double line = block.slope * static_cast<double>(row * hop);
    means_[row] = (sum / static_cast<double>(window) - line) * scale;
  }
}

Frame ShortTimeTransform::frame(const Block& block, std::size_t row) const {
  const std::size_t offset = row * shape_.hop;
  const double level = detrend_ ? means_[row] : 0;
  if (!decimator_) return {samples_.data() + offset, level, 0};
  const double slope = std::ldexp(block.slope * static_cast<double>(decimation_.factor), -block.exponent);
  return {decimator_->from(offset), level, slope};
}

template <class Real>
schema::Result<void> ShortTimeTransform::transform_block(PackedFft<Real>& fft, const Block& block,
                                                         const PackedRowSink& sink) {
  for (std::size_t row = 0; row < block.rows; row += 2) {
    const bool two = row + 1 < block.rows;
    pack_frames(frame(block, row), frame(block, two ? row + 1 : row), window_, fft.input());
    fft.transform();
    if (auto taken = sink({block.first_row + row, two, block.exponent, fft.output()}); !taken) return taken;
  }
  return {};
}

schema::Result<void> ShortTimeTransform::transform(std::span<const double> signal,
                                                   const PackedRowSink& sink) {
  const std::size_t rows = rows_of(signal.size());
  for (std::size_t row = 0; row < rows; row += rows_per_block_) {
    const Block block = block_at(signal, row, rows);
    load(signal, block);
    if (detrend_) find_means(signal, block);
    const auto done = std::visit([&](auto& fft) { return transform_block(fft, block, sink); }, fft_);
    if (!done) return done;
  }
  return {};
}

}  // namespace tacto::spatial
