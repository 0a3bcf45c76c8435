// SPDX-License-Identifier: GPL-3.0-or-later
// Decibels: of one ratio, and of many cells at once for files and pictures.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace tacto::schema {

inline double power_db(double ratio) {
  return 10 * std::log10(ratio);
}
inline double amplitude_db(double ratio) {
  return 20 * std::log10(ratio);
}
inline double power_of_db(double level_db) {
  return std::pow(10, level_db / 10);
}
inline double amplitude_of_db(double level_db) {
  return std::pow(10, level_db / 20);
}

/// out[i] = factor * log10(cells[i]), within 2e-5 dB for factors up to 20 (single precision, a polynomial of
/// the mantissa); NaN where a cell is not above 0. `out` gives the number of cells.
void to_decibels(std::span<const float> cells, float factor, std::span<float> out);

/// The transposed rows: from `rows` rows of `columns` to `columns` rows of `rows`.
void transpose(std::span<const float> cells, std::size_t rows, std::size_t columns, std::span<float> out);

}  // namespace tacto::schema
