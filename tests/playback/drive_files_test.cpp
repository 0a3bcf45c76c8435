// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/drive_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "data-schema/wav/wav.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::playback {
namespace {

namespace fs = std::filesystem;

class DriveFiles : public testing::Test {
 protected:
  std::string in(const std::string& name) const { return folder_ / name; }

  tests::TemporaryFolder folder_;
  schema::TimeSignal signal_{10e3, 0, {0.5, -0.25, 1}};
};

TEST_F(DriveFiles, HoldTheSignal) {
  const std::vector<SignalFile> files{{in("a.wav"), &signal_}, {in("b.wav"), &signal_}};
  ASSERT_TRUE(check_signal_files(files, schema::Existing::keep));
  ASSERT_TRUE(write_signal_files(files, schema::Existing::keep));
  EXPECT_EQ(*schema::read_wav_channel(in("b.wav"), 0), signal_.values);
  EXPECT_EQ(schema::WavReader::open(in("a.wav"))->info().sample_rate_hz, 10e3);
}

TEST_F(DriveFiles, AppearTogetherOrNotAtAll) {
  std::ofstream(in("file")) << "no folder can have this name";
  const std::vector<SignalFile> files{{in("a.wav"), &signal_}, {in("file/b.wav"), &signal_}};
  const auto written = write_signal_files(files, schema::Existing::keep);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, schema::ErrorKind::cannot_write);
  EXPECT_EQ(folder_.files(), 1U);
}

TEST_F(DriveFiles, HoldNoNumberThatIsNotFinite) {
  for (const double odd :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity(), 1e39}) {
    schema::TimeSignal broken = signal_;
    broken.values[1] = odd;
    const auto written = write_signal_files(
        std::vector<SignalFile>{{in("a.wav"), &signal_}, {in("b.wav"), &broken}}, schema::Existing::keep);
    ASSERT_FALSE(written) << odd;
    EXPECT_EQ(written.error().kind, schema::ErrorKind::unsuitable);
    EXPECT_NE(written.error().what.find("sample 1 "), std::string::npos) << written.error().what;
    EXPECT_EQ(folder_.files(), 0U);
  }
}

TEST_F(DriveFiles, NeverTakeTheNameOfARecording) {
  std::ofstream(in("oak.json")) << "{}";
  const std::vector<SignalFile> taken{{in("oak.wav"), &signal_}};
  EXPECT_EQ(check_signal_files(taken, schema::Existing::keep).error().kind, schema::ErrorKind::usage);
  const std::vector<SignalFile> twice{{in("a.wav"), &signal_}, {in("./a.wav"), &signal_}};
  EXPECT_EQ(check_signal_files(twice, schema::Existing::keep).error().kind, schema::ErrorKind::usage);
  const std::vector<SignalFile> other{{in("a.flac"), &signal_}};
  EXPECT_EQ(check_signal_files(other, schema::Existing::keep).error().kind, schema::ErrorKind::usage);
}

}  // namespace
}  // namespace tacto::playback
