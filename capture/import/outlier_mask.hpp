// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a source that are left out because a sample in them is an outlier: gaps, never invented values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

class OutlierMask {
 public:
  /// No row at all.
  OutlierMask() = default;
  /// `rows` in any order, also twice, of a source that has `all`. Errors: unsuitable, where they are more
  /// than ten and more than 1 %: then unit or scale are wrong, or the source is not to be saved.
  static schema::Result<OutlierMask> of(std::vector<std::uint64_t> rows, std::uint64_t all,
                                        const std::string& file);

  std::size_t count() const { return rows_.size(); }
  /// Takes the masked rows out of values whose first is of the row `first`.
  void erase_from(std::vector<double>& values, std::uint64_t first) const;
  /// The gaps of what is left: the masked rows and those of the source, which count its rows.
  std::vector<schema::Gap> gaps_with(const std::vector<schema::Gap>& of_source) const;

 private:
  std::vector<std::uint64_t> rows_;  // growing
};

}  // namespace tacto::capture
