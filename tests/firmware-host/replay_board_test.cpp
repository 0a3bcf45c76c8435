// SPDX-License-Identifier: GPL-3.0-or-later
// A recording as a board, controlled over the wire: its codes, its end, repetition, and refusals.
#include "firmware-host/gadget/replay_board.hpp"

#include <gtest/gtest.h>

#include "firmware-host/link/wire_device.hpp"
#include "tests/data-schema/temporary_folder.hpp"
#include "tests/firmware-host/sim_stream.hpp"

namespace tacto::firmware_host {
namespace {

/// The cable in memory; time advances while a reader waits.
class BoardTransport final : public Transport {
 public:
  explicit BoardTransport(GadgetBoard& board) : board_(board) {}

  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    const double until_s = now_s_ + timeout_s;
    for (board_.poll(); board_.to_host().empty() && now_s_ < until_s && board_.ticking(); board_.poll()) {
      board_.step();
      now_s_ += board_.period_s();
    }
    if (board_.to_host().empty()) now_s_ = until_s;
    auto& waiting = board_.to_host();
    const std::size_t size = std::min(bytes.size(), waiting.size());
    std::copy_n(waiting.begin(), size, bytes.begin());
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double) override {
    board_.from_host().insert(board_.from_host().end(), bytes.begin(), bytes.end());
    return {};
  }
  double now_s() override { return now_s_; }

 private:
  GadgetBoard& board_;
  double now_s_ = 0;
};

class ReplayedBoard : public testing::Test {
 protected:
  void SetUp() override { write({}); }

  void write(std::vector<schema::Gap> gaps) {
    stream_ = tests::stream_of("sim:surface=A", 0.05);
    schema::RecordingHeader header;
    header.format = schema::SampleFormat::pcm32;
    header.sample_rate_hz = stream_.capabilities.sample_rate_hz;
    header.channels = stream_.capabilities.channels;
    header.channels[0].unit = "N";
    header.channels[0].calibrated = "2011-05-01";
    header.clock = "device";
    header.simulated = stream_.capabilities.simulated;
    header.transducer = stream_.capabilities.transducer;
    header.gaps = std::move(gaps);
    auto writer = schema::RecordingWriter::create(name_, header, true);
    ASSERT_TRUE(writer && writer->write(std::span<const std::int32_t>(stream_.codes)) && writer->close());
  }

  void open(const std::string& parameters) {
    auto board = make_gadget_board("replay:" + name_ + parameters, "R7");
    ASSERT_TRUE(board) << message(board.error());
    board_ = std::move(*board);
    auto device = WireDevice::open("replay", std::make_unique<BoardTransport>(*board_));
    ASSERT_TRUE(device) << message(device.error());
    device_ = std::move(*device);
  }

  tests::TemporaryFolder folder_;
  std::string name_ = folder_ / "oak";
  tests::SimStream stream_;
  std::unique_ptr<GadgetBoard> board_;
  std::unique_ptr<WireDevice> device_;
};

TEST_F(ReplayedBoard, SaysWhatItIs) {
  open("");
  const Capabilities& said = device_->capabilities();
  EXPECT_EQ(said.name, "replay of oak");
  EXPECT_EQ(said.serial, "R7");
  EXPECT_EQ(board_->serial(), "R7");
  EXPECT_NE(said.simulated.find("replay of oak: itself simulated"), std::string::npos) << said.simulated;
  EXPECT_EQ(said.transducer->name, "wiertlewski2011");
  for (std::size_t i = 0; i < said.channels.size(); ++i) {
    EXPECT_EQ(said.channels[i].name, stream_.capabilities.channels[i].name);
    EXPECT_EQ(said.channels[i].scale, stream_.capabilities.channels[i].scale);
    EXPECT_EQ(said.channels[i].range_max, stream_.capabilities.channels[i].range_max);
  }
  EXPECT_EQ(said.channels[0].calibrated, "2011-05-01");
}

TEST_F(ReplayedBoard, GivesTheSameCodesEachTimeAndThenAConvertersFault) {
  open("");
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(device_->start());
    std::vector<std::int32_t> codes(stream_.codes.size());
    ASSERT_EQ(*device_->read(codes), 500U);
    EXPECT_EQ(codes, stream_.codes);
    const auto beyond = device_->read(codes);
    ASSERT_FALSE(beyond);
    EXPECT_NE(beyond.error().what.find("converter"), std::string::npos) << beyond.error().what;
    ASSERT_TRUE(device_->stop());
  }
}

TEST_F(ReplayedBoard, BeginsAgainWhereItIsLooped) {
  open(",loop=1");
  ASSERT_TRUE(device_->start());
  std::vector<std::int32_t> codes(2 * stream_.codes.size());
  ASSERT_EQ(*device_->read(codes), 1000U);
  std::vector<std::int32_t> twice = stream_.codes;
  twice.insert(twice.end(), stream_.codes.begin(), stream_.codes.end());
  EXPECT_EQ(codes, twice);
}

TEST_F(ReplayedBoard, RefusesGapsAndWhatIsNotThere) {
  EXPECT_EQ(make_gadget_board("replay:" + (folder_ / "ash"), "").error().kind, schema::ErrorKind::not_found);
  EXPECT_EQ(make_gadget_board("piezo:", "").error().kind, schema::ErrorKind::usage);
  write({{100, 120, 20}});
  EXPECT_EQ(make_gadget_board("replay:" + name_, "").error().kind, schema::ErrorKind::unsuitable);
}

}  // namespace
}  // namespace tacto::firmware_host
