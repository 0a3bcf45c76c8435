// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/device/sim_board.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "firmware-host/core/wire/message_types.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "firmware-host/sim/device/sim_description.hpp"

namespace tacto::firmware_host {
namespace {

constexpr std::uint32_t kClockHz = 1'000'000;
constexpr std::size_t kForceChannel = 2;   // as in ScriptedRun
constexpr std::size_t kMessageBytes = 40;  // the bytes of a samples message without its codes: core/WIRE.md

// A finger that follows a given position. The encoder follows a script: frame i is at (i + 1) x period,
// without the frames in which the script is held at its beginning. Only the channels of position and normal
// force, the second and third of the emulated device, have values; the others are zero.
class ScriptedRun final : public FrameSource {
 public:
  // `held` must outlive this object; null: never held.
  ScriptedRun(std::function<double(double)> position_m, std::function<std::int32_t(double)> force_code,
              double period_s, double quantum_m, const std::atomic<bool>* held = nullptr)
      : position_m_(std::move(position_m)),
        force_code_(std::move(force_code)),
        period_s_(period_s),
        quantum_m_(quantum_m),
        held_(held),
        count_(count_at(0)) {}

  bool next(std::span<std::int32_t> frame) override {
    if (held_ == nullptr || !held_->load()) ++frames_;
    count_ = count_at(frames_);
    std::ranges::fill(frame, 0);
    if (frame.size() > 1) frame[1] = count_;
    if (frame.size() > 2) frame[2] = force_code_(static_cast<double>(frames_) * period_s_);
    return true;
  }
  std::int32_t encoder_count() const override { return count_; }

 private:
  // A 32-bit counter wraps at 2^31.
  std::int32_t count_at(std::uint64_t frame) const {
    const double count = std::floor(position_m_(static_cast<double>(frame) * period_s_) / quantum_m_);
    return static_cast<std::int32_t>(static_cast<std::int64_t>(count));
  }

  std::function<double(double)> position_m_;
  std::function<std::int32_t(double)> force_code_;
  double period_s_, quantum_m_;
  const std::atomic<bool>* held_;
  std::uint64_t frames_ = 0;
  std::int32_t count_;
};

// Frames with consecutive numbers as codes, so that each lost or repeated frame is detected. The code of
// channel c in frame i is 16 i + c, modulo 2^32: it wraps after 2^28 frames, 45 min at 100 kHz.
// No physics, and almost no computation.
class CounterRun final : public FrameSource {
 public:
  bool next(std::span<std::int32_t> frame) override {
    std::uint32_t code = frames_++ * std::uint32_t{wire::kMaxChannels};
    for (std::int32_t& sample : frame) sample = static_cast<std::int32_t>(code++);
    return true;
  }
  std::int32_t encoder_count() const override { return 0; }

 private:
  std::uint32_t frames_ = 0;
};

}  // namespace

SimBoard::SimBoard(const SimParameters& parameters, schema::Transducer transducer, Surface surface)
    : parameters_(parameters),
      transducer_(std::move(transducer)),
      profile_(std::move(surface.profile)),
      surface_words_(std::move(surface.description)) {
  describe();
  firmware_ = std::make_unique<core::Firmware>(about(), hal());
}

void SimBoard::describe() {
  channels_ = parameters_.counter ? counter_channels(parameters_.channels)
                                  : sim_channels(SimRun(parameters_, transducer_, profile_), parameters_);
  notes_ = sim_notes(parameters_, surface_words_);
}

core::Board SimBoard::about() {
  core::Board board = board_of(sim_welcome(parameters_, transducer_), channels_, notes_, texture_);
  board.about.clock_hz = kClockHz;
  const std::uint32_t rate = millihertz(parameters_.sample_rate_hz);
  board.about.default_rate_millihertz = rate;
  board.about.least_rate_millihertz = std::min(rate, millihertz(1e3));
  board.about.most_rate_millihertz = std::max(rate, millihertz(20e3));
  return board;
}

core::Hal SimBoard::hal() {
  core::Hal hal;
  hal.board = this;
  hal.read_encoder = [](void* b) noexcept { return of(b).source_ ? of(b).source_->encoder_count() : 0; };
  hal.read_channels = [](void* b, std::int32_t* codes) noexcept {
    std::copy_n(of(b).frame_, of(b).channels_.size(), codes);
    return of(b).diverged_s_ < 0;
  };
  hal.write_drive = [](void* b, float volts) noexcept { of(b).drive_v_ = volts; };
  hal.enable_closed = [](void* b) noexcept { return of(b).enabled_.load(); };
  hal.clock = [](void* b) noexcept { return of(b).clock(); };
  hal.set_rate = [](void* b, std::uint32_t rate) noexcept { of(b).set_rate(rate); };
  hal.receive = [](void* b, std::uint8_t* bytes, std::size_t size) noexcept {
    return take_first(of(b).from_host_, {bytes, size});
  };
  hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
    return of(b).send({bytes, size});
  };
  hal.restart = [](void* b) noexcept { of(b).set_rate(0); };
  return hal;
}

