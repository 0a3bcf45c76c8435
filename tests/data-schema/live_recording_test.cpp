// SPDX-License-Identifier: GPL-3.0-or-later
// Recordings that were interrupted in every way, and their recovery.
#include "data-schema/recording/live_recording.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "data-schema/check/check.hpp"
#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using tests::TemporaryFolder;
namespace fs = std::filesystem;

RecordingHeader header() {
  RecordingHeader made;
  made.format = SampleFormat::pcm32;
  made.sample_rate_hz = 10000;
  for (const char* name : {"a", "b", "c"}) {
    Channel channel;
    channel.name = name;
    channel.quantity = "signal";
    channel.unit = "1";
    made.channels.push_back(channel);
  }
  made.surface = "oak";
  return made;
}

std::vector<std::int32_t> counted(std::int32_t first, std::int32_t frames) {
  std::vector<std::int32_t> codes;
  for (std::int32_t i = 3 * first; i < 3 * (first + frames); ++i) codes.push_back(i);
  return codes;
}

// 1000 frames with a gap, a mark, a fault and clock pairs of a device that is 40 ppm fast.
LiveRecording begun(const std::string& name) {
  auto live = LiveRecording::create(name, header());
  EXPECT_TRUE(live) << message(live.error());
  EXPECT_TRUE(live->write(counted(0, 600)));
  EXPECT_TRUE(live->add(Gap{600, 607, 7}) && live->add(Mark{600, "lift"}));
  EXPECT_TRUE(live->write(counted(600, 400)));
  for (int i = 0; i < 20; ++i)
    EXPECT_TRUE(live->add(ClockPair{static_cast<std::uint64_t>(i), i * (1 + 40e-6), 100.0 + i}));
  EXPECT_TRUE(live->add(FaultNote{1000, "the enable input opened"}));
  return std::move(*live);
}

void expect_whole(const std::string& name, std::uint64_t frames) {
  const auto recording = open_recording(name);
  ASSERT_TRUE(recording) << message(recording.error());
  const RecordingHeader& told = recording->header;
  EXPECT_EQ(told.frames, frames);
  EXPECT_EQ(told.gaps.size(), 1U);
  EXPECT_EQ(told.marks.at(0).label, "lift");
  EXPECT_EQ(told.faults.at(0).what, "the enable input opened");
  EXPECT_EQ(told.clock_pairs.size(), 20U);
  EXPECT_NEAR(told.clock_drift_ppm.value_or(0), 40, 1e-6);
  const auto stored = read_stored(*recording, 1);
  for (std::size_t i = 0; i < stored->size(); ++i) ASSERT_EQ((*stored)[i], static_cast<double>(3 * i + 1));
  const auto checked = check_file({FileKind::recording, name + ".json"});
  ASSERT_TRUE(checked);
  for (const Finding& finding : checked->findings) ADD_FAILURE() << finding.where << ": " << finding.what;
}

TEST(LiveRecording, FoldsItsEventsIntoTheSidecar) {
  const TemporaryFolder folder;
  auto live = begun(folder / "oak");
  EXPECT_TRUE(fs::exists(folder / "oak.events.jsonl") && !fs::exists(folder / "oak.json"));
  ASSERT_TRUE(live.close());
  EXPECT_FALSE(fs::exists(folder / "oak.events.jsonl"));
  expect_whole(folder / "oak", 1000);
  EXPECT_EQ(open_recording(folder / "oak")->header.ended, "");
}

TEST(LiveRecording, DroppedOnesAreRecovered) {
  const TemporaryFolder folder;
  { const auto dropped = begun(folder / "oak"); }
  EXPECT_EQ(open_recording(folder / "oak").error().kind, ErrorKind::unsuitable);
  EXPECT_NE(open_recording(folder / "oak").error().remedy.find("recover"), std::string::npos);
  const auto recovered = recover_recording(folder / "oak.wav");
  ASSERT_TRUE(recovered) << message(recovered.error());
  expect_whole(folder / "oak", 1000);
  EXPECT_EQ(recovered->recording.header.ended, "broken off");
  EXPECT_EQ(recover_recording(folder / "oak").error().what, "was closed and needs no recovery");
}

