// SPDX-License-Identifier: GPL-3.0-or-later
// Sample files, against headers that this test writes byte by byte.
#include "data-schema/wav/wav.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

#include "data-schema/files/files.hpp"
#include "tests/data-schema/temporary_folder.hpp"

namespace tacto::schema {
namespace {

using tests::TemporaryFolder;

std::string little_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xFF);
  return text;
}

// A plain integer WAV of one channel at 8 kHz; `promised` is the size in the data chunk's header, in bytes.
std::string wav_of(const std::vector<std::int64_t>& codes, int bits, std::uint64_t promised) {
  const int bytes = bits / 8;
  std::string data;
  for (const auto code : codes) data += little_endian(static_cast<std::uint64_t>(code), bytes);
  const std::string format = little_endian(1, 2) + little_endian(1, 2) + little_endian(8000, 4) +
                             little_endian(8000U * static_cast<unsigned>(bytes), 4) +
                             little_endian(bytes, 2) + little_endian(bits, 2);
  return "RIFF" + little_endian(36 + promised, 4) + "WAVEfmt " + little_endian(16, 4) + format + "data" +
         little_endian(promised, 4) + data;
}

void put(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<double> all_of(WavReader& reader) {
  std::vector<double> values(reader.info().frames * reader.info().channels);
  EXPECT_EQ(reader.read(std::span(values)).value(), reader.info().frames);
  return values;
}

TEST(WavReader, GivesPlainCodesOfEveryWidth) {
  const TemporaryFolder folder;
  for (const int bits : {16, 24, 32}) {
    const std::int64_t top = (std::int64_t{1} << (bits - 1)) - 1;
    const std::vector<std::int64_t> codes = {0, 1, -1, top, -top - 1, 12345};
    put(folder / "a.wav", wav_of(codes, bits, codes.size() * static_cast<std::size_t>(bits / 8)));
    auto reader = WavReader::open(folder / "a.wav");
    ASSERT_TRUE(reader) << message(reader.error());
    EXPECT_TRUE(reader->info().integer);
    EXPECT_EQ(reader->info().sample_rate_hz, 8000);
    EXPECT_EQ(all_of(*reader), std::vector<double>(codes.begin(), codes.end())) << bits;
    ASSERT_TRUE(reader->seek(1));
    std::array<std::int32_t, 2> justified{};
    ASSERT_EQ(reader->read(std::span(justified)).value(), 2U);
    EXPECT_EQ(justified, (std::array<std::int32_t, 2>{1 << (32 - bits), -1 * (1 << (32 - bits))})) << bits;
  }
}

TEST(WavReader, SaysHowMuchOfATruncatedFileIsLeft) {
  const TemporaryFolder folder;
  put(folder / "a.wav", wav_of({1, 2, 3}, 16, 20));
  const auto reader = WavReader::open(folder / "a.wav");
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().kind, ErrorKind::malformed);
  EXPECT_EQ(reader.error().where, folder / "a.wav");
}

TEST(WavReader, ReadsWhatWasWrittenToAPipe) {
  const TemporaryFolder folder;
  put(folder / "a.wav", wav_of({1, 2, 3}, 16, 0xFFFFFFFF));
  auto reader = WavReader::open(folder / "a.wav");
  ASSERT_TRUE(reader) << message(reader.error());
  EXPECT_EQ(all_of(*reader), (std::vector<double>{1, 2, 3}));
}

TEST(WavReader, RefusesWhatItCantRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(WavReader::open(folder / "absent.wav").error().what, "there is no such file");
  EXPECT_EQ(WavReader::open(folder / "").error().what, "is a folder, not a file");
  put(folder / "a.wav", "time,force\n0,1\n");
  EXPECT_EQ(WavReader::open(folder / "a.wav").error().kind, ErrorKind::malformed);
  for (const std::size_t bytes : {0U, 4U, 20U, 40U}) {
    put(folder / "a.wav", wav_of({1, 2, 3}, 16, 6).substr(0, bytes));
    EXPECT_EQ(WavReader::open(folder / "a.wav").error().kind, ErrorKind::malformed) << bytes;
  }
  put(folder / "a.wav", wav_of({1, 2, 3}, 16, 6));
  auto reader = WavReader::open(folder / "a.wav");
  EXPECT_EQ(reader->seek(4).error().kind, ErrorKind::malformed);
  EXPECT_EQ(read_wav_channel(folder / "a.wav", 1).error().kind, ErrorKind::unsuitable);
}

