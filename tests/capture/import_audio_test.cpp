// SPDX-License-Identifier: GPL-3.0-or-later
// Import of sound files written by WavWriter; the oracle test covers other formats (soundfile).
#include <cmath>
#include <limits>

#include "data-schema/wav/wav.hpp"
#include "tests/capture/import_fixture.hpp"
#include "tests/faults.hpp"

namespace tacto::capture {
namespace {

class ImportAudioTest : public ImportTest {
 protected:
  template <class Sample>
  std::string write_wav(const std::string& name, std::size_t channels, schema::SampleFormat format,
                        std::vector<Sample> samples) const {
    auto writer = schema::WavWriter::create(folder_ / name, 48000, channels, format);
    EXPECT_TRUE(writer && writer->write(std::span<const Sample>(samples)) && writer->close());
    return folder_ / name;
  }
};

TEST_F(ImportAudioTest, MonoFloatIsASignalAsItIs) {
  const std::vector<double> samples = {0.1, -0.25, 1.5};
  const auto file = write_wav("a.wav", 1, schema::SampleFormat::float64, samples);
  const auto recording = imported(request(file));
  EXPECT_EQ(stored(recording, 0), samples);
  const auto& channel = recording.header.channels.at(0);
  EXPECT_EQ(channel.name + "/" + channel.quantity + "/" + channel.unit, "signal/signal/1");
  EXPECT_EQ(channel.scale, 1);
  EXPECT_EQ(channel.source, "ch1");
  EXPECT_EQ(recording.header.sample_rate_hz, 48000);
  EXPECT_EQ(recording.header.clock, "rate of the sound file");
}

TEST_F(ImportAudioTest, MonoIntegersKeepTheirCodesAndShowAsAnEditorDoes) {
  const std::vector<std::int32_t> codes = {0, 1, std::numeric_limits<std::int32_t>::min(), 1 << 30};
  const auto file = write_wav("a.wav", 1, schema::SampleFormat::pcm32, codes);
  const auto recording = imported(request(file));
  EXPECT_EQ(stored(recording, 0), (std::vector<double>{0, 1, -2147483648.0, 1073741824.0}));
  EXPECT_EQ(schema::read_channel(recording, 0)->values,
            (std::vector<double>{0, std::ldexp(1.0, -31), -1, 0.5}));
  EXPECT_EQ(recording.header.channels[0].range_min, -1);
  EXPECT_EQ(recording.header.channels[0].range_max, 1 - std::ldexp(1.0, -31));
}

TEST_F(ImportAudioTest, AScaleIsWorthThatMuchACode) {
  const auto file = write_wav("a.wav", 1, schema::SampleFormat::pcm32, std::vector<std::int32_t>{0, 3, -7});
  const auto recording = imported(request(file, {"tangential_force=1*-2mN"}));
  EXPECT_EQ(schema::read_channel(recording, 0)->values[1], 3 * (-2 * 1e-3));
  EXPECT_LT(recording.header.channels[0].range_min, recording.header.channels[0].range_max);
}

TEST_F(ImportAudioTest, ChannelsGoByNumberOrName) {
  const auto file =
      write_wav("a.wav", 3, schema::SampleFormat::float64, std::vector<double>{1, 2, 3, 4, 5, 6});
  const auto recording = imported(request(file, {"position=ch3*1mm", "tangential_force=2*1N"}));
  EXPECT_EQ(stored(recording, 0), (std::vector<double>{3, 6}));
  EXPECT_EQ(stored(recording, 1), (std::vector<double>{2, 5}));
}

TEST_F(ImportAudioTest, SeveralChannelsMustBeNamed) {
  const auto file = write_wav("a.wav", 2, schema::SampleFormat::float64, std::vector<double>{1, 2});
  const auto done = import(request(file));
  ASSERT_FALSE(done);
  EXPECT_NE(schema::message(done.error()).find("1 'ch1', 2 'ch2'"), std::string::npos);
}

TEST_F(ImportAudioTest, ARateOnTheCommandLineOverrulesTheHeader) {
  auto asked = request(write_wav("a.wav", 1, schema::SampleFormat::float64, std::vector<double>{1, 2}));
  asked.rate_hz = 100000;
  const auto header = imported(asked).header;
  EXPECT_EQ(header.sample_rate_hz, 100000);
  EXPECT_EQ(header.clock, "nominal rate, given at import (its header has 48000 Hz)");
}

TEST_F(ImportAudioTest, NanIsRefusedWithItsSample) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto file = write_wav("a.wav", 2, schema::SampleFormat::float64, std::vector<double>{1, 2, 3, nan});
  const auto done = import(request(file, {"signal=2"}));
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, schema::ErrorKind::malformed);
  EXPECT_EQ(done.error().where, file + ": sample 1, column 2 ('ch2')");
  EXPECT_TRUE(import(request(file, {"signal=1"})));
}

TEST_F(ImportAudioTest, AFileWithoutSamplesIsRefused) {
  const auto file = write_wav("a.wav", 1, schema::SampleFormat::float64, std::vector<double>{});
  EXPECT_TRUE(tests::fails(import(request(file)), schema::ErrorKind::malformed, file));
}

TEST_F(ImportAudioTest, ARecordingIsNotImportedAgain) {
  const auto file = write_wav("a.wav", 1, schema::SampleFormat::float64, std::vector<double>{1, 2});
  imported(request(file));
  auto again = request(folder_ / "out.wav");
  again.name = folder_ / "other";
  EXPECT_TRUE(tests::fails(import(again), schema::ErrorKind::unsuitable, folder_ / "out.wav"));
}

}  // namespace
}  // namespace tacto::capture
