// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/decibels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tacto::schema {
namespace {

constexpr float kLog10Of2 = 0.30102999566F;

// log2 of a normal number above 0. With m = x / 2^e in [1 / sqrt 2, sqrt 2) and t = (m - 1) / (m + 1),
// ln m = 2 (t + t^3 / 3 + t^5 / 5 + t^7 / 7); |t| <= 0.172 leaves 3e-8. No branch: the loop below becomes
// vector instructions.
float log2_of(float x) {
  constexpr std::int32_t kRootHalf = 0x3f3504f3;  // the bits of 1 / sqrt 2
  const std::int32_t bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kRootHalf) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23));
  const float t = (m - 1) / (m + 1), square = t * t;
  const float series = t * (1 + square * (1.0F / 3 + square * (0.2F + square * (1.0F / 7))));
  return static_cast<float>(exponent) + 2.88539008F * series;  // 2 / ln 2
}

}  // namespace

void to_decibels(std::span<const float> cells, float factor, std::span<float> out) {
  constexpr float kLeast = std::numeric_limits<float>::min();
  const float scale = factor * kLog10Of2;
  unsigned odd = 0;  // a float's minimum would prevent vector instructions
  const float* const in = cells.data();
  float* const result = out.data();
  for (std::size_t i = 0, count = out.size(); i < count; ++i) {
    result[i] = scale * log2_of(in[i]);
    odd |= static_cast<unsigned>(!(in[i] >= kLeast));
  }
  if (odd == 0) return;
  for (std::size_t i = 0; i < out.size(); ++i)  // zero, denormals, NaN
    if (!(cells[i] >= kLeast))
      out[i] = cells[i] > 0 ? factor * std::log10(cells[i]) : std::numeric_limits<float>::quiet_NaN();
}

// Block by block, so that input and output both stay in the first cache.
void transpose(std::span<const float> cells, std::size_t rows, std::size_t columns, std::span<float> out) {
  constexpr std::size_t kBlock = 16;
  for (std::size_t r = 0; r < rows; r += kBlock)
    for (std::size_t c = 0; c < columns; c += kBlock) {
      const std::size_t last_r = std::min(r + kBlock, rows), last_c = std::min(c + kBlock, columns);
      for (std::size_t i = c; i < last_c; ++i)
        for (std::size_t j = r; j < last_r; ++j) out[i * rows + j] = cells[j * columns + i];
    }
}

}  // namespace tacto::schema
