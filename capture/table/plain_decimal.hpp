// SPDX-License-Identifier: GPL-3.0-or-later
// Fast and exact reading of short decimal numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tacto::capture {

/// Powers of ten that are exact as doubles, so that a division by one rounds once.
inline constexpr std::array<double, 16> kPowersOfTen = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                        1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

/// A number and its end; `stop` is null if the text is another kind of number, or not a number.
struct PlainDecimal {
  const char* stop = nullptr;
  double value = 0;
  bool point = false;  ///< it has a decimal point
};

/// Reads "-12.345": sign, digits, point, digits, at most 15 digits and no exponent; the text after it is not
/// examined. As exact as strtod: integers below 10^15 and powers of ten to 10^15 are exact as doubles, and
/// their quotient is rounded once (Clinger, How to read floating point numbers accurately, 1990).
inline PlainDecimal read_plain_decimal(const char* begin, const char* end) {
  const bool negative = begin != end && *begin == '-';
  const char* const first = begin + (negative ? 1 : 0);
  const char* at = first;
  const char* point = nullptr;
  std::uint64_t digits = 0;
  for (; at != end; ++at) {
    const auto digit = static_cast<unsigned>(*at - '0');
    if (digit <= 9) {
      digits = digits * 10 + digit;
    } else if (*at == '.' && point == nullptr) {
      point = at;
    } else {
      break;
    }
    if (at - first > 15) return {};
  }
  const auto count = at - first - (point != nullptr ? 1 : 0);
  if (count < 1 || count > 15 || (at != end && (*at == 'e' || *at == 'E'))) return {};
  const auto decimals = static_cast<std::size_t>(point != nullptr ? at - point - 1 : 0);
  const double value = static_cast<double>(digits) / kPowersOfTen[decimals];
  return {at, negative ? -value : value, point != nullptr};
}

}  // namespace tacto::capture
