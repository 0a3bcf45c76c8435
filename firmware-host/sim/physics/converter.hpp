// SPDX-License-Identifier: GPL-3.0-or-later
// An analog-to-digital converter.
#pragma once

#include <cmath>
#include <cstdint>

namespace tacto::firmware_host {

/// Rounds to the nearest of 2^bits codes over +-range, left-justified in 32 bits. Values beyond the range get
/// the last code and are counted. There is no anti-alias filter before it: the mass of the transducer acts as
/// one (12 dB per octave above 548 Hz, -38 dB at 5 kHz).
class Converter {
 public:
  /// 2 to 32 bits; the range in the unit of the input.
  Converter(int bits, double range)
      : shift_(32 - bits), top_(std::ldexp(1.0, bits - 1)), codes_per_unit_(top_ / range) {}

  std::int32_t convert(double value) {
    const double code = std::floor(value * codes_per_unit_ + 0.5);
    const double held = code < -top_ ? -top_ : code > top_ - 1 ? top_ - 1 : code;
    if (held != code) ++clipped_;
    return static_cast<std::int32_t>(static_cast<std::int64_t>(held) * (std::int64_t{1} << shift_));
  }
  std::uint64_t clipped() const { return clipped_; }
  /// The input per left-justified code.
  double scale() const { return std::ldexp(1 / codes_per_unit_, -shift_); }
  double least() const { return -top_ / codes_per_unit_; }
  double most() const { return (top_ - 1) / codes_per_unit_; }

 private:
  int shift_;
  double top_, codes_per_unit_;
  std::uint64_t clipped_ = 0;
};

}  // namespace tacto::firmware_host
