// SPDX-License-Identifier: Apache-2.0
// The device: commands in, frames out. The same source on a board, in a gadget and in the emulated device.
#pragma once

#include "firmware-host/core/firmware/board.hpp"
#include "firmware-host/core/firmware/profile_upload.hpp"
#include "firmware-host/core/firmware/ticker.hpp"
#include "firmware-host/core/scene/scene_block.hpp"
#include "firmware-host/core/wire/device_messages.hpp"
#include "firmware-host/core/wire/frame_decoder.hpp"
#include "firmware-host/core/wire/sequence_check.hpp"

namespace tacto::core {

// Collects records into messages without gaps.

/// Frames of one samples message. For the main loop.
class SampleBlock {
 public:
  void begin(uint8_t channels, uint8_t frames) noexcept;
  bool fits(const Record& record) const noexcept;
  void add(const Record& record) noexcept;
  bool full() const noexcept { return block_.count >= frames_; }
  bool empty() const noexcept { return block_.count == 0; }
  void clear() noexcept { block_.count = 0; }
  const wire::Samples& message() const noexcept { return block_; }

 private:
  wire::Samples block_;
  uint8_t frames_ = 1;
};

/// Ticks of one ticks message. For the main loop.
class TickBlock {
 public:
  void begin(uint8_t ticks) noexcept { limit_ = ticks, block_.count = 0; }
  bool fits(const Record& record) const noexcept;
  void add(const Record& record) noexcept;
  bool full() const noexcept { return block_.count >= limit_; }
  bool empty() const noexcept { return block_.count == 0; }
  void clear() noexcept { block_.count = 0; }
  const wire::Ticks& message() const noexcept { return block_; }

 private:
  wire::Ticks block_;
  uint8_t limit_ = 1;
};

/// Ticks of one axis_ticks message. For the main loop.
class AxisTickBlock {
 public:
  void begin(uint8_t ticks, uint8_t axes) noexcept { limit_ = ticks, block_.axes = axes, block_.count = 0; }
  bool fits(const Record& record) const noexcept;
  void add(const Record& record) noexcept;
  bool full() const noexcept { return block_.count >= limit_; }
  bool empty() const noexcept { return block_.count == 0; }
  void clear() noexcept { block_.count = 0; }
  const wire::AxisTicks& message() const noexcept { return block_; }

 private:
  wire::AxisTicks block_;
  uint8_t limit_ = 1;
};

// Receives a scene part by part.

/// Stores the block in memory of the board, followed by the memory for what changes while it plays. Parts
/// come in order; a repeated part is written again. Only a block that read_scene_block() accepts can be
/// armed. For the main loop.
class SceneUpload {
 public:
  /// `memory` holds `words` numbers of 4 bytes.
  SceneUpload(float* memory, uint32_t words) noexcept : memory_(memory), words_(words) {}

  uint32_t most_bytes() const noexcept { return (words_ - live_words()) * 4; }
  Reply part(const wire::ScenePart& message) noexcept;
  void forget() noexcept { here_ = 0, complete_ = false; }

  bool complete() const noexcept { return complete_; }
  uint32_t here() const noexcept { return here_; }
  const SceneView& view() const noexcept { return view_; }
  float* live() const noexcept {
    return memory_ + (words_ - (view_.live_words() > live_words() ? view_.live_words() : live_words()));
  }

 private:
  // SceneView::live_words() of the largest scene whose tables do not change; in a small memory a block of
  // half of it cannot need more.
  uint32_t live_words() const noexcept {
    constexpr uint32_t kMost =
        kMostSceneLayers * (kMostLayerNumbers + kPatchWords) + kMostSceneBodies * (kBodyStateWords + 1);
    return words_ / 2 < kMost ? words_ / 2 : kMost;
  }

  float* memory_;
  uint32_t words_;
  uint32_t bytes_ = 0, here_ = 0;
  bool complete_ = false;
  SceneView view_;
};

/// Starts with no output and no stream. Call tick() in the timer's interrupt, and poll() in the main loop as
/// often as possible: tick() may interrupt poll() anywhere, poll() never runs within a tick (one core; a host
/// calls both from one thread). 58 KB without the profile's memory, which the board provides. No heap, no
/// locks, no libm.
class Firmware {
 public:
  /// Precondition: the board's channels and rates satisfy the conditions in Board.
  Firmware(const Board& board, const Hal& hal) noexcept;

  void tick() noexcept { ticker_.tick(); }
  /// Handles the received bytes and sends the frames that are ready, as far as the link accepts them. Never
  /// waits.
  void poll() noexcept;

  wire::DriveState drive_state() const noexcept { return ticker_.supervisor().state(); }
  const DriveSupervisor& supervisor() const noexcept { return ticker_.supervisor(); }
  /// Of a force device, once a scene was armed.
  const SceneKernel& scene() const noexcept { return ticker_.scene(); }

 private:
  enum class Owed : uint8_t { nothing, answer, answer_after_data, pulse };

  // Sending (firmware_sending.cpp).
  bool flush() noexcept;
  bool compose() noexcept;
  bool compose_prompt() noexcept;
  bool compose_owed() noexcept;
  bool compose_description() noexcept;
  uint16_t messages_of_description() const noexcept;
  bool compose_fault() noexcept;
  bool compose_data() noexcept;
  bool compose_full_blocks() noexcept;
  bool gather() noexcept;
  bool streams_data() noexcept;
  wire::Pulse pulse() noexcept;
  template <class Message>
  bool put(const Message& message) noexcept;
  template <class Block>
  bool put_block(Block& block) noexcept;

