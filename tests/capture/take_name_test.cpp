// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/take_name.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::capture {
namespace {

const NameParts kParts = {{"subject", "S01"}, {"surface", "oak, planed/2"}, {"finger", ""}};

TEST(TakeName, CountsUpPastWhatIsThere) {
  const tests::TemporaryFolder folder;
  const std::string pattern = folder / "{subject}_{surface}_{take}";
  EXPECT_EQ(name_of_take(pattern, kParts), folder / "S01_oak--planed-2_1");
  std::ofstream(folder / "S01_oak--planed-2_1.wav");
  std::ofstream(folder / "S01_oak--planed-2_2.json");
  std::ofstream(folder / "S01_oak--planed-2_3.events.jsonl");
  EXPECT_EQ(name_of_take(pattern, kParts), folder / "S01_oak--planed-2_4");
}

TEST(TakeName, ARemovedTakesNumberIsNotGivenAgain) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "S01_2.wav");
  std::ofstream(folder / "S01_7.json");
  std::ofstream(folder / "S01_9.texture.wav");  // no recording
  EXPECT_EQ(name_of_take(folder / "{subject}_{take}", kParts), folder / "S01_8");
  std::ofstream(folder / "S01_9999.wav");
  EXPECT_EQ(name_of_take(folder / "{subject}_{take}", kParts).error().remedy, "choose another template");
}

TEST(TakeName, AFolderMayCountToo) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "3");
  std::ofstream(folder / "3/oak.wav");
  EXPECT_EQ(name_of_take(folder / "{take}/oak", kParts), folder / "4/oak");
}

TEST(TakeName, WithoutATakeItMustBeFree) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(name_of_take(folder / "{subject}", kParts), folder / "S01");
  std::ofstream(folder / "S01.json");
  EXPECT_EQ(name_of_take(folder / "{subject}", kParts).error().remedy, "add {take} to it, which counts up");
}

TEST(TakeName, SaysWhatIsWrongWithTheTemplate) {
  EXPECT_EQ(name_of_take("{person}_{take}", kParts).error().remedy,
            "the placeholders are {take}, {subject}, {surface}, {finger}");
  EXPECT_EQ(name_of_take("{finger}_{take}", kParts).error().remedy, "give it with --finger");
  EXPECT_EQ(name_of_take("{subject", kParts).error().what, "a brace is not closed");
}

}  // namespace
}  // namespace tacto::capture
