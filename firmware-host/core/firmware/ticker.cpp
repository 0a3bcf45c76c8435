// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/firmware/ticker.hpp"

namespace tacto::core {

using wire::DriveSource;
using wire::DriveState;
using wire::FaultCode;

uint8_t Ticker::start_stream() noexcept {
  stream_.store(Stream::off);
  run_.store(static_cast<uint8_t>(run_.load() + 1));
  records_.clear();
  stream_fault_.store(FaultCode::none);
  stream_.store(Stream::starting);
  return run_.load();
}

void Ticker::begin_arm(DriveSource source) noexcept {
  source_ = source;
  tick_ = 0;
  drive_queue_.clear();
  scene_changes_.clear();
  steered_.store(0);
  steered_taken_ = 0;
  gain_taken_ = gain_.load();
  change_.store(kNoChange);
  change_taken_ = false;
}

void Ticker::arm(const SceneArm& scene, uint32_t rate_millihertz) noexcept {
  begin_arm(DriveSource::scene);
  scene_.set(scene.scene, scene.setup, scene.live);
  axes_ = static_cast<uint8_t>(scene.setup.axis_count);
  int32_t counts[wire::kMaxAxes] = {};
  hal_.read_axes(hal_.board, counts);
  for (uint8_t i = 0; i < axes_; ++i)
    axis_watch_[i].arm(scene.counts_per_tick, scene.setup.rate_hz, counts[i]);
  supervisor_.arm(scene.limits, rate_millihertz);
}

// Writes the change first, then the word after which the tick reads it.
bool Ticker::steer(const SceneChange& change) noexcept {
  CountedChange* const place = scene_changes_.place();
  if (place == nullptr) return false;
  *place = {change, static_cast<uint8_t>(steered_.load() + 1)};
  scene_changes_.push();
  steered();
  return true;
}

void Ticker::arm(DriveSource source, const KernelSetup& setup, uint32_t rate_millihertz) noexcept {
  begin_arm(source);
  kernel_.set(setup);
  watch_.arm(setup.limits.counts_per_tick, setup.rate_hz, hal_.read_encoder(hal_.board));
  supervisor_.arm(setup.limits, rate_millihertz);  // last: from here on a tick uses all of it
}

// Writes the data first, then the word after which the tick reads them.
void Ticker::change(const TextureSetup& texture, float fade_s) noexcept {
  next_texture_ = texture;
  fade_s_ = fade_s;
  const auto count = static_cast<uint8_t>(steered_.load() + 1);
  change_.store(static_cast<uint16_t>(kChangeAsked | count));
  steered();
}

FaultCode Ticker::take_stream_fault() noexcept {
  const FaultCode code = stream_fault_.load();
  if (code != FaultCode::none) stream_fault_.store(FaultCode::none);
  return code;
}

// One tick; its steps follow in their order.
void Ticker::tick() noexcept {
  Record* place = records_.place();
  Record& record = place != nullptr ? *place : spare_;
  look(record);
  sample(record);
  drive(record);
  count(record.flags);
  keep(place != nullptr, record);
}

void Ticker::look(Record& record) noexcept {
  record.clock = hal_.clock(hal_.board);
  record.encoder = hal_.read_encoder(hal_.board);
  record.flags = hal_.enable_closed(hal_.board) ? wire::kTickEnabled : 0U;
  if (ticked_ && record.clock - last_clock_ > late_clocks_) record.flags |= wire::kTickLate;
  last_clock_ = record.clock;
  ticked_ = true;
}

void Ticker::sample(Record& record) noexcept {
  record.sampled = stream_.load() != Stream::off;
  if (!record.sampled) return;
  if (stream_.load() == Stream::starting) frame_ = 0;
  stream_.store(Stream::on);
  record.run = run_.load();
  record.frame = frame_++;
  record.sampled = hal_.read_channels(hal_.board, record.codes);
  if (record.sampled) return;
  stream_.store(Stream::off);
  tell(FaultCode::converter);
}

// Each record contains the number of commands in effect, so that a session can be replayed with the same
// bits.
void Ticker::take_steering(Record& record) noexcept {
  if (const uint8_t steered = steered_.load(); steered != steered_taken_) {
    steered_taken_ = steered;
    gain_taken_ = gain_.load();
    take_change();
    take_scene_changes();
  }
  record.flags |= uint32_t{steered_taken_} << wire::kTickSteeredShift;
}

void Ticker::take_scene_changes() noexcept {
  for (const CountedChange* next; (next = scene_changes_.front()) != nullptr; scene_changes_.pop()) {
    if (static_cast<int8_t>(steered_taken_ - next->count) < 0) return;
    const auto& [type, set, move, raise] = next->change;
    if (type == wire::MessageType::set)
      scene_.change(set.layer, set.number, set.value, set.ramp_s * scene_.rate_hz());
    if (type == wire::MessageType::move)
      scene_.move(move.patch, {move.x_counts, move.y_counts}, move.ramp_s * scene_.rate_hz());
    if (type == wire::MessageType::raise) scene_.raise(raise.patch);
  }
}

// Not before its own command is counted: a tick may occur between the two stores of the main loop, when only
// an earlier command is counted.
void Ticker::take_change() noexcept {
  const uint16_t asked = change_.load();
  const auto since = static_cast<int8_t>(steered_taken_ - static_cast<uint8_t>(asked));
  if (asked == kNoChange || change_taken_ || since < 0) return;
  kernel_.change(next_texture_, fade_s_);
  change_taken_ = true;
}

// From here on the old texture is not read.
void Ticker::end_change() noexcept {
  if (!change_taken_ || kernel_.changing()) return;
  change_taken_ = false;
  change_.store(kNoChange);
}

// A drive sample of the host belongs to one tick; a late sample is not played.
float Ticker::target(int32_t count, bool& lacks) noexcept {
  if (source_ == DriveSource::profile) {
    const float target = kernel_.target(count, gain_taken_);
    end_change();
    return target;
  }
  // After `stop` or a fault the sweep goes on below the falling envelope until the drive is at rest.
  if (source_ == DriveSource::sweep)
    return supervisor_.state() == DriveState::playing || !kernel_.at_rest() ? sweep_.next() : 0;
  const float* next = drive_queue_.front();
  lacks = next == nullptr;
  if (lacks) return kernel_.last_v();
  const float drive_v = *next;
  drive_queue_.pop();
  return drive_v;
}

// The count in use may differ from the encoder's count.
int32_t Ticker::follow(Record& record) noexcept {
  const uint32_t unseen = hal_.encoder_unseen != nullptr ? hal_.encoder_unseen(hal_.board) : 0;
  const int32_t count = watch_.see(record.encoder, unseen, kernel_.at_rest());
  if (watch_.found()) kernel_.reset_finger_speed();
  if (watch_.blind()) record.flags |= wire::kTickBlind;
  return count;
}

// A converter without a sample counts as no contact.
float Ticker::normal_force(Record& record) noexcept {
  if (!(contact_.on_n > 0)) return kNoForce;
  if (!record.sampled && !hal_.read_channels(hal_.board, record.codes)) return 0;
  return static_cast<float>(record.codes[contact_.channel]) * contact_.newtons_per_code + contact_.offset_n;
}

void Ticker::rest() noexcept {
  constexpr float kNoForces[wire::kMaxAxes] = {};
  hal_.write_drive(hal_.board, 0);
  if (hal_.write_forces != nullptr) hal_.write_forces(hal_.board, kNoForces);
}

void Ticker::drive(Record& record) noexcept {
  record.driven = supervisor_.state() != DriveState::idle;
  record.drive_v = 0;
  record.axes = 0;
  if (!record.driven) return rest();
  take_steering(record);
  const FaultCode before = supervisor_.fault();
  if (source_ == DriveSource::scene)
    drive_forces(record);
  else
    drive_tray(record);
  record.tick = tick_++;
  if (supervisor_.state() == DriveState::playing) record.flags |= wire::kTickPlaying;
  if (supervisor_.state() == DriveState::fault) record.flags |= wire::kTickFault;
  if (supervisor_.fault() != before) fault_clock_ = record.clock;
}

void Ticker::drive_forces(Record& record) noexcept {
  record.axes = axes_;
  hal_.read_axes(hal_.board, record.counts);
  TickObservation sights{0, (record.flags & wire::kTickEnabled) != 0, false, false};
  for (uint8_t i = 0; i < axes_; ++i) {
    axis_watch_[i].see(record.counts[i], 0, scene_.at_rest());
    if (axis_watch_[i].jump() > sights.encoder_jump) sights.encoder_jump = axis_watch_[i].jump();
  }
  const ForceOutput output = scene_.tick(record.counts, supervisor_.observe(sights));
  for (uint8_t i = 0; i < axes_; ++i) record.force_n[i] = output.force_n[i];
  record.flags |= output.flags;
  hal_.write_forces(hal_.board, output.force_n);
  supervisor_.settle(output.sound, scene_.at_rest());
}

void Ticker::drive_tray(Record& record) noexcept {
  const int32_t count = follow(record);
  TickObservation sights{watch_.jump(), (record.flags & wire::kTickEnabled) != 0, false, watch_.blind()};
  const float kernel_input = target(count, sights.drive_lacks);
  const bool raise = supervisor_.observe(sights);
  const TickOutput output = kernel_.drive(kernel_input, raise, normal_force(record));
  record.drive_v = output.drive_v;
  record.flags |= output.flags;
  hal_.write_drive(hal_.board, record.drive_v);
  supervisor_.settle(output.sound, kernel_.at_rest());
  counts_.underruns += sights.drive_lacks && supervisor_.aim() == Aim::play;
}

void Ticker::count(uint32_t flags) noexcept {
  counts_.late += (flags & wire::kTickLate) != 0;
  counts_.amplitude_limited += (flags & wire::kTickAmplitudeLimited) != 0;
  counts_.slew_limited += (flags & wire::kTickSlewLimited) != 0;
}

void Ticker::keep(bool there, const Record& record) noexcept {
  if (!record.sampled && !record.driven) return;
  if (there) records_.push();
  if (!there) ++counts_.lost_records;
  if (!there && !losing_) tell(FaultCode::ring_full);
  losing_ = !there;
}

}  // namespace tacto::core
