// SPDX-License-Identifier: GPL-3.0-or-later
// trials.schema.json against the lines of every kind of entry: as they are written, without each of their
// members, and with a member of another type.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <variant>
#include <vector>

#include "data-schema/experiment/journal.hpp"
#include "data-schema/json/json_schema.hpp"

namespace tacto::schema {
namespace {

IntervalFacts facts_with_all() {
  IntervalFacts facts;
  facts.ticks = 3181;
  facts.strokes = 2;
  facts.closed = true;
  facts.stimulus_sha256 = std::string(64, 'a');
  facts.simulated = "by a device";
  facts.slowest_mps = facts.fastest_mps = 0.05;
  facts.removed_by_limits_db = -300;
  facts.predicted_error_db = facts.measured_error_db = -31.5;
  facts.predicted_period_m = facts.measured_period_m = 1.76e-3;
  facts.predicted_gain_m_per_n = facts.measured_gain_m_per_n = 1e-3;
  facts.last_gain = 1;
  return facts;
}

// Each kind, with all members and with the fewest.
std::vector<JournalEntry> entries_of_each_kind() {
  const std::string sum(64, '0'), time = "2026-11-29T19:16:30Z";
  return {RunPlanned{"lab", "P01", sum, sum, "sim:", "weber=25%", time, "tactograph", 2, "en", "64.5 dB"},
          RunPlanned{"lab", "7", sum, sum, "usb:", "", time, "tactograph"},
          AttemptBegun{1, "K2.1", {"K2", "K9"}, {"lab-P01/001-1.session", "lab-P01/001-2.session"}, 1, 3e-8},
          AttemptBegun{2, "all.1", {"K2"}, {}, 0},
          DeliveryJudged{1, true, {}, {facts_with_all(), IntervalFacts{}}, {0.5, std::nullopt}},
          DeliveryJudged{1, false, {"interval 1: 3 lost ticks"}, {}},
          SamplePlaced{1, "K4"},
          StimulusExplored{1, "K3", "lab-P01/001-2.session"},
          AttemptAnswered{1, 0, "K3 K1", 1.25},
          BlockOver{1},
          BreakTaken{61.5},
          RunResumed{time, "not measured"},
          RunResumed{time},
          RunEnded{time}};
}

bool fits(const Json& line) {
  return breaches(line, *schema_of("trials")).empty();
}

Json line_of(const JournalEntry& entry) {
  return Json::parse(journal_line(entry, std::holds_alternative<RunPlanned>(entry) ? 1 : 7));
}

// Left out where they do not apply; of an interval: where they are unknown.
const std::set<std::string> kOptional = {"observer", "language", "masking_level", "force_within"};

TEST(JournalSchema, DescribesEveryLine) {
  std::set<std::size_t> kinds;
  for (const JournalEntry& entry : entries_of_each_kind()) {
    const Json line = line_of(entry);
    EXPECT_TRUE(fits(line)) << line;
    kinds.insert(entry.index());
    for (const auto& [name, value] : line.items()) {
      Json broken = line;
      broken.erase(name);
      EXPECT_EQ(fits(broken), kOptional.contains(name)) << name << " is missing in " << line;
      broken[name] = Json::object();
      EXPECT_FALSE(fits(broken)) << name << " of another type in " << line;
    }
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<JournalEntry>);
}

TEST(JournalSchema, RefusesNumbersThatNoRunHas) {
  const Json begun = line_of(AttemptBegun{1, "K2.1", {"K2"}, {}, 1, 0});
  const Json judged = line_of(DeliveryJudged{1, true, {}, {facts_with_all()}, {0.5}});
  const std::vector<std::pair<Json, const char*>> changes = {
      {begun, R"({"attempt": 0})"},         {begun, R"({"block": 1.5})"},
      {begun, R"({"trial": "K2"})"},        {begun, R"({"event": "began"})"},
      {begun, R"({"event": "end"})"},       {begun, R"({"check": "0"})"},
      {judged, R"({"force_within": [2]})"}, {judged, R"({"intervals": [{"ticks": 1}]})"}};
  for (const auto& [line, change] : changes) {
    Json broken = line;
    broken.update(Json::parse(change));
    EXPECT_FALSE(fits(broken)) << change;
  }
  Json negative = judged;
  negative["intervals"][0]["lost_ticks"] = -1;
  EXPECT_FALSE(fits(negative));
}

}  // namespace
}  // namespace tacto::schema
