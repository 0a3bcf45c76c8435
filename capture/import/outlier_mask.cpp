// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/outlier_mask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tacto::capture {
namespace {

// Our choice. A damaged export of 10,000 rows had 3 (dirty/T1.csv).
constexpr double kMostShare = 0.01;
constexpr std::size_t kFewRows = 10;

// `count` missing rows before the row `row` of the source; if masked, that row itself.
struct Missing {
  std::uint64_t row = 0, count = 0;
  bool masked = false;
};

}  // namespace

schema::Result<OutlierMask> OutlierMask::of(std::vector<std::uint64_t> rows, std::uint64_t all,
                                            const std::string& file) {
  std::ranges::sort(rows);
  const auto twice = std::ranges::unique(rows);
  rows.erase(twice.begin(), twice.end());
  const bool many = static_cast<double>(rows.size()) > kMostShare * static_cast<double>(all);
  if (rows.size() > kFewRows && many)
    return schema::fail(schema::ErrorKind::unsuitable,
                        fmt::format("{} of {} rows contain outliers or lack a value: too many to be removed",
                                    rows.size(), all),
                        file,
                        "check unit and scale; an import without --mask-outliers lists the first of them");
  OutlierMask mask;
  mask.rows_ = std::move(rows);
  return mask;
}

void OutlierMask::erase_from(std::vector<double>& values, std::uint64_t first) const {
  const auto begin = std::ranges::lower_bound(rows_, first);
  const auto end = std::ranges::lower_bound(rows_, first + values.size());
  for (auto row = end; row != begin;)
    values.erase(values.begin() + static_cast<std::ptrdiff_t>(*--row - first));
}

std::vector<schema::Gap> OutlierMask::gaps_with(const std::vector<schema::Gap>& of_source) const {
  std::vector<Missing> all;
  for (const schema::Gap& gap : of_source) all.push_back({gap.frame, gap.count, false});
  for (const std::uint64_t row : rows_) all.push_back({row, 1, true});
  std::ranges::stable_sort(all, {}, &Missing::row);
  std::vector<schema::Gap> gaps;
  std::uint64_t masked = 0, missing = 0;
  for (const Missing& one : all) {
    const std::uint64_t frame = one.row - masked;  // of the next row that is kept
    missing += one.count;
    if (gaps.empty() || gaps.back().frame != frame) gaps.push_back({frame, 0, 0});
    gaps.back().count += one.count;
    gaps.back().device_sequence = frame + missing;
    masked += one.masked ? 1 : 0;
  }
  return gaps;
}

}  // namespace tacto::capture
