// SPDX-License-Identifier: GPL-3.0-or-later
// The host's side of the wire: greets a device, sends commands, and receives its streams, over any transport.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "data-schema/recording/recording.hpp"
#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"
#include "firmware-host/core/wire/host_messages.hpp"
#include "firmware-host/core/wire/sequence_check.hpp"
#include "firmware-host/link/transport.hpp"

namespace tacto::firmware_host {

// A queue of frames between the wire and the reader, in order, with gaps.

/// The device numbers the frames: a missing number is a gap, a repeated one is dropped. Memory: the frames
/// that have not been read.
class SampleQueue {
 public:
  void begin(std::size_t channels);
  void push(const wire::Samples& samples);

  /// Whole frames before the next gap.
  std::size_t frames() const;
  bool has_gap() const { return !gaps_.empty(); }
  bool at_gap() const { return !gaps_.empty() && gaps_.front().frame == taken_; }
  /// The gap before the next frame: `frame` is the number of frames read before it. Precondition: at_gap().
  schema::Gap take_gap();
  /// Fills whole frames, at most frames(); returns their number.
  std::size_t take(std::span<std::int32_t> interleaved);
  std::uint64_t pushed() const { return pushed_; }
  std::uint64_t lost() const { return lost_; }

 private:
  void note_gap(std::uint64_t first_frame);
  void compact();

  std::size_t channels_ = 1;
  std::vector<std::int32_t> codes_;
  std::size_t used_ = 0;  // of codes_
  std::deque<schema::Gap> gaps_;
  std::uint64_t taken_ = 0, pushed_ = 0;  // frames
  std::uint64_t next_frame_ = 0, lost_ = 0;
};

/// The description that a device sends after hello.
struct Description {
  wire::Welcome welcome;
  std::vector<wire::Channel> channels;
  std::vector<wire::Note> notes;
  std::optional<wire::Axes> axes = std::nullopt;  ///< of a device with forces
};

/// The time at which a frame was sampled, and the time at which its message arrived.
struct FrameArrival {
  std::uint64_t frame = 0;  ///< the device's number
  double device_s = 0, host_s = 0;
};

/// Messages from the device that were damaged, repeated or missing.
struct LinkCounts {
  wire::DecoderCounts frames;
  std::uint32_t lost = 0, stale = 0;
  std::uint32_t refused_drives = 0;
};

/// One connection. Every call ends within its timeouts, for any behaviour of the device. For one thread.
class Client {
 public:
  /// Sends hello and waits for the description, with the repetitions of command(). Errors: device: no answer,
  /// or an invalid one, or bytes of another program; unsupported_version: a device with an unsupported major
  /// version, which is named.
  static schema::Result<std::unique_ptr<Client>> connect(std::unique_ptr<Transport> transport,
                                                         std::string where);

  const Description& description() const { return description_; }
  Transport& transport() { return *transport_; }
  const std::string& where() const { return where_; }

  /// Sends a command and waits for its answer. Without an answer it is sent again: three times in 1.5 s, and
  /// up to 10 s while the device is still sending frames that it had queued. Errors: device: no answer, gone,
  /// or refused, with the reason.
  template <class Message>
  schema::Result<void> command(const Message& message) {
    return exchange(
        [&](std::uint32_t sequence, std::span<std::uint8_t> frame) {
          return wire::encode_frame(message, sequence, frame.data(), frame.size());
        },
        Message::kType);
  }
  /// As the other commands. Errors, besides: unsuitable: ticks at this rate do not fit on the serial line.
  schema::Result<void> command(const wire::Arm& arm);
  /// From now on `on_done` is called after each successful command, with the frame that was sent.
  void listen(std::function<void(std::span<const std::uint8_t> frame)> on_done) {
    on_command_done_ = std::move(on_done);
  }
  /// Sends drive without waiting for an answer. Errors: device: gone.
  schema::Result<void> send_drive(const wire::Drive& drive);
  /// Resets the watchdog; returns the device's state. Errors: as command().
  schema::Result<wire::Pulse> heartbeat();

  /// Frames begin at 0. Errors: as command(); unsuitable: the frames do not fit on the serial line.
  schema::Result<void> start_stream(std::uint32_t rate_millihertz, std::uint8_t block_frames);
  schema::Result<void> stop_stream();
  /// Waits until `frames` are in the queue, or a gap is reached. Errors: device: gone, silent for a second,
  /// or its converter failed; the frames before the error are in the queue.
  schema::Result<void> await_samples(std::size_t frames);
  SampleQueue& samples() { return samples_; }

  /// Processes the bytes that have arrived; waits at most `timeout_s` for them.
  schema::Result<void> receive(double timeout_s);
  std::vector<wire::Fault> take_faults() { return std::exchange(faults_, {}); }
  std::vector<wire::Ticks> take_ticks() { return std::exchange(ticks_, {}); }
  std::vector<wire::AxisTicks> take_axis_ticks() { return std::exchange(axis_ticks_, {}); }
  /// Of the last samples message.
  const std::optional<FrameArrival>& last_arrival() const { return last_arrival_; }
  LinkCounts counts() const;

 private:
  struct Asking {
    double since_s = 0;
    std::uint64_t blocks_seen = 0;  // at the previous attempt
    double at_least_s = 0;
    int times = 0;
  };
  using Encoder = std::function<std::size_t(std::uint32_t sequence, std::span<std::uint8_t> frame)>;
  Client(std::unique_ptr<Transport> transport, std::string where);
  schema::Result<void> greet();
  schema::Result<void> flush();
  schema::Result<bool> greet_once();
  void accept_answer(const wire::Frame& frame);
  schema::Result<void> check_version() const;
  bool described() const;
  schema::Result<void> exchange(const Encoder& encode, wire::MessageType type);
  schema::Result<std::uint32_t> send(const Encoder& encode);
  template <class Done>
  schema::Result<bool> await(double timeout_s, Done done);
  void accept(const wire::Frame& frame);
  void accept_welcome(const wire::Frame& frame);
  void accept_samples(const wire::Frame& frame);
  tl::unexpected<schema::Error> refused(wire::MessageType type, const wire::Answer& answer) const;
  bool may_retry(Asking& asking) const;
  tl::unexpected<schema::Error> silent(wire::MessageType type, const Asking& asking) const;
  void keep_first(std::span<const std::uint8_t> bytes);

  std::unique_ptr<Transport> transport_;
  std::string where_;
  Description description_;
  wire::FrameDecoder decoder_;
  wire::SequenceCheck order_;
  std::uint32_t sequence_ = 0;
  std::uint32_t nonce_ = 0;
  std::optional<wire::Answer> answer_;
  std::optional<wire::Pulse> pulse_;
  wire::Samples block_;
  SampleQueue samples_;
  std::optional<FrameArrival> last_arrival_;
  std::vector<wire::Fault> faults_;
  std::vector<wire::Ticks> ticks_;
  std::vector<wire::AxisTicks> axis_ticks_;
  bool converter_failed_ = false;
  std::uint32_t refused_drives_ = 0;
  std::vector<std::uint8_t> received_;
  std::vector<std::uint8_t> first_;  // received bytes, until a frame of the wire was received
  double stream_bytes_per_s_ = 0, tick_bytes_per_s_ = 0;
  std::uint64_t blocks_seen_ = 0;   // messages of samples, also of an earlier program's stream
  std::vector<std::uint8_t> sent_;  // the last frame
  std::function<void(std::span<const std::uint8_t>)> on_command_done_;
};

}  // namespace tacto::firmware_host
