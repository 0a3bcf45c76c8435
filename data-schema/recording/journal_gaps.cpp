// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/recording/journal_gaps.hpp"

#include <algorithm>

namespace tacto::schema {
namespace {

bool same_gap(const Gap& a, const Gap& b) {
  return a.frame == b.frame && a.device_sequence == b.device_sequence && a.count == b.count;
}

}  // namespace

AgreedGaps agreed_gaps(const std::vector<Gap>& gaps) {
  AgreedGaps agreed;
  std::uint64_t missing = 0;
  Gap last;
  for (Gap gap : gaps) {
    const std::uint64_t first_missing = gap.frame + missing;
    if (gap.frame < last.frame || gap.count == 0 || gap.device_sequence < first_missing ||
        same_gap(gap, last)) {
      ++agreed.left_out;
      continue;
    }
    last = gap;
    const std::uint64_t all = gap.device_sequence - first_missing;
    agreed.untold += all - std::min(all, gap.count);
    gap.count = std::max(all, gap.count);
    missing += gap.count;
    agreed.gaps.push_back(gap);
  }
  return agreed;
}

}  // namespace tacto::schema