  // Receiving (firmware.cpp).
  bool receive() noexcept;
  void accept(const wire::Frame& frame) noexcept;
  void rest_if_unused() noexcept;

  // Commands (firmware_commands.cpp).
  void greet(const wire::Frame& frame) noexcept;
  void obey(const wire::Frame& frame) noexcept;
  Reply reply_to(const wire::Frame& frame) noexcept;
  Reply reply_to_setup(const wire::Frame& frame) noexcept;
  Reply reply_to_texture(const wire::Frame& frame) noexcept;
  Reply reply_to_scene(const wire::Frame& frame) noexcept;
  template <class Message>
  Reply with(const wire::Frame& frame, Message& message, Reply (Firmware::*command)(const Message&)) noexcept;
  template <class Message>
  Reply in_idle(const wire::Frame& frame, Message& message,
                Reply (Firmware::*command)(const Message&)) noexcept;
  template <class Message>
  Reply to_profile(const wire::Frame& frame, Message& message,
                   Reply (Firmware::*command)(const Message&)) noexcept;
  Reply stream_start(const wire::StreamStart& message) noexcept;
  Reply stream_stop() noexcept;
  Reply limits(const wire::Limits& message) noexcept;
  Reply profile_begin(const wire::ProfileBegin& message) noexcept;
  Reply next_profile_begin(const wire::ProfileBegin& message) noexcept;
  Reply profile_levels(const wire::ProfileLevels& message) noexcept { return building().levels(message); }
  Reply profile_chunk(const wire::ProfileChunk& message) noexcept { return building().chunk(message); }
  Reply profile_end(const wire::ProfileEnd& message) noexcept { return building().end(message); }
  Reply filters(const wire::Filters& message) noexcept;
  Reply taps(const wire::Taps& message) noexcept;
  Reply hysteresis(const wire::Hysteresis& message) noexcept;
  Reply tracking(const wire::Tracking& message) noexcept;
  Reply energy(const wire::Energy& message) noexcept;
  Reply contact(const wire::Contact& message) noexcept;
  Reply change(const wire::Change& message) noexcept;
  TextureSetup texture_setup() const noexcept;
  KernelSetup kernel_setup(const wire::Arm& message) const noexcept;
  Reply gain(const wire::Gain& message) noexcept;
  Reply force_limits(const wire::ForceLimits& message) noexcept;
  Reply scene_part(const wire::ScenePart& message) noexcept;
  Reply set(const wire::Set& message) noexcept;
  Reply move(const wire::Move& message) noexcept;
  Reply raise(const wire::Raise& message) noexcept;
  bool plays_scene() const noexcept { return runs() && ticker_.source() == wire::DriveSource::scene; }
  Reply ready_scene() noexcept;
  SceneArm scene_arm(const wire::Arm& message) const noexcept;
  Reply sweep(const wire::Sweep& message) noexcept;
  Reply arm(const wire::Arm& message) noexcept;
  Reply ready(const wire::Arm& message) noexcept;
  Reply play() noexcept;
  Reply stop() noexcept;
  Reply disarm() noexcept;
  Reply reset() noexcept;
  Reply drive(const wire::Drive& message) noexcept;
  Reply take_rate(uint32_t rate_millihertz) noexcept;
  Reply wrong_state() const noexcept;
  bool idle() const noexcept { return drive_state() == wire::DriveState::idle; }
  /// Armed or playing, and not being disarmed: the state is not idle before the main loop sets it.
  bool runs() const noexcept;
  bool plays_profile() const noexcept;
  ProfileUpload& building() noexcept { return idle() ? upload_ : next_; }

  Board board_;
  Hal hal_;
  Ticker ticker_;
  SceneUpload scene_;            // in the memory of the profile
  ProfileUpload upload_, next_;  // next: uploaded while the other one plays
  wire::FrameDecoder decoder_;
  wire::SequenceCheck order_;
  wire::Limits limits_;
  wire::ForceLimits force_limits_;
  wire::ScenePart scene_part_;  // a member for small stacks, as chunk_
  wire::Filters filters_;
  wire::Taps taps_, new_taps_;
  wire::Hysteresis hysteresis_, new_hysteresis_;
  wire::Tracking tracking_, next_tracking_;
  wire::Energy energy_;
  wire::Contact contact_;
  wire::Sweep sweep_;
  wire::ProfileChunk chunk_;  // members, not locals: small cores have small stacks
  wire::Drive drive_;
  SampleBlock samples_;
  TickBlock ticks_;
  AxisTickBlock axis_ticks_;
  wire::Answer answer_;
  uint32_t nonce_ = 0, token_ = 0;
  uint32_t rate_millihertz_ = 0;  // 0: not ticking
  uint32_t sequence_ = 0;
  uint16_t described_ = 0;  // number of welcome, channels, notes sent; all of them: complete
  uint8_t run_ = 0;
  Owed owed_ = Owed::nothing;
  bool greeted_ = false, limited_ = false, force_limited_ = false;
  bool changed_ = false;  // by a command, and no next profile has begun since
  wire::FaultCode reported_ = wire::FaultCode::none, stream_fault_ = wire::FaultCode::none;
  uint8_t received_[512];
  size_t received_size_ = 0, received_used_ = 0;
  uint8_t sending_[wire::kMaxFrame];
  size_t sending_size_ = 0, sent_ = 0;
};

}  // namespace tacto::core
