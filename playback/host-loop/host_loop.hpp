// SPDX-License-Identifier: GPL-3.0-or-later
// The loop closed on this computer: a real-time thread that runs the firmware's core, and one that carries
// counts and drive between it and the device.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "firmware-host/link/transport.hpp"
#include "playback/host-loop/host_board.hpp"
#include "playback/host-loop/tick_clock.hpp"
#include "playback/host-loop/time_histogram.hpp"

namespace tacto::playback {

struct HostLoopOptions {
  double rate_hz = 2000;
  int priority = 50;  ///< under SCHED_FIFO; 0: not asked for
  std::uint16_t watchdog_ms = 100;
};

/// From the encoder's edge to the drive that it makes: the age of the count when its drive was sent, the way
/// there and back, and the device's queue; of each drive that was sent.
struct EdgeToDrive {
  double p50_s = 0, p99_s = 0;
};

struct HostLoopStatus {
  double wake_p50_s = 0, wake_p99_s = 0, wake_p999_s = 0;  ///< behind the tick's time
  double busy_p99_s = 0;                                   ///< of the tick's work
  std::array<double, kLateBoundsS.size()> late_parts{};    ///< of the ticks, later than kLateBoundsS
  EdgeToDrive latency;
  double looked_ahead_s = 0;         ///< of it, by what is played
  std::uint64_t missed_ticks = 0;    ///< periods that were slept through
  std::uint64_t stale_drives = 0;    ///< that were not sent, for they were too old
  std::uint64_t trimmed_drives = 0;  ///< left out because the device's clock is slower
  bool real_time = false;            ///< SCHED_FIFO was granted
  std::string device_fault;          ///< why the drive had to go; empty where nothing is wrong
};

/// A device as the player sees one (transport()), with this computer's kernel and the other device's encoder
/// and output. The real-time thread takes counts from, and leaves drives in, places without locks; it calls
/// the system only to sleep. The carrier sends each drive in its turn, within 20 ms or never, keeps the
/// device's queue 4 ms deep, and turns a device that faults, or gives no counts for the watchdog's time, into
/// an open enable input. A computer that stalls sends nothing: the device's own watchdog ramps to zero.
class HostLoop {
 public:
  /// Begins both threads; the device streams its encoder from now on, and is armed only while the loop is.
  /// The client is the carrier's until the end. Errors: device: no stream, no encoder.
  static schema::Result<std::unique_ptr<HostLoop>> begin(firmware_host::Client& device,
                                                         const HostLoopOptions& options);
  HostLoop(const HostLoop&) = delete;
  HostLoop& operator=(const HostLoop&) = delete;
  ~HostLoop();

  /// For a Client of its own: the player's.
  std::unique_ptr<firmware_host::Transport> transport();
  HostBoard& board() { return *board_; }
  const HostBoard& board() const { return *board_; }
  HostLoopStatus status() const;
  /// From the encoder's edge to the drive, as seen while the loop began: what a texture looks ahead by.
  double delay_s() const { return delay_s_; }
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
  std::atomic<std::int64_t> longer_ns_{0};  // each period of the ticks, to follow the device's clock
  std::atomic<bool> ending_{false}, real_time_{false};
  // The carrier's.
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
