// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/link/client.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/base/format_version.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/link/line_load.hpp"
#include "firmware-host/link/wire_words.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using wire::MessageType;
using wire::Parse;

constexpr double kAnswerTimeoutS = 0.5;
constexpr double kStallS = 1;
constexpr int kAttempts = 3;
constexpr double kFlushBits = 10.0 * wire::kMaxFrame;  // on a serial line
constexpr double kMostBehindS = 10;  // of frames queued before an answer; no device queues more
constexpr std::size_t kReceiveBytes = 16384;
constexpr std::size_t kFirstBytes = 32;       // of a foreign device, for the message
constexpr std::size_t kMostTicksKept = 4096;  // messages; 40 s if no caller fetches them

// "Hello\x0d\x0a"
std::string text_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes)
    text +=
        byte >= ' ' && byte <= '~' ? std::string(1, static_cast<char>(byte)) : fmt::format("\\x{:02x}", byte);
  return text;
}

template <class Message>
bool understood(const wire::Frame& frame, Message& message) {
  return wire::parse(frame.payload, frame.header.length, message) == Parse::ok;
}

}  // namespace

void SampleQueue::begin(std::size_t channels) {
  *this = {};
  channels_ = std::max<std::size_t>(channels, 1);
}

void SampleQueue::note_gap(std::uint64_t first_frame) {
  if (first_frame <= next_frame_) return;
  const std::uint64_t missing = first_frame - next_frame_;
  gaps_.push_back({pushed_, first_frame, missing});
  lost_ += missing;
  next_frame_ = first_frame;
}

void SampleQueue::push(const wire::Samples& samples) {
  if (samples.channels != channels_) return;
  const std::uint64_t end = samples.first_frame + samples.count;
  if (end <= next_frame_) return;
  note_gap(samples.first_frame);
  const std::size_t known = next_frame_ - samples.first_frame;
  const std::span<const std::int32_t> codes(samples.codes, samples.count * channels_);
  codes_.insert(codes_.end(), codes.begin() + known * channels_, codes.end());
  pushed_ += end - next_frame_;
  next_frame_ = end;
}

std::size_t SampleQueue::frames() const {
  const std::uint64_t end = gaps_.empty() ? pushed_ : gaps_.front().frame;
  return end - taken_;
}

schema::Gap SampleQueue::take_gap() {
  const schema::Gap gap = gaps_.front();
  gaps_.pop_front();
  return gap;
}

std::size_t SampleQueue::take(std::span<std::int32_t> interleaved) {
  const std::size_t count = std::min(frames(), interleaved.size() / channels_);
  std::copy_n(codes_.begin() + used_, count * channels_, interleaved.begin());
  used_ += count * channels_;
  taken_ += count;
  compact();
  return count;
}

// Moves the remaining codes to the front when they are less than half.
void SampleQueue::compact() {
  if (used_ * 2 < codes_.size()) return;
  codes_.erase(codes_.begin(), codes_.begin() + used_);
  used_ = 0;
}

Client::Client(std::unique_ptr<Transport> transport, std::string where)
    : transport_(std::move(transport)), where_(std::move(where)), received_(kReceiveBytes) {}

Result<std::unique_ptr<Client>> Client::connect(std::unique_ptr<Transport> transport, std::string where) {
  std::unique_ptr<Client> client(new Client(std::move(transport), std::move(where)));
  TACTO_TRY(client->greet());
  return client;
}

Result<void> Client::greet() {
  Asking asking{transport_->now_s(), blocks_seen_, transport_->start_up_s()};
  while (may_retry(asking)) {
    if (const auto flushed = asking.times % 2 == 0 ? flush() : Result<void>(); !flushed) return flushed;
    const auto greeted = greet_once();
    TACTO_TRY(greeted);
    if (!description_.welcome.major) continue;
    if (const auto version = check_version(); !version) return version;
    if (*greeted) return {};
  }
  return silent(MessageType::hello, asking);
}

