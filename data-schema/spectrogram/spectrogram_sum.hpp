// SPDX-License-Identifier: GPL-3.0-or-later
// The checksum of cells and axes in a spectrogram's file. Internal to this folder.
#pragma once

#include <span>
#include <string>

#include "data-schema/base/sha256.hpp"

namespace tacto::schema {

/// SHA-256 over the bytes of one spectrogram as its file stores them, little-endian: the rows of `density` or
/// `amplitude` (float32), then known_from and known_to (float64; NaN if the texture has no valid band), its
/// positions and the spatial frequencies (float64). The attribute `sha256` has a line for each spectrogram.
class SpectrogramSum {
 public:
  void add(std::span<const float> cells) { add_bytes(cells); }
  void add(std::span<const double> values) { add_bytes(values); }
  std::string hexadecimal() { return sum_.hexadecimal(); }

 private:
  template <class Number>
  void add_bytes(std::span<const Number> numbers) {
    sum_.add({reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
  }
  Sha256 sum_;
};

}  // namespace tacto::schema
