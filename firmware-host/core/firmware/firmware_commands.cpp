// SPDX-License-Identifier: Apache-2.0
// The effect of each command, and when it is refused.
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/kernel/finite.hpp"

namespace tacto::core {
namespace {

using wire::AnswerCode;
using wire::DriveSource;
using wire::DriveState;
using wire::MessageType;

constexpr uint16_t kLeastWatchdogMs = 10, kMostWatchdogMs = 1000;
constexpr uint32_t kTickBlockPart = 100000;  // mHz: a ticks message every 10 ms
constexpr uint32_t kNotGreeted = 255;

uint8_t ticks_in_block(uint32_t rate_millihertz) noexcept {
  const uint32_t ticks = rate_millihertz / kTickBlockPart;
  return static_cast<uint8_t>(ticks < 1 ? 1 : ticks > wire::kMaxBlockTicks ? wire::kMaxBlockTicks : ticks);
}

}  // namespace

void Firmware::greet(const wire::Frame& frame) noexcept {
  wire::Hello hello;
  if (wire::parse(frame.payload, frame.header.length, hello) != wire::Parse::ok) return;
  ticker_.stop_stream();
  ticker_.supervisor().aim(Aim::off);
  ticker_.supervisor().heard();
  ticker_.forget_counts();
  ticker_.records().clear();
  samples_.clear();
  ticks_.clear();
  axis_ticks_.clear();
  greeted_ = hello.major == wire::kProtocolMajor;
  nonce_ = hello.nonce;
  sequence_ = 0;
  described_ = 0;
}

void Firmware::obey(const wire::Frame& frame) noexcept {
  Reply reply = reply_to(frame);
  const auto type = static_cast<MessageType>(frame.header.type);
  if (type == MessageType::drive && reply.code == AnswerCode::ok) return;
  if (type == MessageType::heartbeat && reply.code == AnswerCode::ok) {
    owed_ = Owed::pulse;
    return;
  }
  answer_ = {type, reply.code, 0, frame.header.sequence, reply.detail};
  owed_ = type == MessageType::stream_stop ? Owed::answer_after_data : Owed::answer;
}

template <class Message>
Reply Firmware::with(const wire::Frame& frame, Message& message,
                     Reply (Firmware::*command)(const Message&)) noexcept {
  const wire::Parse parsed = wire::parse(frame.payload, frame.header.length, message);
  if (parsed != wire::Parse::ok) return {AnswerCode::bad_payload, frame.header.length};
  return (this->*command)(message);
}

template <class Message>
Reply Firmware::in_idle(const wire::Frame& frame, Message& message,
                        Reply (Firmware::*command)(const Message&)) noexcept {
  if (!idle()) return wrong_state();
  return with(frame, message, command);
}

// Commands that make a profile: in idle the one to arm, during playback the next one.
template <class Message>
Reply Firmware::to_profile(const wire::Frame& frame, Message& message,
                           Reply (Firmware::*command)(const Message&)) noexcept {
  if (!idle() && !plays_profile()) return wrong_state();
  return with(frame, message, command);
}

Reply Firmware::wrong_state() const noexcept {
  return {AnswerCode::wrong_state, static_cast<uint32_t>(drive_state())};
}

bool Firmware::runs() const noexcept {
  const DriveState state = drive_state();
  return (state == DriveState::armed || state == DriveState::playing) &&
         ticker_.supervisor().aim() != Aim::off;
}

bool Firmware::plays_profile() const noexcept {
  return runs() && ticker_.source() == DriveSource::profile;
}

Reply Firmware::reply_to(const wire::Frame& frame) noexcept {
  if (frame.header.major != wire::kProtocolMajor) return {AnswerCode::wrong_version, wire::kProtocolMajor};
  if (!greeted_) return {AnswerCode::wrong_state, kNotGreeted};
  wire::StreamStart start;
  wire::Gain new_gain;
  wire::Heartbeat beat;
  switch (static_cast<MessageType>(frame.header.type)) {
    case MessageType::stream_start:
      return with(frame, start, &Firmware::stream_start);
    case MessageType::stream_stop:
      return stream_stop();
    case MessageType::gain:
      return with(frame, new_gain, &Firmware::gain);
    case MessageType::play:
      return play();
    case MessageType::stop:
      return stop();
    case MessageType::disarm:
      return disarm();
    case MessageType::drive:
      return with(frame, drive_, &Firmware::drive);
    case MessageType::heartbeat:
      if (wire::parse(frame.payload, frame.header.length, beat) != wire::Parse::ok) break;
      token_ = beat.token;
      return {};
    case MessageType::reset:
      return reset();
    default:
      return reply_to_setup(frame);
  }
  return {AnswerCode::bad_payload, frame.header.length};
}

// Commands that are refused while a drive runs.
Reply Firmware::reply_to_setup(const wire::Frame& frame) noexcept {
  wire::Limits new_limits;
  wire::Filters new_filters;
  wire::Energy new_energy;
  wire::Contact new_contact;
  wire::Sweep new_sweep;
  wire::Arm new_arm;
  switch (static_cast<MessageType>(frame.header.type)) {
    case MessageType::limits:
      return in_idle(frame, new_limits, &Firmware::limits);
    case MessageType::filters:
      return in_idle(frame, new_filters, &Firmware::filters);
    case MessageType::taps:
      return in_idle(frame, new_taps_, &Firmware::taps);
    case MessageType::hysteresis:
      return in_idle(frame, new_hysteresis_, &Firmware::hysteresis);
    case MessageType::energy:
      return in_idle(frame, new_energy, &Firmware::energy);
    case MessageType::contact:
      return in_idle(frame, new_contact, &Firmware::contact);
    case MessageType::sweep:
      return in_idle(frame, new_sweep, &Firmware::sweep);
    case MessageType::arm:
      return in_idle(frame, new_arm, &Firmware::arm);
    default:
      return reply_to_texture(frame);
  }
}

// Commands that make a texture; during playback they make the next one.
Reply Firmware::reply_to_texture(const wire::Frame& frame) noexcept {
  wire::ProfileBegin begin;
  wire::ProfileLevels new_levels;
  wire::ProfileEnd end;
  wire::Tracking new_tracking;
  wire::Change new_change;
  switch (static_cast<MessageType>(frame.header.type)) {
    case MessageType::profile_begin:
      return to_profile(frame, begin, &Firmware::profile_begin);
    case MessageType::profile_levels:
      return to_profile(frame, new_levels, &Firmware::profile_levels);
    case MessageType::profile_chunk:
      return to_profile(frame, chunk_, &Firmware::profile_chunk);
    case MessageType::profile_end:
      return to_profile(frame, end, &Firmware::profile_end);
    case MessageType::tracking:
      return to_profile(frame, new_tracking, &Firmware::tracking);
    case MessageType::change:
      return with(frame, new_change, &Firmware::change);
    default:
      return reply_to_scene(frame);
  }
}

Reply Firmware::reply_to_scene(const wire::Frame& frame) noexcept {
  wire::ForceLimits new_limits;
  wire::Set new_set;
  wire::Move new_move;
  wire::Raise new_raise;
  const auto type = static_cast<MessageType>(frame.header.type);
  if (board_.axes == nullptr) return {AnswerCode::unknown_type, frame.header.type};
  switch (type) {
    case MessageType::force_limits:
      return in_idle(frame, new_limits, &Firmware::force_limits);
    case MessageType::scene_part:
      return in_idle(frame, scene_part_, &Firmware::scene_part);
    case MessageType::set:
      return with(frame, new_set, &Firmware::set);
    case MessageType::move:
      return with(frame, new_move, &Firmware::move);
    case MessageType::raise:
      return with(frame, new_raise, &Firmware::raise);
    default:
      return {AnswerCode::unknown_type, frame.header.type};
  }
}

Reply Firmware::force_limits(const wire::ForceLimits& asked) noexcept {
  const wire::Axes& own = *board_.axes;
  for (uint8_t i = 0; i < own.count; ++i) {
    if (!(asked.axis_peak_n[i] > 0 && asked.axis_peak_n[i] <= own.axes[i].peak_n)) return bad_value(0);
    if (!(asked.axis_continuous_n[i] > 0 && asked.axis_continuous_n[i] <= own.axes[i].continuous_n))
      return bad_value(1);
  }
  if (!(asked.peak_n > 0 && asked.peak_n <= own.peak_n)) return bad_value(2);
  if (!(asked.continuous_n > 0 && asked.continuous_n <= own.continuous_n)) return bad_value(3);
  if (!(asked.slew_n_per_s > 0 && asked.slew_n_per_s <= own.slew_n_per_s)) return bad_value(4);
  if (!within(asked.onset_s, 0, kLongestOnsetS)) return bad_value(5);
  if (!(asked.release_s >= 0 && asked.release_s + asked.peak_n / asked.slew_n_per_s <= kLongestReleaseS))
    return bad_value(6);
  if (asked.watchdog_ms < kLeastWatchdogMs || asked.watchdog_ms > kMostWatchdogMs) return bad_value(7);
  if (asked.counts_per_tick < 1) return bad_value(9);
  force_limits_ = asked;
  force_limited_ = true;
  return {};
}

// Scene and profile use the same memory.
Reply Firmware::scene_part(const wire::ScenePart& message) noexcept {
  upload_.forget();
  return scene_.part(message);
}

Reply Firmware::set(const wire::Set& message) noexcept {
  if (!plays_scene()) return wrong_state();
  if (!number_fits(scene_.view(), message.layer, message.number, message.value)) return bad_value(2);
  if (!within(message.ramp_s, 0, kLongestFadeS)) return bad_value(3);
  return ticker_.steer({MessageType::set, message, {}, {}}) ? Reply{} : Reply{AnswerCode::too_large, 0};
}

Reply Firmware::move(const wire::Move& message) noexcept {
  if (!plays_scene()) return wrong_state();
  if (message.patch >= scene_.view().patch_count) return bad_value(0);
  if (message.x_counts < -kFarthestMove || message.x_counts > kFarthestMove) return bad_value(2);
  if (message.y_counts < -kFarthestMove || message.y_counts > kFarthestMove) return bad_value(3);
  if (!within(message.ramp_s, 0, kLongestFadeS)) return bad_value(4);
  return ticker_.steer({MessageType::move, {}, message, {}}) ? Reply{} : Reply{AnswerCode::too_large, 0};
}

Reply Firmware::raise(const wire::Raise& message) noexcept {
  if (!plays_scene()) return wrong_state();
  if (message.patch >= scene_.view().patch_count) return bad_value(0);
  return ticker_.steer({MessageType::raise, {}, {}, message}) ? Reply{} : Reply{AnswerCode::too_large, 0};
}

Reply Firmware::ready_scene() noexcept {
  if (board_.axes == nullptr) return bad_value(0);
  if (!force_limited_) return {AnswerCode::no_limits, 0};
  if (!hal_.enable_closed(hal_.board)) return {AnswerCode::enable_open, 0};
  return scene_.complete() ? Reply{} : Reply{AnswerCode::incomplete, scene_.here()};
}

SceneArm Firmware::scene_arm(const wire::Arm& message) const noexcept {
  const wire::Axes& own = *board_.axes;
  SceneArm arm;
  arm.scene = scene_.view();
  arm.live = scene_.live();
  ForceSetup& setup = arm.setup;
  setup.axis_count = own.count;
  for (uint8_t i = 0; i < own.count; ++i)
    setup.axes[i] = {own.axes[i].along, own.axes[i].metres_per_count, force_limits_.axis_peak_n[i],
                     force_limits_.axis_continuous_n[i]};
  setup.peak_n = force_limits_.peak_n;
  setup.continuous_n = force_limits_.continuous_n;
  setup.slew_n_per_s = force_limits_.slew_n_per_s;
  setup.rate_hz = rate_of(message.rate_millihertz);
  setup.onset_s = force_limits_.onset_s;
  setup.release_s = force_limits_.release_s;
  arm.limits.watchdog_ms = force_limits_.watchdog_ms;
  arm.counts_per_tick = force_limits_.counts_per_tick;
  return arm;
}

// A host need not send the other settings: a new profile starts without them.
Reply Firmware::profile_begin(const wire::ProfileBegin& message) noexcept {
  if (!idle()) return next_profile_begin(message);
  scene_.forget();
  taps_.count = 0;
  hysteresis_ = {};
  tracking_ = {};
  energy_ = {};
  contact_ = {};
  return upload_.begin(message);
}

// Never overwrites samples that are read: neither those of the playing profile nor of one that still fades
// out.
Reply Firmware::next_profile_begin(const wire::ProfileBegin& message) noexcept {
  if (ticker_.fading()) return wrong_state();
  changed_ = false;
  next_tracking_ = tracking_;
  next_tracking_.full_detail_counts_per_tick = 0;
  return next_.begin_beside(upload_, message);
}

// One clock for sampling and driving: a second user has to use the current rate.
Reply Firmware::take_rate(uint32_t rate) noexcept {
  const wire::Welcome& about = board_.about;
  if (rate < about.least_rate_millihertz || rate > about.most_rate_millihertz) return bad_value(0);
  const bool shared = ticker_.streaming() || !idle();
  if (shared && rate == rate_millihertz_) return {};
  if (shared) return wrong_state();
  rate_millihertz_ = rate;
  hal_.set_rate(hal_.board, 0);
  ticker_.set_period(static_cast<float>(about.clock_hz) / (1e-3F * static_cast<float>(rate)));
  hal_.set_rate(hal_.board, rate);
  return {};
}

// A start during a stream restarts it at frame 0.
Reply Firmware::stream_start(const wire::StreamStart& message) noexcept {
  if (message.block_frames < 1 || message.block_frames > wire::kMaxBlockFrames) return bad_value(1);
  if (idle()) ticker_.stop_stream();
  const Reply reply = take_rate(message.rate_millihertz);
  if (reply.code != AnswerCode::ok) return reply;
  samples_.begin(board_.channel_count, message.block_frames);
  run_ = ticker_.start_stream();
  return {};
}

Reply Firmware::stream_stop() noexcept {
  ticker_.stop_stream();
  return {};
}

Reply Firmware::limits(const wire::Limits& asked) noexcept {
  const wire::Welcome& about = board_.about;
  if (!(asked.drive_v > 0 && asked.drive_v <= about.drive_limit_v)) return bad_value(0);
  if (!(asked.slew_v_per_s > 0 && asked.slew_v_per_s <= about.slew_limit_v_per_s)) return bad_value(1);
  if (!within(asked.onset_s, 0, kLongestOnsetS)) return bad_value(2);
  if (!(asked.release_s >= 0 && asked.release_s + asked.drive_v / asked.slew_v_per_s <= kLongestReleaseS))
    return bad_value(3);
  if (asked.watchdog_ms < kLeastWatchdogMs || asked.watchdog_ms > kMostWatchdogMs) return bad_value(4);
  if (asked.counts_per_tick < 1) return bad_value(5);
  limits_ = asked;
  limited_ = true;
  return {};
}

Reply Firmware::gain(const wire::Gain& message) noexcept {
  if (!is_finite(message.gain)) return bad_value(0);
  ticker_.set_gain(message.gain);
  return {};
}

// A repeated command (its answer was lost) has no further effect.
Reply Firmware::change(const wire::Change& message) noexcept {
  if (!plays_profile()) return wrong_state();
  if (!within(message.fade_s, 0, kLongestFadeS)) return bad_value(0);
  if (changed_) return {};
  if (!next_.complete()) return {AnswerCode::incomplete, next_.here()};
  upload_ = next_;
  tracking_ = next_tracking_;
  next_.forget();
  changed_ = true;
  ticker_.change(texture_setup(), message.fade_s);
  return {};
}

Reply Firmware::sweep(const wire::Sweep& message) noexcept {
  if (!within(message.amplitude_v, 0, board_.about.drive_limit_v)) return bad_value(0);
  sweep_ = message;
  return {};
}

// Whether all data that the source needs are present.
Reply Firmware::ready(const wire::Arm& message) noexcept {
  if (message.source == DriveSource::scene) return ready_scene();
  if ((board_.about.features & wire::kFeatureDrive) == 0 || message.source > DriveSource::sweep)
    return bad_value(0);
  if (!limited_) return {AnswerCode::no_limits, 0};
  if (!hal_.enable_closed(hal_.board)) return {AnswerCode::enable_open, 0};
  if (message.source == DriveSource::profile && !upload_.complete())
    return {AnswerCode::incomplete, upload_.here()};
  if (message.source == DriveSource::sweep && !ticker_.sweep().set(sweep_, message.rate_millihertz))
    return {AnswerCode::incomplete, 0};
  return {};
}

Reply Firmware::arm(const wire::Arm& message) noexcept {
  Reply reply = ready(message);
  if (reply.code == AnswerCode::ok) reply = take_rate(message.rate_millihertz);
  if (reply.code != AnswerCode::ok) return reply;
  ticker_.watch_force(contact_);
  ticks_.begin(ticks_in_block(message.rate_millihertz));
  reported_ = wire::FaultCode::none;
  next_.forget();
  changed_ = false;
  if (message.source == DriveSource::scene) {
    axis_ticks_.begin(ticks_in_block(message.rate_millihertz), board_.axes->count);
    ticker_.arm(scene_arm(message), message.rate_millihertz);
    return {};
  }
  ticker_.arm(message.source, kernel_setup(message), message.rate_millihertz);
  return {};
}

TextureSetup Firmware::texture_setup() const noexcept {
  return {upload_.profile(),
          {tracking_.between_counts != 0, tracking_.look_ahead_ticks, tracking_.smoothing_ticks},
          per_full_detail(tracking_.full_detail_counts_per_tick)};
}

// Filters apply to the profile only; limits and contact gate apply to every source.
KernelSetup Firmware::kernel_setup(const wire::Arm& message) const noexcept {
  KernelSetup setup;
  setup.limits = limits_;
  setup.rate_hz = rate_of(message.rate_millihertz);
  setup.energy_rms_v = energy_.rms_v;
  setup.energy_window_s = energy_.window_s;
  setup.gate_on_n = contact_.on_n;
  setup.gate_off_n = contact_.off_n;
  if (message.source != DriveSource::profile) return setup;
  setup.texture = texture_setup();
  setup.taps = taps_.taps;
  setup.tap_count = taps_.count;
  setup.hysteresis = &hysteresis_;
  setup.sections = filters_.sections;
  setup.section_count = filters_.count;
  return setup;
}

Reply Firmware::play() noexcept {
  if (!runs()) return wrong_state();
  ticker_.supervisor().aim(Aim::play);
  ticker_.steered();
  return {};
}

Reply Firmware::stop() noexcept {
  if (ticker_.supervisor().aim() == Aim::play) ticker_.supervisor().aim(Aim::hold);
  ticker_.steered();
  return {};
}

Reply Firmware::disarm() noexcept {
  ticker_.supervisor().aim(Aim::off);
  ticker_.steered();
  return {};
}

// Only in idle: a restart would end a drive with a step.
Reply Firmware::reset() noexcept {
  if (!idle()) return wrong_state();
  ticker_.stop_stream();
  hal_.restart(hal_.board);
  return {};
}

// Samples that do not fit would be played too late: the message is refused as a whole.
Reply Firmware::drive(const wire::Drive& message) noexcept {
  auto& queue = ticker_.drive_queue();
  if (idle()) return wrong_state();
  if (message.count > kDriveQueue - queue.size()) return {AnswerCode::too_large, kDriveQueue - queue.size()};
  for (uint16_t i = 0; i < message.count; ++i) {
    *queue.place() = message.drive_v[i];
    queue.push();
  }
  return {};
}

}  // namespace tacto::core
