// SPDX-License-Identifier: GPL-3.0-or-later
// A recording on a disk that is slow or fails; this program replaces fdatasync().
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <thread>

#include "data-schema/recording/live_recording.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace {

std::atomic<bool> disk_is_busy = false, disk_fails = false, is_syncing = false;

}  // namespace

extern "C" int fdatasync(int) {
  is_syncing = true;
  for (int ms = 0; disk_is_busy && ms < 2000; ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  is_syncing = false;
  if (!disk_fails) return 0;
  errno = EIO;
  return -1;
}

namespace tacto::schema {
namespace {

constexpr std::size_t kBlockFrames = 200;

LiveRecording counting(const std::string& name) {
  RecordingHeader header;
  header.format = SampleFormat::pcm32;
  header.sample_rate_hz = 10000;
  Channel channel;
  channel.name = channel.quantity = "signal";
  channel.unit = "1";
  header.channels = {channel};
  auto live = LiveRecording::create(name, header);
  EXPECT_TRUE(live) << message(live.error());
  return std::move(*live);
}

bool soon(const auto& happens) {
  for (int ms = 0; ms < 2000 && !happens(); ++ms) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return happens();
}

// Data in the file survive a crash of the process; data in memory that wait for the disk do not.
TEST(LiveRecordingSync, ABusyDiskKeepsNoFrameFromTheFile) {
  const tests::TemporaryFolder folder;
  auto live = counting(folder / "oak");
  const std::vector<std::int32_t> block(kBlockFrames, 7);
  disk_is_busy = true;
  ASSERT_TRUE(live.write(block));
  EXPECT_TRUE(soon([] { return is_syncing.load(); }));
  for (int i = 1; i < 50; ++i) ASSERT_TRUE(live.write(block) && live.add(Mark{kBlockFrames, "lift"}));
  EXPECT_TRUE(is_syncing);
  EXPECT_GE(std::filesystem::file_size(folder / "oak.wav"), 50 * kBlockFrames * sizeof(std::int32_t));
  disk_is_busy = false;
  ASSERT_TRUE(live.close());
}

TEST(LiveRecordingSync, ADiskThatFailsIsSaidToTheWriter) {
  const tests::TemporaryFolder folder;
  auto live = counting(folder / "oak");
  disk_fails = true;
  Error error;
  EXPECT_TRUE(soon([&] {
    const auto written = live.write(std::vector<std::int32_t>(kBlockFrames, 7));
    if (!written) error = written.error();
    return !written;
  }));
  disk_fails = false;
  EXPECT_EQ(error.kind, ErrorKind::cannot_write);
  EXPECT_EQ(error.kind, ErrorKind::cannot_write);
}

}  // namespace
}  // namespace tacto::schema