// With a slow bus a device may have seconds of frames queued before its answer. While frames arrive, it is
// not silent.
bool Client::may_retry(Asking& asking) const {
  const bool sends = blocks_seen_ > asking.blocks_seen;
  asking.blocks_seen = blocks_seen_;
  const double asked_s = transport_->now_s() - asking.since_s;
  const bool waits = asked_s < asking.at_least_s || (sends && asked_s < kMostBehindS);
  if (asking.times >= kAttempts && !waits) return false;
  ++asking.times;
  return true;
}

// An earlier program may have sent an incomplete frame. These zeros complete it, so that the device finds the
// next hello. Not before every hello: a device that receives slowly would never reach the last one.
Result<void> Client::flush() {
  constexpr std::array<std::uint8_t, wire::kMaxFrame> kNoFrame{};
  return transport_->write(kNoFrame, kAnswerTimeoutS);
}

// True if the whole description has been received.
Result<bool> Client::greet_once() {
  description_ = {};
  description_.welcome.major = 0;
  order_.expect_any();
  const auto now_us = static_cast<std::uint64_t>(transport_->now_s() * 1e6);
  nonce_ = nonce_ * 1664525 + 1013904223 + static_cast<std::uint32_t>(now_us);
  wire::Hello hello;
  hello.nonce = nonce_;
  const auto sent = send([&](std::uint32_t sequence, std::span<std::uint8_t> frame) {
    return wire::encode_frame(hello, sequence, frame.data(), frame.size());
  });
  TACTO_TRY(sent);
  // A slow line may carry the description for an earlier hello first.
  return await(kAnswerTimeoutS + kFlushBits / transport_->baud(), [&] { return described(); });
}

// From another version only the welcome is expected.
bool Client::described() const {
  const wire::Welcome& welcome = description_.welcome;
  if (welcome.major == 0) return false;
  if (welcome.major != wire::kProtocolMajor) return true;
  const bool forces = (welcome.features & wire::kFeatureForces) != 0;
  return description_.channels.size() == welcome.channels && description_.notes.size() == welcome.notes &&
         description_.axes.has_value() == forces;
}

Result<void> Client::check_version() const {
  const wire::Welcome& device = description_.welcome;
  if (device.major == wire::kProtocolMajor) {
    const auto version_words = [](int minor) { return fmt::format("{}.{}", wire::kProtocolMajor, minor); };
    TACTO_TRY(schema::newer_version(version_words(device.minor), where_, where_,
                                    version_words(wire::kProtocolMinor)));
    return {};
  }
  return fail(ErrorKind::unsupported_version,
              fmt::format("'{}' (serial {}, firmware {}) uses version {}.{} of the protocol; {} uses {}.{}",
                          device.name, device.serial, device.firmware, device.major, device.minor, kCreator,
                          wire::kProtocolMajor, wire::kProtocolMinor),
              where_,
              device.major > wire::kProtocolMajor
                  ? "update tactograph"
                  : "make the firmware again with ./bootstrap firmware and flash it "
                    "(firmware-host/boards/README.md)");
}