TEST(WavReader, RefusesToReadAChannelOfWhatIsCompressed) {
  const TemporaryFolder folder;
  std::string compressed = wav_of({1, 2, 3, 4}, 16, 8);
  compressed[20] = 6;                      // A-law
  compressed[32] = 1, compressed[34] = 8;  // a byte a frame
  put(folder / "a.wav", compressed);
  const auto samples = read_wav_channel(folder / "a.wav", 0);
  ASSERT_FALSE(samples);
  EXPECT_EQ(samples.error().kind, ErrorKind::unsuitable);
  EXPECT_EQ(samples.error().where, folder / "a.wav");
}

TEST(WavWriter, GivesEveryBitBack) {
  const TemporaryFolder folder;
  const std::vector<double> samples = {0.1,    -1e300, 5e-324, 0, std::numeric_limits<double>::infinity(),
                                       4.0 / 9};
  auto writer = WavWriter::create(folder / "a.wav", 1000, 2, SampleFormat::float64).value();
  ASSERT_TRUE(writer.write(std::span(samples)));
  ASSERT_TRUE(writer.close());
  auto reader = WavReader::open(folder / "a.wav").value();
  EXPECT_EQ(reader.info().frames, 3U);
  EXPECT_EQ(all_of(reader), samples);
  std::array<std::int32_t, 2> codes{};
  EXPECT_EQ(reader.read(std::span(codes)).error().kind, ErrorKind::unsuitable);
}

TEST(WavWriter, KeepsTheHeaderTrueAsItGrows) {
  const TemporaryFolder folder;
  const std::vector<std::int32_t> codes = {1, 2, 3, -4};
  auto writer = WavWriter::create(folder / "a.wav", 1000, 1, SampleFormat::pcm32).value();
  for (const std::size_t frames : {4U, 8U}) {
    ASSERT_TRUE(writer.write(std::span(codes)));
    const auto reader = WavReader::open(folder / "a.wav");
    ASSERT_TRUE(reader) << message(reader.error());
    EXPECT_EQ(reader->info().frames, frames);
  }
}

TEST(WavWriter, MakesPlainWavWithoutPeakOrDate) {
  const TemporaryFolder folder;
  const std::vector<double> samples = {0.5, -0.25};
  for (const auto format : {SampleFormat::float32, SampleFormat::float64}) {
    auto writer = WavWriter::create(folder / "a.wav", 1e6, 1, format).value();
    ASSERT_TRUE(writer.write(std::span(samples)));
    ASSERT_TRUE(writer.close());
    const std::string bytes = read_file(folder / "a.wav").value();
    EXPECT_EQ(bytes.substr(0, 4), "RIFF");
    EXPECT_EQ(bytes.substr(8, 4), "WAVE");
    EXPECT_EQ(bytes.find("PEAK"), std::string::npos);
  }
}

TEST(WavWriter, RefusesRatesThatNoHeaderHolds) {
  const TemporaryFolder folder;
  for (const double rate : {0.0, -1.0, 0.4, 3e9, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(WavWriter::create(folder / "a.wav", rate, 1, SampleFormat::float32).error().kind,
              ErrorKind::usage);
  EXPECT_EQ(WavWriter::create(folder / "absent/a.wav", 10, 1, SampleFormat::float32).error().kind,
            ErrorKind::cannot_write);
  EXPECT_EQ(folder.files(), 0U);
}

// Above 4 GB the header is RF64. The file is sparse, so it needs no disk space.
TEST(WavReader, CountsFramesBeyondFourGigabytes) {
  const TemporaryFolder folder;
  constexpr std::uint64_t kFrames = 2'500'000'000;
  const std::string plain = wav_of({}, 16, 0xFFFFFFFF);
  const std::string head = "RF64" + little_endian(0xFFFFFFFF, 4) + "WAVEds64" + little_endian(28, 4) +
                           little_endian(72 + 2 * kFrames, 8) + little_endian(2 * kFrames, 8) +
                           little_endian(kFrames, 8) + little_endian(0, 4) + plain.substr(12);
  put(folder / "a.wav", head);
  std::filesystem::resize_file(folder / "a.wav", head.size() + 2 * kFrames);
  const auto whole = WavReader::open(folder / "a.wav");
  ASSERT_TRUE(whole) << message(whole.error());
  EXPECT_EQ(whole->info().frames, kFrames);
  std::filesystem::resize_file(folder / "a.wav", head.size() + 2 * kFrames - 200);
  EXPECT_EQ(WavReader::open(folder / "a.wav").error().what,
            "truncated: its header has 2500000000 frames, the file 2499999900");
}

}  // namespace
}  // namespace tacto::schema
