// SPDX-License-Identifier: GPL-3.0-or-later
// The checksum of a spectrogram in its file: cells, axes, and the attributes that give them their meaning.
//
#pragma once

#include <span>
#include <string>

#include "data-schema/base/sha256.hpp"

namespace tacto::schema {

/// Attributes of the file, in the order of the checksum: texts, numbers, whole numbers.
inline constexpr const char* kSummedTexts[] = {"texture", "simulated", "quantity", "quantity_unit",
                                               "scaling", "window",    "detrend"};
inline constexpr const char* kSummedNumbers[] = {"window_mm", "hop_mm", "pitch_mm", "window_coherent_gain"};
inline constexpr const char* kSummedCounts[] = {"padded_samples", "decimation"};
/// Variables whose attribute `units` follows; then the cells (`density` or `amplitude`) and their decibels.
inline constexpr const char* kSummedUnits[] = {"position", "spatial_frequency", "known_from", "known_to"};

/// SHA-256 over the bytes of one spectrogram as its file stores them, little-endian: the rows of `density` or
/// `amplitude` (float32), then known_from and known_to (float64; NaN if the texture has no valid band), its
/// positions and the spatial frequencies (float64); then the attributes above, a text in UTF-8 ended by a
/// newline (empty if it is absent), a number
/// as float64. The attribute `sha256` has a line for each
/// spectrogram.
class SpectrogramSum {
 public:
  void add(std::span<const float> cells) { add_bytes(cells); }
  void add(std::span<const double> values) { add_bytes(values); }
  void add(double number) { add_bytes(std::span<const double>(&number, 1)); }
  void add(const std::string& text) { sum_.add(text + "\n"); }
  std::string hexadecimal() { return sum_.hexadecimal(); }

 private:
  template <class Number>
  void add_bytes(std::span<const Number> numbers) {
    sum_.add({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
  }
  Sha256 sum_;
};

}  // namespace tacto::schema
