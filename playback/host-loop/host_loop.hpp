// SPDX-License-Identifier: GPL-3.0-or-later
// The loop closed on this computer: a real-time thread runs the firmware's core, and a carrier thread moves
// counts and drives between it and the device.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "firmware-host/link/transport.hpp"
#include "playback/host-loop/host_board.hpp"
#include "playback/host-loop/loop_view.hpp"
#include "playback/host-loop/time_histogram.hpp"

namespace tacto::playback {

struct HostLoopOptions {
  double rate_hz = 2000;
  int priority = 50;  ///< of SCHED_FIFO; 0: not requested
  std::uint16_t watchdog_ms = 100;
};

/// Latency from the encoder's edge to its drive: the age of the count when the drive was sent, the round
/// trip, and the device's queue; over all drives that were sent.
struct EdgeToDrive {
  double p50_s = 0, p99_s = 0;
};

struct HostLoopStatus {
  double wake_p50_s = 0, wake_p99_s = 0, wake_p999_s = 0;  ///< after the tick's due time
  double busy_p99_s = 0;                                   ///< duration of the tick's computation
  std::array<double, kLateBoundsS.size()> late_parts{};    ///< parts of the ticks, later than kLateBoundsS
  EdgeToDrive latency;
  double looked_ahead_s = 0;         ///< the part of it that the look-ahead compensates
  std::uint64_t missed_ticks = 0;    ///< periods that were skipped
  std::uint64_t stale_drives = 0;    ///< not sent because they were too old
  std::uint64_t trimmed_drives = 0;  ///< left out because the device's clock is slower
  bool real_time = false;            ///< SCHED_FIFO was granted
  std::string device_fault;          ///< why the drive had to fall; empty if there is no fault
};

/// Presents a device to the player (transport()), with the kernel on this computer and the encoder and output
/// of the real device. The real-time thread exchanges counts and drives through lock-free buffers; it calls
/// the system only to sleep. The carrier thread sends the drives in order, each within 20 ms or not at all,
/// keeps the device's queue 4 ms long, and opens the enable input if the device faults, or sends no counts
/// for the watchdog's time. A computer that stalls sends nothing: then the device's own watchdog ramps to
/// zero.
class HostLoop final : public LoopView {
 public:
  /// Starts both threads. The device streams its encoder from now on; it is armed only while the loop is
  /// armed. Only the carrier thread may use the client until the end. Errors: device: no stream, no encoder.
  static schema::Result<std::unique_ptr<HostLoop>> begin(firmware_host::Client& device,
                                                         const HostLoopOptions& options);
  HostLoop(const HostLoop&) = delete;
  HostLoop& operator=(const HostLoop&) = delete;
  ~HostLoop() override;

  /// For the player's own Client.
  std::unique_ptr<firmware_host::Transport> transport();
  HostLoopStatus status() const;
  /// Delay from the encoder's edge to the drive, measured at the start: a texture looks ahead by it.
  double delay_s() const { return delay_s_; }
  std::int32_t lateness_ns(std::uint64_t tick) const override { return board_->lateness_ns(tick); }
  std::int64_t due_ns(std::uint64_t tick) const override { return board_->due_ns(tick); }
  void take_samples(std::uint64_t tick, SampleRun& into) override { board_->take_samples(tick, into); }
  std::string latency_words() const override;
  EdgeToDrive latency() const { return {latency_.quantile_s(0.5), latency_.quantile_s(0.99)}; }

 private:
  HostLoop(firmware_host::Client& device, const HostLoopOptions& options, std::size_t position_channel);
  schema::Result<void> measure_delay();
  void tick_forever();
  void carry_forever();
  void take_counts();
  void take_faults();
  void follow_arming();
  void send_drives();
  std::uint32_t queue_target() const;
  void beat();
  void follow_queue(std::uint32_t queued);
  void give_up(const std::string& why);

  firmware_host::Client& device_;
  HostLoopOptions options_;
  std::size_t position_channel_;
  std::optional<std::size_t> sensor_channel_;
  std::unique_ptr<HostBoard> board_;
  TimeHistogram wake_, busy_, latency_;
  std::atomic<std::uint64_t> missed_{0}, stale_{0}, trimmed_{0};
  std::atomic<std::int64_t> longer_ns_{0};  // added to each tick period, to follow the device's clock
  std::atomic<bool> ending_{false}, real_time_{false};
  // Of the carrier thread.
  std::vector<std::int32_t> codes_;
  std::int64_t last_count_ns_ = 0, next_beat_ns_ = 0;
  std::int64_t round_trip_ns_ = 0, queue_ns_ = 0;  // as of the last heartbeat
  double delay_s_ = 0, queue_mean_ = 0;
  std::uint32_t periods_ = 0;  // of the device's stream
  std::uint32_t to_trim_ = 0, to_pad_ = 0;
  float last_drive_v_ = 0;
  bool armed_ = false, sound_ = true, enabled_ = true;
  mutable std::mutex fault_mutex_;
  std::string fault_;
  std::thread tick_thread_, carry_thread_;
};

}  // namespace tacto::playback
