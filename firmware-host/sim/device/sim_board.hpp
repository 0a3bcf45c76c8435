// SPDX-License-Identifier: GPL-3.0-or-later
// The board of the emulated device: the firmware's core, with physics behind its hardware layer.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/sim/bench/actuated_tray.hpp"
#include "firmware-host/sim/device/emulated_board.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"
#include "firmware-host/sim/device/sim_run.hpp"
#include "firmware-host/sim/device/tray_sensor.hpp"
#include "firmware-host/sim/physics/surface.hpp"

namespace tacto::firmware_host {

/// One thread calls step() and poll(). Each time the rate is set, the finger starts again: equal parameters
/// give equal frames. While there is a drive, the tray moves with it, independently of the sensor, with the
/// hysteresis, second mode and finger's load of the parameters.
class SimBoard final : public EmulatedBoard {
 public:
  SimBoard(const SimParameters& parameters, schema::Transducer transducer, Surface surface);

  bool ticking() const override { return rate_millihertz_ > 0; }
  double period_s() const { return 1e3 / rate_millihertz_; }
  double host_period_s() const override { return period_s() / (1 + 1e-6 * parameters_.errors.clock_ppm); }
  void step() override;
  void poll() override { firmware_->poll(); }

  void set_enabled(bool enabled) { enabled_.store(enabled); }  // from any thread
  /// From the next time the rate is set, the encoder follows position_m (m, over the seconds since then), and
  /// there is no other physics of the finger. Its load is the parameter `load`, or normal_n (N, over the same
  /// time); the other channels are zero.
  void set_script(std::function<double(double time_s)> position_m,
                  std::function<double(double time_s)> normal_n = {}) {
    script_ = std::move(position_m);
    normal_n_ = std::move(normal_n);
  }
  /// The script stays at its beginning, or continues. From any thread.
  void hold_script(bool held) { script_held_.store(held); }
  double stream_bytes_per_s() const override;

  /// The time at which the motion diverged, in seconds since the rate was set. Negative if it has not.
  double diverged_s() const { return diverged_s_; }
  double drive_v() const { return drive_v_; }
  double displacement_m() const { return tray_ ? tray_->displacement_m() : 0; }
  wire::DriveState drive_state() const { return firmware_->drive_state(); }
  const core::DriveSupervisor& supervisor() const { return firmware_->supervisor(); }

 private:
  static SimBoard& of(void* board) noexcept { return *static_cast<SimBoard*>(board); }
  core::Hal hal();
  core::Board about();
  void set_rate(std::uint32_t rate_millihertz);
  std::size_t send(std::span<const std::uint8_t> bytes);
  std::unique_ptr<FrameSource> source_at(const SimParameters& parameters) const;
  std::function<std::int32_t(double)> scripted_force() const;
  std::uint64_t clock() const;
  SimParameters parameters_at(std::uint32_t rate_millihertz) const;
  void describe();

  SimParameters parameters_;
  schema::Transducer transducer_;
  HeightProfile profile_;
  std::function<double(double)> script_, normal_n_;
  std::atomic<bool> script_held_{false};
  std::vector<wire::Channel> channels_;
  std::vector<wire::Note> notes_;
  HostedProfile texture_;
  std::unique_ptr<FrameSource> source_;
  std::unique_ptr<ActuatedTray> tray_;
  std::optional<TraySensor> tray_sensor_;
  std::int32_t frame_[wire::kMaxChannels] = {};
  std::uint32_t rate_millihertz_ = 0;
  std::uint64_t steps_ = 0, clock_before_ = 0;
  std::atomic<bool> enabled_{true};
  double drive_v_ = 0, diverged_s_ = -1;
  std::string surface_words_;
  std::unique_ptr<core::Firmware> firmware_;
};

}  // namespace tacto::firmware_host
