// SPDX-License-Identifier: GPL-3.0-or-later
// Any device, from the host's side: it sends a valid or invalid welcome, then any frames with valid checks
// and any raw bytes. Every call of the client must end within its timeouts (emulated time), and no frame may
// leave the queue without being accounted for by the gaps.
#include "firmware-host/link/client.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace {

using namespace tacto;
using firmware_host::Client;

void demand(bool holds) {
  if (!holds) std::abort();
}

class AnyDevice final : public firmware_host::Transport {
 public:
  AnyDevice(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    if (out_.empty()) say();
    if (out_.empty()) now_s_ += timeout_s;
    const std::size_t size = std::min(bytes.size(), out_.size());
    std::copy_n(out_.begin(), size, bytes.begin());
    out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(size));
    now_s_ += 1e-3;
    return size;
  }
  // A hello is answered with its nonce; otherwise the fuzzer would not get further.
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double) override {
    if (bytes[3] != static_cast<std::uint8_t>(wire::MessageType::hello)) return {};
    wire::Welcome welcome;
    std::memcpy(&welcome.nonce, bytes.data() + wire::kHeaderSize + 4, 4);
    welcome.channels = byte() % 3;
    welcome.notes = byte() % 2;
    welcome.clock_hz = byte();
    append(welcome);
    for (std::uint8_t i = 0; i < welcome.channels; ++i) {
      wire::Channel channel;
      channel.index = i;
      append(channel);
    }
    wire::Note note;
    if (welcome.notes > 0) append(note);
    return {};
  }
  double now_s() override { return now_s_; }

 private:
  std::uint8_t byte() { return left_ > 0 ? (--left_, *data_++) : std::uint8_t{0}; }
  template <class Message>
  void append(const Message& message) {
    std::uint8_t frame[wire::kMaxFrame];
    const std::size_t size = wire::encode_frame(message, sequence_++, frame, sizeof frame);
    out_.insert(out_.end(), frame, frame + size);
  }
  void say() {
    if (left_ == 0) return;
    const std::uint8_t way = byte();
    if (way < 32) return;  // silence
    std::uint8_t frame[wire::kMaxFrame];
    const std::size_t size = std::min<std::size_t>(byte() * std::size_t{way < 64 ? 8U : 1U}, left_);
    std::memcpy(frame + wire::kHeaderSize, data_, std::min(size, wire::kMaxPayload));
    data_ += size;
    left_ -= size;
    if (way < 48) return raw(frame, size);
    sequence_ += way % 16 == 0 ? byte() : 1;
    const auto type = static_cast<std::uint8_t>(0x81 + way % 8);
    const std::size_t whole = wire::seal_frame({1, type, static_cast<std::uint16_t>(size), sequence_}, frame);
    out_.insert(out_.end(), frame, frame + whole);
  }
  void raw(const std::uint8_t* frame, std::size_t size) {
    out_.insert(out_.end(), frame + wire::kHeaderSize, frame + wire::kHeaderSize + size);
  }

  const std::uint8_t* data_;
  std::size_t left_;
  std::vector<std::uint8_t> out_;
  std::uint32_t sequence_ = 0;
  double now_s_ = 0;
};

void take_all(Client& client, std::uint64_t& taken, std::uint64_t& lost) {
  std::vector<std::int32_t> codes(64 * 16);
  auto& queue = client.samples();
  for (bool more = true; more;) {
    while (queue.at_gap()) {
      const schema::Gap gap = queue.take_gap();
      lost += gap.count;
      demand(gap.frame == taken && gap.device_sequence == taken + lost);
    }
    const std::size_t frames = queue.take(codes);
    taken += frames;
    more = frames > 0 || queue.at_gap();
  }
  demand(queue.lost() == lost && queue.pushed() == taken);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto device = std::make_unique<AnyDevice>(data, size);
  AnyDevice& clock = *device;
  auto client = Client::connect(std::move(device), "fuzz:");
  demand(clock.now_s() < 10 + 0.01 * static_cast<double>(size));
  if (!client) return 0;
  (void)(*client)->start_stream(10'000'000, 32);
  std::uint64_t taken = 0, lost = 0;
  for (int i = 0; i < 20; ++i) {
    const bool there = (*client)->await_samples(8).has_value();
    take_all(**client, taken, lost);
    if (!there) break;
  }
  (void)(*client)->heartbeat();
  (void)(*client)->stop_stream();
  demand(clock.now_s() < 60 + 0.1 * static_cast<double>(size));
  return 0;
}
