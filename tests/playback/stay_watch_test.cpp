// SPDX-License-Identifier: GPL-3.0-or-later
// The drive must fall if the clients that have to stay connected are gone.
#include "playback/control/stay_watch.hpp"

#include <gtest/gtest.h>

namespace tacto::playback {
namespace {

TEST(StayWatch, NobodyHasToStayUnlessAsked) {
  StayWatch watch;
  watch.begin({});
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(watch.why_to_fall({false, 0}, 1));
}

TEST(StayWatch, AConnectionThatEndsIsSeenAtOnce) {
  StayWatch watch;
  watch.begin({7, std::nullopt});
  EXPECT_FALSE(watch.why_to_fall({true, 0}, 100)) << "silence alone is no reason";
  EXPECT_EQ(watch.why_to_fall({false, 0}, 0).value_or(""), "the client that armed has closed its connection");
}

TEST(StayWatch, SilenceIsCountedFromTheLastLine) {
  StayWatch watch;
  watch.begin({7, 1.0});
  for (int i = 1; i <= 9; ++i) EXPECT_FALSE(watch.why_to_fall({true, 1}, 0.1)) << i;
  EXPECT_FALSE(watch.why_to_fall({true, 2}, 0.1)) << "a line came";
  for (int i = 1; i <= 9; ++i) EXPECT_FALSE(watch.why_to_fall({true, 2}, 0.1)) << i;
  (void)watch.why_to_fall({true, 2}, 0.1);
  EXPECT_EQ(watch.why_to_fall({true, 2}, 0.1).value_or(""),
            "no line came from the client that armed for 1 s (dead_man_s)");
}

TEST(StayWatch, WithoutAClientAnyLineCounts) {
  StayWatch watch;
  watch.begin({std::nullopt, 0.5});
  std::optional<std::string> why;
  for (int i = 0; i < 10 && !why; ++i) why = watch.why_to_fall({true, 3}, 0.1);
  EXPECT_EQ(why.value_or(""), "no line came from any client for 0.5 s (dead_man_s)");
}

TEST(StayWatch, TheShorterTimeHolds) {
  schema::ControlRequest arm;
  arm.client = 7;
  EXPECT_FALSE(stay_rules(arm, {}).client || stay_rules(arm, {}).dead_man_s);
  EXPECT_EQ(stay_rules(arm, 3.0).dead_man_s, 3.0);
  arm.while_connected = true;
  arm.dead_man_s = 5;
  EXPECT_EQ(stay_rules(arm, {}).dead_man_s, 5.0);
  EXPECT_EQ(stay_rules(arm, 3.0).dead_man_s, 3.0);
  EXPECT_EQ(stay_rules(arm, 9.0).dead_man_s, 5.0);
  EXPECT_EQ(stay_rules(arm, {}).client, 7U);
}

// While the daemon was stopped, or waited for its device, it did not read, so that time does not count.
TEST(StayWatch, TimeInWhichNobodyListenedIsNoSilence) {
  StayWatch watch;
  watch.begin({7, 1.0});
  for (int i = 0; i < 9; ++i) EXPECT_FALSE(watch.why_to_fall({true, 0}, 30));
}

TEST(StayWatch, ANewSessionAsksAnew) {
  StayWatch watch;
  watch.begin({7, 1.0});
  watch.end();
  EXPECT_FALSE(watch.why_to_fall({false, 0}, 10));
  EXPECT_FALSE(watch.rules().client || watch.rules().dead_man_s);
}

}  // namespace
}  // namespace tacto::playback
