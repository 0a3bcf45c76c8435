// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of units: each depends on what its result depends on, and on nothing else.
#include "analysis/corpus/corpus_unit.hpp"

#include <gtest/gtest.h>

namespace tacto::analysis {
namespace {

schema::CorpusPlan plan() {
  schema::CorpusPlan made;
  made.steps = {{"spatial", ""}, {"describe", ""}};
  made.creator = "a test";
  return made;
}

const schema::CorpusRecording kOak{"raw/oak.json", std::string(64, 'a')};

// Which of the two keys differ from those of the plan and the recording above.
std::vector<bool> changed_keys(const schema::CorpusPlan& other, const schema::CorpusRecording& recording) {
  const auto before = unit_keys(plan(), kOak), after = unit_keys(other, recording);
  return {before[0] != after[0], before[1] != after[1]};
}

TEST(CorpusUnit, KeyDependsOnWhatTheResultDependsOn) {
  const std::vector<bool> none{false, false}, description{false, true}, both{true, true};
  EXPECT_EQ(changed_keys(plan(), kOak), none);
  EXPECT_NE(unit_keys(plan(), kOak)[0], unit_keys(plan(), kOak)[1]);
  EXPECT_EQ(changed_keys(plan(), {"elsewhere/oak.json", kOak.sha256}), none);
  EXPECT_EQ(changed_keys(plan(), {"raw/pine.json", kOak.sha256}), both);
  EXPECT_EQ(changed_keys(plan(), {"raw/oak.json", std::string(64, 'b')}), both);
  schema::CorpusPlan other = plan();
  other.created = "2024-05-01T12:00:00Z";
  other.recordings = {kOak};
  EXPECT_EQ(changed_keys(other, kOak), none);
  other.steps[1].options = "--window 5mm";
  EXPECT_EQ(changed_keys(other, kOak), description);
  other.steps[0].options = "--average";
  EXPECT_EQ(changed_keys(other, kOak), both);
  other = plan();
  other.creator = "another version";
  EXPECT_EQ(changed_keys(other, kOak), both);
}

}  // namespace
}  // namespace tacto::analysis
