// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/table/plain_rows.hpp"

#if defined(__x86_64__)

#include <smmintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "capture/table/plain_decimal.hpp"

namespace tacto::capture {
namespace {

constexpr std::size_t kBlock = 64;  // the number of bytes that are searched for ends of fields at once

using Bytes = std::array<std::uint8_t, 16>;

// Shuffles for a number whose last digit is in the last byte: they shift the digits before the decimal mark
// by one byte, over the mark.
constexpr auto all_closings() {
  std::array<Bytes, 16> table{};
  for (std::size_t mark = 0; mark < 16; ++mark)
    for (std::size_t i = 0; i < 16; ++i)
      table[mark][i] = static_cast<std::uint8_t>(i > mark ? i : i == 0 ? 0x80 : i - 1);
  return table;
}

// The 16 bytes from index n on are a mask that keeps the last n of 16 bytes.
constexpr auto all_lengths() {
  std::array<std::uint8_t, 33> table{};
  for (std::size_t i = 16; i < table.size(); ++i) table[i] = 0xFF;
  return table;
}

alignas(16) constexpr auto kClosings = all_closings();
constexpr auto kLengths = all_lengths();

[[gnu::target("sse4.1")]] inline __m128i load(const void* bytes) {
  return _mm_loadu_si128(static_cast<const __m128i*>(bytes));
}

// The value of 16 digits, the first in the lowest byte: sums of pairs, then of fours, then of eights.
[[gnu::target("sse4.1")]] inline std::int64_t value_of(__m128i digits) {
  const __m128i pairs =
      _mm_maddubs_epi16(digits, _mm_setr_epi8(10, 1, 10, 1, 10, 1, 10, 1, 10, 1, 10, 1, 10, 1, 10, 1));
  const __m128i fours = _mm_madd_epi16(pairs, _mm_setr_epi16(100, 1, 100, 1, 100, 1, 100, 1));
  const __m128i eights =
      _mm_madd_epi16(_mm_packus_epi32(fours, fours), _mm_setr_epi16(10000, 1, 10000, 1, 10000, 1, 10000, 1));
  const auto both = static_cast<std::uint64_t>(_mm_cvtsi128_si64(eights));
  return static_cast<std::int64_t>((both & 0xFFFFFFFF) * 100000000 + (both >> 32));
}

// The number that ends at `end`, with `length` characters without its sign. Precondition: 16 readable bytes
// before `end`, length up to 16.
[[gnu::target("sse4.1")]] inline PlainDecimal read_before(const char* end, std::size_t length, char mark) {
  const __m128i all = _mm_sub_epi8(load(end - 16), _mm_set1_epi8('0'));
  const __m128i small = _mm_cmpeq_epi8(_mm_min_epu8(all, _mm_set1_epi8(9)), all);
  const unsigned others =
      ~static_cast<unsigned>(_mm_movemask_epi8(small)) & (0xFFFFU << (16 - length)) & 0xFFFFU;
  __m128i digits = _mm_and_si128(all, load(kLengths.data() + length));
  if (others == 0) {
    if (length == 0 || length > 15) return {};
    return {end, static_cast<double>(value_of(digits)), false};
  }
  const auto place = static_cast<std::size_t>(std::countr_zero(others));
  if ((others & (others - 1)) != 0 || end[static_cast<std::ptrdiff_t>(place) - 16] != mark || length < 2)
    return {};
  digits = _mm_shuffle_epi8(digits, load(kClosings[place].data()));
  return {end, static_cast<double>(value_of(digits)) / kPowersOfTen[15 - place], true};
}

PlainDecimal read_long(const char* at, const char* end, char mark) {
  double value = 0;
  if (mark != '.') return {};
  const auto [stop, error] = std::from_chars(at, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return {};
  const std::string_view text(at, static_cast<std::size_t>(end - at));
  return {end, value, text.find('.') != std::string_view::npos};
}

// Reads rows field by field.
class Scan {
 public:
  Scan(std::string_view bytes, const RowForm& form, double* numbers)
      : form_(form), begin_(bytes.data()), row_(begin_), field_(begin_), numbers_(numbers) {}

  // Reads the field up to `end`, where a delimiter or a line end is; false if it is not plain.
  [[gnu::target("sse4.1")]] bool take(const char* end);
  PlainRows read() const { return {static_cast<std::size_t>(row_ - begin_), rows_, marked_}; }

 private:
  [[gnu::target("sse4.1")]] bool take_number(const char* end, std::size_t place);
  void end_row(const char* next);

  const RowForm form_;
  const char* const begin_;
  const char* row_;    // the beginning of the row
  const char* field_;  // the beginning of the field
  double* numbers_;
  std::size_t column_ = 0, rows_ = 0;
  bool marked_ = false, row_marked_ = false;
};

[[gnu::target("sse4.1")]] inline bool Scan::take_number(const char* end, std::size_t place) {
  const bool negative = *field_ == '-';
  const char* const at = field_ + (negative ? 1 : 0);
  const auto length = static_cast<std::size_t>(end - at);
  PlainDecimal number;
  if (length <= 16 && end - begin_ >= 16) number = read_before(end, length, form_.mark);
  if (number.stop == nullptr && at != end && *at != '-') number = read_long(at, end, form_.mark);
  numbers_[place] = negative ? -number.value : number.value;
  row_marked_ = row_marked_ || number.point;
  return number.stop != nullptr;
}

[[gnu::target("sse4.1")]] inline bool Scan::take(const char* end) {
  const bool last = column_ + 1 == form_.places.size();
  if (*end != (last ? form_.line_end : form_.delimiter)) return false;
  const char* stop = end;
  if (last && stop != field_ && stop[-1] == '\r') --stop;
  const std::size_t place = form_.places[column_];
  if (place != RowForm::kSkipped) {
    if (!take_number(stop, place)) return false;
  } else if (std::find(field_, stop, '"') != stop) {
    return false;
  }
  field_ = end + 1;
  ++column_;
  if (last) end_row(end + 1);
  return true;
}

inline void Scan::end_row(const char* next) {
  row_ = next;
  column_ = 0;
  ++rows_;
  numbers_ += form_.kept;
  marked_ = row_marked_;
}

// The positions of delimiters and line ends, one bit per byte.
[[gnu::target("sse4.1")]] inline std::uint64_t field_ends(const char* block, const RowForm& form) {
  const __m128i delimiter = _mm_set1_epi8(form.delimiter), line_end = _mm_set1_epi8(form.line_end);
  std::uint64_t ends = 0;
  for (std::size_t i = 0; i < kBlock; i += 16) {
    const __m128i text = load(block + i);
    const __m128i found = _mm_or_si128(_mm_cmpeq_epi8(text, delimiter), _mm_cmpeq_epi8(text, line_end));
    ends |= static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_epi8(found))) << i;
  }
  return ends;
}

[[gnu::target("sse4.1")]] PlainRows read_blocks(std::string_view bytes, const RowForm& form,
                                                double* numbers) {
  Scan scan(bytes, form, numbers);
  for (std::size_t at = 0; at + kBlock <= bytes.size(); at += kBlock) {
    const char* const block = bytes.data() + at;
    for (std::uint64_t ends = field_ends(block, form); ends != 0; ends &= ends - 1)
      if (!scan.take(block + std::countr_zero(ends))) return scan.read();
  }
  return scan.read();
}

}  // namespace

PlainRows read_plain_rows(std::string_view bytes, const RowForm& form, double* numbers) {
  return __builtin_cpu_supports("sse4.1") ? read_blocks(bytes, form, numbers) : PlainRows{};
}

}  // namespace tacto::capture

#else

namespace tacto::capture {

PlainRows read_plain_rows(std::string_view, const RowForm&, double*) {
  return {};
}

}  // namespace tacto::capture

#endif
