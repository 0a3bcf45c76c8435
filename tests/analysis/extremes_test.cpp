// SPDX-License-Identifier: GPL-3.0-or-later
// Each condition stays within the error that its method states. TACTO_EXTREMES=1 includes the stroke of 1e8
// samples.
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <set>
#include <string>

#include "analysis/extremes/extreme.hpp"
#include "tests/measured.hpp"

namespace tacto::analysis {
namespace {

// An error of zero has no margin.
double margin_of(const Extreme& row) {
  return row.error > 0 && row.most > 0 ? row.margin_db() : std::numeric_limits<double>::infinity();
}

TEST(Extremes, HoldWhatTheirMethodsState) {
  const bool all = std::getenv("TACTO_EXTREMES") != nullptr;
  const auto rows = all_extremes(all);
  std::set<std::string> conditions, rooms;
  for (const Extreme& row : rows) {
    std::printf("%-72s error %.1e, at most %.0e  %s\n", row.condition.c_str(), row.error, row.most,
                row.note.c_str());
    EXPECT_TRUE(row.holds()) << row.condition << ": " << row.error << ", at most " << row.most;
    if (row.note.find("refused, it requires") != std::string::npos) {
      EXPECT_NE(row.note.find("at 2000 Hz"), std::string::npos) << row.note;
    }
    EXPECT_FALSE(row.reference.empty()) << row.condition;
    tacto::measured("extremes." + key_part(row.condition) + ".error", row.error);
    tacto::measured("extremes." + key_part(row.condition) + ".margin_db", margin_of(row));
    rooms.insert(row.room);
    EXPECT_TRUE(conditions.insert(row.condition).second) << "twice: " << row.condition;
  }
  EXPECT_GT(rows.size(), 70U);
  EXPECT_EQ(rooms, (std::set<std::string>{"analysis", "capture", "firmware-host", "playback", "spatial"}));
}

TEST(Extremes, ARowThatBreaksSaysSo) {
  EXPECT_FALSE((Extreme{"spatial", "x", "y", 2e-3, 1e-3, {}}.holds()));
  EXPECT_NEAR((Extreme{"spatial", "x", "y", 1e-3, 1e-2, {}}.margin_db()), 20, 1e-9);
}

}  // namespace
}  // namespace tacto::analysis