// Remains of a crash: a header with another length than the data, half a frame, half a line.
TEST(LiveRecording, BrokenFramesAndLinesAreCutOff) {
  const TemporaryFolder folder;
  { const auto dropped = begun(folder / "oak"); }
  std::ofstream(folder / "oak.wav", std::ios::app | std::ios::binary) << std::string(12 * 5 + 7, '\1');
  std::ofstream(folder / "oak.events.jsonl", std::ios::app) << "{\"event\":\"mark\",\"fra";
  const auto recovered = recover_recording(folder / "oak.events.jsonl");
  ASSERT_TRUE(recovered) << message(recovered.error());
  EXPECT_EQ(recovered->recording.header.frames, 1005U);
  EXPECT_EQ(recovered->notes.size(), 3U);
  EXPECT_TRUE(check_file({FileKind::recording, folder / "oak.json"})->findings.empty());
}

TEST(LiveRecording, AHeaderFromTheVeryBeginningIsPutRight) {
  const TemporaryFolder folder;
  std::string header_alone;
  {
    const auto live = LiveRecording::create(folder / "oak", header());
    header_alone = *read_file(folder / "oak.wav");
    EXPECT_GT(header_alone.size(), 40U);
  }
  std::ofstream(folder / "oak.wav", std::ios::binary) << header_alone << std::string(12 * 50, '\2');
  const auto recovered = recover_recording(folder / "oak");
  ASSERT_TRUE(recovered) << message(recovered.error());
  EXPECT_EQ(recovered->recording.header.frames, 50U);
  EXPECT_TRUE(check_file({FileKind::recording, folder / "oak.json"})->findings.empty());
}

void overwrite(const std::string& path, std::size_t at, const std::string& bytes) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(at));
  file << bytes;
}

std::string joined(const std::vector<std::string>& notes) {
  std::string all;
  for (const std::string& note : notes) all += note + "\n";
  return all;
}

// The header is rewritten all the time, so a power failure is likely to destroy it.
TEST(LiveRecording, ALostHeaderIsWrittenAnewByTheJournal) {
  for (const std::size_t lost : {4, 12, 50, 70, 112}) {
    const TemporaryFolder folder;
    { const auto dropped = begun(folder / "oak"); }
    overwrite(folder / "oak.wav", lost == 50 ? 48 : 0, std::string(lost, '\0'));
    const auto recovered = recover_recording(folder / "oak");
    ASSERT_TRUE(recovered) << message(recovered.error());
    EXPECT_NE(joined(recovered->notes).find("header of its WAV was damaged"), std::string::npos);
    expect_whole(folder / "oak", 1000);
  }
}

TEST(LiveRecording, APageOfZerosCostsItsFramesAndIsNoted) {
  const TemporaryFolder folder;
  { const auto dropped = begun(folder / "oak"); }
  overwrite(folder / "oak.wav", 0, std::string(4096, '\0'));
  const auto recovered = recover_recording(folder / "oak");
  ASSERT_TRUE(recovered) << message(recovered.error());
  EXPECT_EQ(recovered->recording.header.frames, 1000U);
  EXPECT_NE(joined(recovered->notes).find("332 frames (0.0332 s)"), std::string::npos);
}

TEST(LiveRecording, WhatIsNotItsWavIsLeftAsItIs) {
  const TemporaryFolder folder;
  { const auto dropped = begun(folder / "oak"); }
  const std::string text(5000, 'x');
  std::ofstream(folder / "oak.wav", std::ios::binary) << text;
  EXPECT_EQ(recover_recording(folder / "oak").error().kind, ErrorKind::malformed);
  EXPECT_EQ(*read_file(folder / "oak.wav"), text);
  EXPECT_TRUE(fs::exists(folder / "oak.events.jsonl") && !fs::exists(folder / "oak.json"));
  fs::remove(folder / "oak.wav");
  EXPECT_EQ(recover_recording(folder / "oak").error().kind, ErrorKind::not_found);
  EXPECT_EQ(folder.files(), 1U);
}