Result<std::uint32_t> Client::send(const Encoder& encode) {
  std::array<std::uint8_t, wire::kMaxFrame> frame;
  const std::uint32_t sequence = sequence_++;
  const std::size_t size = encode(sequence, frame);
  sent_.assign(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
  const auto written = transport_->write(sent_, kAnswerTimeoutS);
  TACTO_TRY(written);
  return sequence;
}

template <class Done>
Result<bool> Client::await(double timeout_s, Done done) {
  const double deadline_s = transport_->now_s() + timeout_s;
  while (!done()) {
    const double left_s = deadline_s - transport_->now_s();
    if (left_s <= 0) return false;
    TACTO_TRY(receive(left_s));
  }
  return true;
}

// The answer may be to any of the attempts.
Result<void> Client::exchange(const Encoder& encode, MessageType type) {
  answer_.reset();
  const std::uint32_t first = sequence_;
  Asking asking{transport_->now_s(), blocks_seen_};
  while (may_retry(asking)) {
    TACTO_TRY(send(encode));
    const auto answered = await(kAnswerTimeoutS, [&] {
      return answer_ && answer_->of == type && answer_->of_sequence - first < sequence_ - first;
    });
    TACTO_TRY(answered);
    if (!*answered) continue;
    if (answer_->code != wire::AnswerCode::ok) return refused(type, *answer_);
    if (type == MessageType::stream_stop) stream_bytes_per_s_ = 0;
    if (type == MessageType::disarm) tick_bytes_per_s_ = 0;
    if (on_command_done_) on_command_done_(sent_);
    return {};
  }
  return silent(type, asking);
}

tl::unexpected<schema::Error> Client::refused(MessageType type, const wire::Answer& answer) const {
  FaultWords words = words_of(answer.code, answer.detail);
  return fail(ErrorKind::device, fmt::format("{} was refused: {}", to_string(type), words.what), where_,
              std::move(words.remedy));
}

tl::unexpected<schema::Error> Client::silent(MessageType type, const Asking& asking) const {
  if (!first_.empty() && decoder_.counts().frames == 0)
    return fail(
        ErrorKind::device,
        fmt::format("the device speaks no tactograph wire; its first bytes are '{}'", text_of(first_)),
        where_, "connect a tactograph device, or install its firmware on this board");
  return fail(ErrorKind::device,
              fmt::format("the device did not answer {} (sent {} times in {:g} s)", to_string(type),
                          asking.times, asking.times * kAnswerTimeoutS),
              where_, "unplug it and plug it in again");
}

Result<void> Client::send_drive(const wire::Drive& drive) {
  const auto sent = send([&](std::uint32_t sequence, std::span<std::uint8_t> frame) {
    return wire::encode_frame(drive, sequence, frame.data(), frame.size());
  });
  TACTO_TRY(sent);
  return {};
}

Result<wire::Pulse> Client::heartbeat() {
  pulse_.reset();
  Asking asking{transport_->now_s(), blocks_seen_};
  while (may_retry(asking)) {
    std::uint32_t token = 0;
    const auto sent = send([&](std::uint32_t sequence, std::span<std::uint8_t> frame) {
      token = sequence;
      return wire::encode_frame(wire::Heartbeat{token}, sequence, frame.data(), frame.size());
    });
    TACTO_TRY(sent);
    const auto answered = await(kAnswerTimeoutS, [&] { return pulse_ && pulse_->token == token; });
    TACTO_TRY(answered);
    if (*answered) return *pulse_;
  }
  return silent(MessageType::heartbeat, asking);
}

Result<void> Client::start_stream(std::uint32_t rate_millihertz, std::uint8_t block_frames) {
  const double rate_hz = 1e-3 * rate_millihertz;
  const double frame_bytes = bytes_per_frame(description_.channels.size(), block_frames);
  TACTO_TRY(check_line(
      {transport_->baud(), tick_bytes_per_s_}, rate_hz, [&](double) { return frame_bytes; }, where_));
  samples_.begin(description_.channels.size());
  last_arrival_.reset();
  converter_failed_ = false;
  TACTO_TRY(command(wire::StreamStart{rate_millihertz, block_frames}));
  stream_bytes_per_s_ = rate_hz * frame_bytes;
  return {};
}

Result<void> Client::command(const wire::Arm& arm) {
  const double rate_hz = 1e-3 * arm.rate_millihertz;
  const bool forces = arm.source == wire::DriveSource::scene && description_.axes;
  const std::size_t axes = forces ? description_.axes->count : 0;
  const auto tick_bytes = [&](double at_hz) { return bytes_per_tick(at_hz, axes); };
  TACTO_TRY(check_line({transport_->baud(), stream_bytes_per_s_}, rate_hz, tick_bytes, where_));
  TACTO_TRY(command<wire::Arm>(arm));
  tick_bytes_per_s_ = rate_hz * tick_bytes(rate_hz);
  return {};
}

Result<void> Client::stop_stream() {
  return command(wire::StreamStop{});
}

Result<void> Client::await_samples(std::size_t frames) {
  const auto enough = [&] { return samples_.frames() >= frames || samples_.has_gap(); };
  while (!enough()) {
    if (converter_failed_)
      return fail(ErrorKind::device, words_of(wire::FaultCode::converter, 0).what, where_,
                  words_of(wire::FaultCode::converter, 0).remedy);
    const std::uint64_t before = samples_.pushed();
    const auto came =
        await(kStallS, [&] { return samples_.pushed() > before || enough() || converter_failed_; });
    TACTO_TRY(came);
    if (!*came)
      return fail(ErrorKind::device, fmt::format("no frames were received for {:g} s", kStallS), where_,
                  "the device has stopped or restarted: check its supply and its cable");
  }
  return {};
}

Result<void> Client::receive(double timeout_s) {
  const auto got = transport_->read(received_, timeout_s);
  TACTO_TRY(got);
  keep_first(std::span(received_).first(*got));
  wire::Arrival arrival = wire::Arrival::frame;
  for (std::size_t at = 0; at < *got || arrival != wire::Arrival::nothing;) {
    wire::Frame frame;
    std::size_t used = 0;
    arrival = decoder_.take(received_.data() + at, *got - at, used, frame);
    at += used;
    if (arrival == wire::Arrival::frame) accept(frame);
  }
  return {};
}

void Client::keep_first(std::span<const std::uint8_t> bytes) {
  if (decoder_.counts().frames > 0) return;
  const std::size_t size = std::min(bytes.size(), kFirstBytes - first_.size());
  first_.insert(first_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
}

void Client::accept(const wire::Frame& frame) {
  const auto type = static_cast<MessageType>(frame.header.type);
  if (type == MessageType::samples) ++blocks_seen_;
  if (type == MessageType::welcome) return accept_welcome(frame);
  if (description_.welcome.major == 0 || frame.header.major != wire::kProtocolMajor) return;
  if (order_.check(frame.header.sequence) == wire::Order::stale) return;
  if (type == MessageType::samples) return accept_samples(frame);
  if (type == MessageType::answer) return accept_answer(frame);
  if (wire::Pulse pulse; type == MessageType::pulse && understood(frame, pulse)) pulse_ = pulse;
  if (wire::Channel channel; type == MessageType::channel && understood(frame, channel))
    if (channel.index == description_.channels.size()) description_.channels.push_back(channel);
  if (wire::Note note; type == MessageType::note && understood(frame, note))
    if (note.index == description_.notes.size()) description_.notes.push_back(note);
  if (wire::Ticks ticks; type == MessageType::ticks && understood(frame, ticks))
    if (ticks_.size() < kMostTicksKept) ticks_.push_back(ticks);
  if (wire::Axes axes; type == MessageType::axes && understood(frame, axes)) description_.axes = axes;
  if (wire::AxisTicks ticks; type == MessageType::axis_ticks && understood(frame, ticks))
    if (axis_ticks_.size() < kMostTicksKept) axis_ticks_.push_back(ticks);
  if (wire::Fault fault; type == MessageType::fault && understood(frame, fault)) {
    faults_.push_back(fault);
    converter_failed_ = converter_failed_ || fault.code == wire::FaultCode::converter;
  }
}

// The welcome of another version may be shorter: the fields that name the device are at the beginning.
void Client::accept_welcome(const wire::Frame& frame) {
  wire::Welcome welcome;
  const Parse parsed = wire::parse(frame.payload, frame.header.length, welcome);
  if (welcome.nonce != nonce_ || welcome.major == 0) return;
  if (parsed != Parse::ok && welcome.major == wire::kProtocolMajor) return;
  order_.expect_any();
  order_.check(frame.header.sequence);
  description_ = {welcome, {}, {}, {}};
}

void Client::accept_answer(const wire::Frame& frame) {
  wire::Answer answer;
  if (!understood(frame, answer)) return;
  if (answer.of == MessageType::drive) ++refused_drives_;
  if (answer.of != MessageType::drive) answer_ = answer;
}

void Client::accept_samples(const wire::Frame& frame) {
  if (!understood(frame, block_)) return;
  samples_.push(block_);
  const double clock_hz = std::max(1U, description_.welcome.clock_hz);
  last_arrival_ = FrameArrival{block_.first_frame, static_cast<double>(block_.device_ticks) / clock_hz,
                               transport_->now_s()};
}

LinkCounts Client::counts() const {
  return {decoder_.counts(), order_.lost(), order_.stale(), refused_drives_};
}

}  // namespace tacto::firmware_host