std::size_t SimBoard::send(std::span<const std::uint8_t> bytes) {
  const std::size_t size = std::min(bytes.size(), link_bytes_ - std::min(link_bytes_, to_host_.size()));
  to_host_.insert(to_host_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
  return size;
}

// Samples, with the header and the end of each message.
double SimBoard::stream_bytes_per_s() const {
  const double frame = static_cast<double>(channels_.size() * sizeof(std::int32_t));
  return 1e-3 * rate_millihertz_ * (frame + static_cast<double>(kMessageBytes) / wire::kMaxBlockFrames);
}

// Codes of the load cell, without its lag and noise.
std::function<std::int32_t(double)> SimBoard::scripted_force() const {
  const bool reported = static_cast<bool>(normal_n_);
  const double load_n = parameters_.finger_down ? parameters_.load_n : 0;
  const double newtons_per_code = channels_.size() > kForceChannel ? channels_[kForceChannel].scale : 1;
  return [=, force_n = normal_n_](double time_s) {
    return static_cast<std::int32_t>(std::llround((reported ? force_n(time_s) : load_n) / newtons_per_code));
  };
}

std::unique_ptr<FrameSource> SimBoard::source_at(const SimParameters& parameters) const {
  if (script_)
    return std::make_unique<ScriptedRun>(script_, scripted_force(), 1 / parameters.sample_rate_hz,
                                         parameters.encoder_quantum_m, &script_held_);
  if (parameters.counter) return std::make_unique<CounterRun>();
  return std::make_unique<SimRun>(parameters, transducer_, profile_);
}

std::uint64_t SimBoard::clock() const {
  if (!ticking()) return clock_before_;
  return clock_before_ + steps_ * kClockHz * 1000 / rate_millihertz_;
}

SimParameters SimBoard::parameters_at(std::uint32_t rate) const {
  SimParameters parameters = parameters_;
  if (rate != millihertz(parameters.sample_rate_hz)) parameters.sample_rate_hz = 1e-3 * rate;
  return parameters;
}

void SimBoard::set_rate(std::uint32_t rate_millihertz) {
  clock_before_ = clock();
  steps_ = 0;
  rate_millihertz_ = rate_millihertz;
  if (!ticking()) return;
  diverged_s_ = -1;
  source_ = source_at(parameters_at(rate_millihertz));
  tray_.reset();
  if (parameters_.watches_tray()) tray_sensor_.emplace(parameters_);
}

void SimBoard::step() {
  if (diverged_s_ < 0 && !source_->next(std::span(frame_).first(channels_.size())))
    diverged_s_ = static_cast<double>(steps_) * period_s();
  ++steps_;
  if (!tray_ && drive_v_ != 0)
    tray_ = std::make_unique<ActuatedTray>(transducer_, 1 / period_s(), parameters_.tray());
  if (tray_) tray_->tick(drive_v_);
  if (tray_sensor_) frame_[channels_.size() - 1] = tray_sensor_->step(displacement_m());
  firmware_->tick();
}

}  // namespace tacto::firmware_host