// The journal covers a second or more, the WAV less.
TEST(LiveRecording, WhatTheJournalKnowsAndTheWavLacksIsSaid) {
  const TemporaryFolder folder;
  {
    auto live = begun(folder / "oak");
    ASSERT_TRUE(live.write(counted(1000, 1000)) && live.add(Mark{2000, "late"}));
  }
  fs::resize_file(folder / "oak.wav", 40);
  EXPECT_EQ(recover_recording(folder / "oak").error().kind, ErrorKind::malformed);
  EXPECT_EQ(fs::file_size(folder / "oak.wav"), 40U);
  overwrite(folder / "oak.wav", 0, std::string(112 + 12, '\0'));
  const auto recovered = recover_recording(folder / "oak");
  ASSERT_TRUE(recovered) << message(recovered.error());
  EXPECT_EQ(recovered->recording.header.frames, 1U);
  EXPECT_NE(joined(recovered->notes).find("1999 frames (0.2 s)"), std::string::npos);
}

// Caused by a bad disk, or by a file that was edited.
TEST(LiveRecording, ABadLineOfTheJournalCostsThatLineAlone) {
  const TemporaryFolder folder;
  { const auto dropped = begun(folder / "oak"); }
  const std::string events = *read_file(folder / "oak.events.jsonl");
  const auto first_end = events.find('\n') + 1;
  std::ofstream(folder / "oak.events.jsonl", std::ios::binary)
      << events.substr(0, first_end) << "{\"event\": \"g\xff\n"
      << events.substr(first_end) << "\xfe{";
  const auto recovered = recover_recording(folder / "oak");
  ASSERT_TRUE(recovered) << message(recovered.error());
  EXPECT_NE(joined(recovered->notes).find("line 2)"), std::string::npos);
  EXPECT_NE(joined(recovered->notes).find("?{"), std::string::npos);
  EXPECT_EQ(recovered->notes, recovered->recording.header.warnings);
  expect_whole(folder / "oak", 1000);
}

// The device numbers its frames, so a gap is known even if the line about it is lost.
TEST(LiveRecording, TheGapOfALostLineIsCountedToTheNext) {
  const TemporaryFolder folder;
  {
    auto live = begun(folder / "oak");
    ASSERT_TRUE(live.add(Gap{1000, 1007 + 5 + 3, 3}) && live.add(Gap{1000, 1007 + 5 + 3, 3}));
    ASSERT_TRUE(live.write(counted(1000, 10)) && live.add(Mark{2000, "lost"}) &&
                live.add(Gap{2000, 2020, 5}));
  }
  const auto recovered = recover_recording(folder / "oak");
  ASSERT_TRUE(recovered) << message(recovered.error());
  const auto& gaps = recovered->recording.header.gaps;
  ASSERT_EQ(gaps.size(), 2U);
  EXPECT_EQ(gaps[1].count, 8U);
  EXPECT_EQ(gaps[1].device_sequence, 1015U);
  EXPECT_EQ(recovered->recording.header.marks.size(), 1U);
  const std::string notes = joined(recovered->notes);
  for (const char* said : {"1 gaps of its journal contradict", "5 missing frames are in no readable line",
                           "1 marks and 1 gaps are beyond its last frame, 1010", "at least 990 frames"})
    EXPECT_NE(notes.find(said), std::string::npos) << said << " in " << notes;
}

TEST(LiveRecording, ZerosThatTheHeaderNeverPromisedAreNoSamples) {
  const TemporaryFolder folder;
  { const auto dropped = begun(folder / "oak"); }
  std::ofstream(folder / "oak.wav", std::ios::app | std::ios::binary) << std::string(12 * 10000, '\0');
  const auto recovered = recover_recording(folder / "oak");
  ASSERT_TRUE(recovered) << message(recovered.error());
  EXPECT_NE(joined(recovered->notes).find("10000 frames (1 s)"), std::string::npos);
  expect_whole(folder / "oak", 1000);
}

