// SPDX-License-Identifier: GPL-3.0-or-later
// The device in the page of `tactograph live`: firmware-host/core as a WebAssembly module. The page gives it
// frames and counts and receives drives, and a log of the wire: the accepted frames of the host and those of
// the device, in order, of which the server makes a session.
#include "firmware-host/core/firmware/firmware.hpp"
#include "playback/wasm/browser_board.hpp"

inline void* operator new(size_t, void* place) noexcept {
  return place;
}

namespace tacto::browser {
namespace {

constexpr size_t kInputBytes = 65536, kLogBytes = 65536;
constexpr uint32_t kBlockTicks = 1024;

// Steering commands, by the number that the page uses.
enum class Steering : uint32_t { arm, play, stop, disarm, gain, change };

struct Device {
  wire::Channel channel;
  uint8_t frame[wire::kMaxFrame] = {};  // from the host, to be received
  size_t frame_size = 0, frame_used = 0;
  uint32_t sequence = 0;
  wire::Answer answer;  // the last one
  uint32_t flags = 0;   // flags of ticks since the page asked
  bool logs = false;
  size_t logged = 0;
  bool touches = false;
  int32_t counts[wire::kMaxAxes] = {};  // a tray has one
  float drive_v = 0;
  float force_n[wire::kMaxAxes] = {};
  uint64_t clock = 0;
  uint32_t rate_hz = kRateHz;
  core::Firmware* firmware = nullptr;
};

constinit Device device;
constinit wire::Ticks last_ticks;
constinit wire::AxisTicks last_axis_ticks;
constinit wire::Axes axes;  // none: a tray
alignas(core::Firmware) uint8_t firmware_memory[sizeof(core::Firmware)];
alignas(16) float profile[kProfileSamples];
uint8_t input_bytes[kInputBytes];
uint8_t log_bytes[kLogBytes];
int32_t count_block[kBlockTicks * wire::kMaxAxes];
float drive_block[kBlockTicks * wire::kMaxAxes];

// Of the blocks: a tray's count and drive, or counts and forces of all axes.
uint32_t values_per_tick() noexcept {
  return axes.count > 0 ? axes.count : 1;
}

bool append_to_log(const uint8_t* bytes, size_t size) noexcept {
  if (size > kLogBytes - device.logged) return false;
  for (size_t i = 0; i < size; ++i) log_bytes[device.logged + i] = bytes[i];
  device.logged += size;
  return true;
}

// The firmware sends whole frames, because all of a frame is accepted or nothing.
size_t send(void*, const uint8_t* bytes, size_t size) noexcept {
  const auto type = static_cast<wire::MessageType>(bytes[3]);
  const uint8_t* const payload = bytes + wire::kHeaderSize;
  const size_t length = size - wire::kHeaderSize - wire::kCheckSize;
  if (type == wire::MessageType::answer) (void)wire::parse(payload, length, device.answer);
  if (type == wire::MessageType::ticks && wire::parse(payload, length, last_ticks) == wire::Parse::ok)
    for (uint8_t i = 0; i < last_ticks.count; ++i) device.flags |= last_ticks.ticks[i].flags;
  if (type == wire::MessageType::axis_ticks &&
      wire::parse(payload, length, last_axis_ticks) == wire::Parse::ok)
    for (uint8_t i = 0; i < last_axis_ticks.count; ++i) device.flags |= last_axis_ticks.ticks[i].flags;
  const bool data = type == wire::MessageType::ticks || type == wire::MessageType::axis_ticks ||
                    type == wire::MessageType::fault;
  if (device.logs && data && !append_to_log(bytes, size)) return 0;
  return size;
}

size_t receive(void*, uint8_t* bytes, size_t capacity) noexcept {
  size_t size = 0;
  while (size < capacity && device.frame_used < device.frame_size)
    bytes[size++] = device.frame[device.frame_used++];
  return size;
}

core::Hal hal() noexcept {
  core::Hal hal;
  hal.read_encoder = [](void*) noexcept { return device.counts[0]; };
  hal.encoder_unseen = [](void*) noexcept { return device.touches ? 0U : UINT32_MAX; };
  hal.read_channels = [](void*, int32_t* codes) noexcept {
    codes[0] = device.counts[0];
    return true;
  };
  hal.write_drive = [](void*, float drive_v) noexcept { device.drive_v = drive_v; };
  hal.read_axes = [](void*, int32_t* counts) noexcept {
    for (uint32_t i = 0; i < axes.count; ++i) counts[i] = device.counts[i];
  };
  hal.write_forces = [](void*, const float* force_n) noexcept {
    for (uint32_t i = 0; i < axes.count; ++i) device.force_n[i] = force_n[i];
  };
  hal.enable_closed = [](void*) noexcept { return true; };
  hal.clock = [](void*) noexcept { return device.clock; };
  hal.set_rate = [](void*, uint32_t) noexcept {};
  hal.receive = receive;
  hal.send = send;
  hal.restart = [](void*) noexcept {};
  return hal;
}

// Receives the frame in device.frame. True if it is accepted; then it is in the log, if it `logs`.
bool obey(size_t size, bool logs) noexcept {
  const wire::FrameHeader header{wire::kProtocolMajor, device.frame[3],
                                 static_cast<uint16_t>(size - wire::kHeaderSize - wire::kCheckSize),
                                 device.sequence++};
  device.frame_size = wire::seal_frame(header, device.frame);
  device.frame_used = 0;
  device.answer = {};
  device.answer.code = wire::AnswerCode::unknown_type;
  device.firmware->poll();
  const bool accepted = device.answer.code == wire::AnswerCode::ok;
  return accepted && (!logs || append_to_log(device.frame, device.frame_size));
}

template <class Message>
bool say(const Message& message) noexcept {
  return obey(wire::encode_frame(message, 0, device.frame, sizeof device.frame), device.logs);
}

bool steer(Steering steering, float value) noexcept {
  switch (steering) {
    case Steering::arm:
      return say(wire::Arm{axes.count > 0 ? wire::DriveSource::scene : wire::DriveSource::profile,
                           1000 * device.rate_hz});
    case Steering::play:
      return say(wire::Play{});
    case Steering::stop:
      return say(wire::Stop{});
    case Steering::disarm:
      return say(wire::Disarm{});
    case Steering::gain:
      return say(wire::Gain{value});
    case Steering::change:
      return say(wire::Change{value});
  }
  return false;
}

}  // namespace

extern "C" {

/// Starts as after power-on. Call it first. If the first `size` bytes of the input are a frame of axes, it is
/// a force device with these axes and rate; with a size of 0 a tray, at kRateHz. False for other bytes.
[[clang::export_name("begin")]] bool begin(uint32_t size, uint32_t rate_hz) {
  device = {};
  axes = {};
  wire::FrameHeader header;
  if (size > 0 &&
      (size > kInputBytes || !wire::read_header(input_bytes, header) ||
       header.type != static_cast<uint8_t>(wire::MessageType::axes) ||
       size != wire::kHeaderSize + header.length + wire::kCheckSize ||
       wire::parse(input_bytes + wire::kHeaderSize, header.length, axes) != wire::Parse::ok || rate_hz == 0))
    return false;
  if (size > 0) device.rate_hz = rate_hz;
  device.channel = encoder_channel();
  const core::Board own = board(device.channel, profile, size > 0 ? &axes : nullptr, device.rate_hz);
  device.firmware = new (firmware_memory) core::Firmware(own, hal());
  say(wire::Hello{});
  return true;
}

[[clang::export_name("input")]] uint8_t* input() {
  return input_bytes;
}
[[clang::export_name("input_size")]] uint32_t input_size() {
  return kInputBytes;
}
[[clang::export_name("counts")]] int32_t* counts() {
  return count_block;
}
[[clang::export_name("drives")]] float* drives() {
  return drive_block;
}
[[clang::export_name("block_ticks")]] uint32_t block_ticks() {
  return kBlockTicks;
}

/// Gives the whole frames in the first `size` bytes of the input to the device: a texture or a scene, or
/// while it plays the next texture. They are not in the log, because the server has made them. Returns the
/// bytes of the frames that it accepted: fewer than `size` if one was refused or the last one is not whole.
[[clang::export_name("upload")]] uint32_t upload(uint32_t size) {
  if (device.firmware->drive_state() == wire::DriveState::idle) device.logs = false;
  uint32_t used = 0;
  wire::FrameHeader header;
  while (size - used >= wire::kHeaderSize && wire::read_header(input_bytes + used, header)) {
    const uint32_t whole = wire::kHeaderSize + header.length + wire::kCheckSize;
    if (header.length > wire::kMaxPayload || whole > size - used) break;
    for (uint32_t i = 0; i < whole; ++i) device.frame[i] = input_bytes[used + i];
    if (!obey(whole, false)) break;
    used += whole;
  }
  return used;
}

/// Arms, plays, stops, disarms, sets the gain (m/N), or changes to the next texture (seconds of the fade).
/// From arming on there is a log. True if accepted.
[[clang::export_name("steer")]] bool steer(uint32_t steering, float value) {
  device.logs = true;
  return steer(static_cast<Steering>(steering), value);
}

/// Sets a number of a layer of the scene that plays (wire::Set); its ramp in seconds. True if accepted.
[[clang::export_name("set")]] bool set(uint32_t layer, uint32_t number, float value, float ramp_s) {
  return say(wire::Set{static_cast<uint16_t>(layer), static_cast<uint16_t>(number), value, ramp_s});
}
/// That number as the last tick used it. Only after arming a scene that has it.
[[clang::export_name("number")]] float number(uint32_t layer, uint32_t number) {
  return device.firmware->scene().number(layer, number);
}
/// The ghost's place along x, y or z (0 to 2), in m. Only after arming a scene of pieces.
[[clang::export_name("ghost")]] float ghost(uint32_t along) {
  return device.firmware->scene().ghost_m(along);
}

/// Of a tray: whether the finger touches. Otherwise the encoder is not read: after 10 ms the drive falls, and
/// at rest the next count is used, however far away it is.
[[clang::export_name("touch")]] void touch(bool touches) {
  device.touches = touches;
}

/// Ticks at the first `ticks` counts; the drives are in drives(). Of a force device: at the counts of all its
/// axes for each tick, and drives() has their forces. The host is alive as long as it calls this.
[[clang::export_name("run")]] void run(uint32_t ticks) {
  device.frame_size =
      wire::encode_frame(wire::Heartbeat{}, device.sequence++, device.frame, sizeof device.frame);
  device.frame_used = 0;
  const uint32_t width = values_per_tick();
  for (uint32_t i = 0; i < ticks && i < kBlockTicks; ++i) {
    for (uint32_t k = 0; k < width; ++k) device.counts[k] = count_block[i * width + k];
    device.clock += kClocksPerTick;
    device.firmware->poll();
    device.firmware->tick();
    for (uint32_t k = 0; k < width; ++k)
      drive_block[i * width + k] = axes.count > 0 ? device.force_n[k] : device.drive_v;
  }
  device.firmware->poll();
}

[[clang::export_name("log")]] uint8_t* log() {
  return log_bytes;
}
/// Its bytes since the last call.
[[clang::export_name("take_log")]] uint32_t take_log() {
  const size_t logged = device.logged;
  device.logged = 0;
  return static_cast<uint32_t>(logged);
}

/// All flags (wire::TickFlag) of the ticks that were sent since the last call.
[[clang::export_name("take_flags")]] uint32_t take_flags() {
  const uint32_t flags = device.flags;
  device.flags = 0;
  return flags;
}

/// wire::DriveState, wire::FaultCode, and the fault's detail.
[[clang::export_name("state")]] uint32_t state() {
  return static_cast<uint32_t>(device.firmware->drive_state());
}
[[clang::export_name("fault")]] uint32_t fault() {
  return static_cast<uint32_t>(device.firmware->supervisor().fault());
}
[[clang::export_name("fault_detail")]] uint32_t fault_detail() {
  return device.firmware->supervisor().fault_detail();
}

}  // extern "C"

}  // namespace tacto::browser
