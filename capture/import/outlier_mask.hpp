// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a source that are left out because they contain an outlier: they become gaps, not invented values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

class OutlierMask {
 public:
  /// Masks no row.
  OutlierMask() = default;
  /// `rows` in any order, duplicates allowed; the source has `all` rows. Errors: unsuitable, if they are more
  /// than ten and more than 1 %: then unit or scale are wrong, or the source is not usable.
  static schema::Result<OutlierMask> of(std::vector<std::uint64_t> rows, std::uint64_t all,
                                        const std::string& file);

  std::size_t count() const { return rows_.size(); }
  /// Removes the masked rows from `values`, which begins at the row `first`.
  void erase_from(std::vector<double>& values, std::uint64_t first) const;
  /// The gaps after masking: the masked rows, and the gaps of the source, whose frames are its row numbers.
  std::vector<schema::Gap> gaps_with(const std::vector<schema::Gap>& of_source) const;

 private:
  std::vector<std::uint64_t> rows_;  // ascending
};

}  // namespace tacto::capture