TEST(LiveRecording, WithoutASampleThereIsAnEmptyRecording) {
  const TemporaryFolder folder;
  { const auto live = LiveRecording::create(folder / "oak", header()); }
  fs::resize_file(folder / "oak.wav", 0);  // a power failure before its header was on the disk
  ASSERT_TRUE(recover_recording(folder / "oak"));
  EXPECT_TRUE(check_file({FileKind::recording, folder / "oak.json"})->findings.empty());
}

TEST(LiveRecording, ClosedBetweenItsLastTwoStepsIsWhole) {
  const TemporaryFolder folder;
  auto live = begun(folder / "oak");
  const std::string events = *read_file(folder / "oak.events.jsonl");
  ASSERT_TRUE(live.close());
  std::ofstream(folder / "oak.events.jsonl") << events;
  ASSERT_TRUE(recover_recording(folder / "oak"));
  EXPECT_EQ(open_recording(folder / "oak")->header.ended, "");
  EXPECT_FALSE(fs::exists(folder / "oak.events.jsonl"));
}

TEST(LiveRecording, WhereItsFolderWasRenamedTheFramesAreSaidToBeThere) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "here");
  {
    auto live = begun(folder / "here/oak");
    fs::rename(folder / "here", folder / "there");
    const auto closed = live.close();
    ASSERT_FALSE(closed);
    EXPECT_EQ(closed.error().kind, ErrorKind::cannot_write);
    EXPECT_NE(
        closed.error().remedy.find("tactograph recover " +
                                   fs::canonical(folder / "there/oak.wav").replace_extension().string()),
        std::string::npos)
        << message(closed.error());
  }
  ASSERT_TRUE(recover_recording(folder / "there/oak"));
  expect_whole(folder / "there/oak", 1000);
}

TEST(LiveRecording, WhereItsFilesWereDeletedThatIsSaid) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "here");
  auto live = begun(folder / "here/oak");
  fs::remove_all(folder / "here");
  const auto closed = live.close();
  ASSERT_FALSE(closed);
  EXPECT_EQ(closed.error().kind, ErrorKind::cannot_write);
  EXPECT_NE(closed.error().what.find("deleted"), std::string::npos);
}

TEST(LiveRecording, OneUnderWayIsLeftAlone) {
  const TemporaryFolder folder;
  auto live = begun(folder / "oak");
  EXPECT_EQ(recover_recording(folder / "oak").error().what, "is still being recorded");
  ASSERT_TRUE(live.close());
  expect_whole(folder / "oak", 1000);
}

TEST(LiveRecording, NothingIsOverwritten) {
  const TemporaryFolder folder;
  for (const char* taken : {"oak.wav", "oak.json", "oak.events.jsonl"}) {
    std::ofstream(folder / taken) << "mine";
    EXPECT_EQ(LiveRecording::create(folder / "oak", header()).error().kind, ErrorKind::usage) << taken;
    EXPECT_EQ(*read_file(folder / taken), "mine");
    fs::remove(folder / taken);
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(LiveRecording, DiscardedItLeavesNothing) {
  const TemporaryFolder folder;
  auto live = LiveRecording::create(folder / "oak", header());
  ASSERT_TRUE(live->discard());
  EXPECT_EQ(folder.files(), 0U);
}

TEST(LiveRecording, NothingToRecoverIsSaid) {
  const TemporaryFolder folder;
  EXPECT_EQ(recover_recording(folder / "oak").error().kind, ErrorKind::not_found);
  std::ofstream(folder / "oak.events.jsonl") << "{\"event\":\"beg";
  EXPECT_EQ(recover_recording(folder / "oak").error().kind, ErrorKind::unsuitable);
  std::ofstream(folder / "oak.events.jsonl") << "{\"event\":\"begin\"}\n";
  EXPECT_EQ(recover_recording(folder / "oak").error().kind, ErrorKind::malformed);
}

}  // namespace
}  // namespace tacto::schema
