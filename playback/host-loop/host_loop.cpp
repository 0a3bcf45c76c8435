// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/host-loop/host_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>

#include "data-schema/base/statistics.hpp"
#include "firmware-host/link/awake_cores.hpp"
#include "firmware-host/link/memory_transport.hpp"
#include "firmware-host/link/realtime_priority.hpp"
#include "firmware-host/link/tick_clock.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "firmware-host/link/wire_words.hpp"
#include "playback/host-loop/tray_samples.hpp"
#include "playback/prepare/upload.hpp"

namespace tacto::playback {
namespace {

using firmware_host::TickClock;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kCarryS = 0.5e-3;
constexpr std::int64_t kStaleNs = 20'000'000, kRestNs = 200'000;
constexpr double kQueueS = 4e-3;  // drives queued on the device, for as long as the carrier thread may sleep
constexpr float kDeviceReleaseS = 0.01F;
constexpr int kLooks = 100;
constexpr double kQueueShare = 0.2, kFollowS = 0.5, kMostLonger = 5e-3;

Result<std::size_t> position_channel(const firmware_host::Description& about) {
  for (std::size_t i = 0; i < about.channels.size(); ++i)
    if (std::strcmp(about.channels[i].quantity, "position") == 0) return i;
  return fail(ErrorKind::device, "the device has no channel of the quantity position", "host loop");
}

}  // namespace

HostLoop::HostLoop(firmware_host::Client& device, const HostLoopOptions& options, std::size_t channel)
    : device_(device),
      options_(options),
      position_channel_(channel),
      sensor_channel_(tray_sensor_channel(device.description())),
      board_(std::make_unique<HostBoard>(device.description(), options.rate_hz)),
      codes_(1024 * device.description().channels.size()) {}

Result<std::unique_ptr<HostLoop>> HostLoop::begin(firmware_host::Client& device,
                                                  const HostLoopOptions& options) {
  const auto channel = position_channel(device.description());
  TACTO_TRY(channel);
  TACTO_TRY(check_rate(device, options.rate_hz));
  std::unique_ptr<HostLoop> loop(new HostLoop(device, options, *channel));
  TACTO_TRY(device.start_stream(firmware_host::millihertz(options.rate_hz), 1));
  TACTO_TRY(device.await_samples(1));
  TACTO_TRY(loop->measure_delay());
  loop->tick_thread_ = std::thread([&self = *loop] { self.tick_forever(); });
  loop->carry_thread_ = std::thread([&self = *loop] { self.carry_forever(); });
  return loop;
}

// The delay is the sum of: a group of counts and one more period, two periods of the carrier, the device's
// queue, and the round trip on the link. Medians, because a computer may stall.
Result<void> HostLoop::measure_delay() {
  std::vector<std::int64_t> batches, trips;
  for (int i = 0; i < kLooks; ++i) {
    const std::uint32_t before = periods_;
    if (const auto came = device_.receive(kCarryS); !came) return came;
    take_counts();
    if (periods_ > before) batches.push_back(periods_ - before);
    if (i % 10 != 0) continue;
    const std::int64_t asked_ns = TickClock::now_ns();
    TACTO_TRY(device_.heartbeat());
    trips.push_back(TickClock::now_ns() - asked_ns);
  }
  const double batch = batches.empty() ? 0 : static_cast<double>(schema::upper_median(std::span(batches)));
  board_->set_reserve(static_cast<std::uint32_t>(batch) + 1);
  delay_s_ = (batch + 1 + queue_target()) / options_.rate_hz + 2 * kCarryS +
             1e-9 * static_cast<double>(schema::upper_median(std::span(trips)));
  return {};
}

HostLoop::~HostLoop() {
  ending_.store(true);
  if (tick_thread_.joinable()) tick_thread_.join();
  if (carry_thread_.joinable()) carry_thread_.join();
}

std::unique_ptr<firmware_host::Transport> HostLoop::transport() {
  return std::make_unique<firmware_host::MemoryTransport>(board_->link(), "host loop");
}

std::string HostLoop::latency_words() const {
  const EdgeToDrive measured = latency();
  return fmt::format(
      "from the encoder's edge to the drive: p50 {:.2f} ms, p99 {:.2f} ms (count's age, queue, round trip)",
      1e3 * measured.p50_s, 1e3 * measured.p99_s);
}

HostLoopStatus HostLoop::status() const {
  HostLoopStatus status;
  status.wake_p50_s = wake_.quantile_s(0.5);
  status.wake_p99_s = wake_.quantile_s(0.99);
  status.wake_p999_s = wake_.quantile_s(0.999);
  status.busy_p99_s = busy_.quantile_s(0.99);
  std::ranges::transform(kLateBoundsS, status.late_parts.begin(),
                         [this](double bound_s) { return wake_.part_over(bound_s); });
  status.latency = latency();
  status.looked_ahead_s = delay_s_;
  status.missed_ticks = missed_.load();
  status.stale_drives = stale_.load();
  status.trimmed_drives = trimmed_.load();
  status.real_time = real_time_.load();
  const std::lock_guard lock(fault_mutex_);
  status.device_fault = fault_;
  return status;
}

// The real-time thread. Between runs it answers the player every 0.2 ms.
void HostLoop::tick_forever() {
  const firmware_host::RealtimePriority priority(options_.priority);
  real_time_.store(priority.granted());
  std::optional<firmware_host::AwakeCores> awake;
  TickClock clock;
  std::uint64_t missed = 0;
  bool ticked = false;
  while (!ending_.load(std::memory_order_relaxed)) {
    if (!board_->ticking()) {
      ticked = false;
      awake.reset();
      std::this_thread::sleep_for(std::chrono::nanoseconds(kRestNs));
      board_->rest(TickClock::now_ns());
      continue;
    }
    if (!ticked) {
      awake.emplace();
      clock.begin(options_.rate_hz);
    }
    ticked = true;
    clock.lengthen(longer_ns_.load(std::memory_order_relaxed));
    const std::int64_t late_ns = clock.wait(missed);
    const std::int64_t began_ns = TickClock::now_ns();
    board_->tick(began_ns, late_ns);
    wake_.add(late_ns);
    busy_.add(TickClock::now_ns() - began_ns);
    missed_.store(missed, std::memory_order_relaxed);
  }
}

void HostLoop::give_up(const std::string& why) {
  sound_ = false;
  const std::lock_guard lock(fault_mutex_);
  fault_ = why;
}

// The newest count was sampled just now; each earlier one is a period older.
void HostLoop::take_counts() {
  const std::size_t channels = device_.description().channels.size();
  const double period_ns = 1e9 / options_.rate_hz;
  auto& queue = device_.samples();
  for (bool more = true; more;) {
    while (queue.at_gap()) periods_ += static_cast<std::uint32_t>(queue.take_gap().count);
    const std::size_t frames = queue.take(codes_);
    more = frames > 0;
    if (!more) break;
    last_count_ns_ = TickClock::now_ns();
    board_->set_codes(std::span(codes_).subspan((frames - 1) * channels, channels));
    for (std::size_t i = 0; i < frames; ++i) {
      const auto age_ns = static_cast<std::int64_t>(static_cast<double>(frames - 1 - i) * period_ns);
      ++periods_;
      if (sensor_channel_) board_->put_sample(periods_, codes_[i * channels + *sensor_channel_]);
      board_->put_count(periods_, codes_[i * channels + position_channel_], last_count_ns_ - age_ns);
    }
    board_->set_enabled(sound_ && enabled_);
  }
}

void HostLoop::take_faults() {
  for (const wire::Ticks& message : device_.take_ticks())
    if (message.count > 0) enabled_ = (message.ticks[message.count - 1].flags & wire::kTickEnabled) != 0;
  for (const wire::Fault& fault : device_.take_faults())
    if (fault.code != wire::FaultCode::ring_full)
      give_up(firmware_host::words_of(fault.code, fault.detail).what);
}

// The device is armed exactly while the loop is armed.
void HostLoop::follow_arming() {
  const bool drives = board_->wants_drive();
  if (drives == armed_) return;
  armed_ = drives;
  to_trim_ = to_pad_ = 0;
  last_drive_v_ = 0;
  while (board_->drives().front() != nullptr) board_->drives().pop();
  sound_ = true;  // disarming clears a fault, as on a device
  if (!drives) return (void)device_.command(wire::Disarm{});
  {
    const std::lock_guard lock(fault_mutex_);
    fault_.clear();
  }
  const wire::Welcome& about = device_.description().welcome;
  const wire::Limits limits{about.drive_limit_v, about.slew_limit_v_per_s, 0,
                            kDeviceReleaseS,     options_.watchdog_ms,     UINT16_MAX};
  const wire::Arm arm{wire::DriveSource::host, firmware_host::millihertz(options_.rate_hz)};
  (void)device_.command(wire::Disarm{});
  auto done = device_.command(limits);
  if (done) done = device_.command(arm);
  if (done) done = device_.command(wire::Play{});
  if (!done) give_up(schema::message(done.error()));
  to_pad_ = queue_target();
  queue_mean_ = to_pad_;
  longer_ns_.store(0, std::memory_order_relaxed);
}

void HostLoop::send_drives() {
  wire::Drive message;
  for (; to_pad_ > 0; --to_pad_) message.drive_v[message.count++] = last_drive_v_;
  const std::int64_t now_ns = TickClock::now_ns(), oldest_ns = now_ns - kStaleNs;
  for (const TimedDrive* drive = board_->drives().front();
       drive != nullptr && message.count < wire::kMaxChunk; drive = board_->drives().front()) {
    const bool stale = drive->time_ns < oldest_ns;
    if (stale) stale_.fetch_add(1, std::memory_order_relaxed);
    if (!stale && to_trim_ > 0) {
      --to_trim_;
      trimmed_.fetch_add(1, std::memory_order_relaxed);
    } else if (!stale) {
      message.drive_v[message.count++] = last_drive_v_ = drive->drive_v;
      latency_.add(now_ns - drive->reading_ns + round_trip_ns_ + queue_ns_);
    }
    board_->drives().pop();
  }
  if (message.count == 0) return;
  if (const auto sent = device_.send_drive(message); !sent) give_up(schema::message(sent.error()));
}

// At most what one message can hold.
std::uint32_t HostLoop::queue_target() const {
  return std::clamp(static_cast<std::uint32_t>(kQueueS * options_.rate_hz), 4U, 200U);
}

// A growing queue means that the device's clock is slower, or that there was a stall. The tick period follows
// it, within half a percent, so that no drives have to be left out.
void HostLoop::follow_queue(std::uint32_t queued) {
  queue_mean_ += kQueueShare * (queued - queue_mean_);
  const double part = (queue_mean_ - queue_target()) / options_.rate_hz / kFollowS;
  const double longer = std::clamp(part, -kMostLonger, kMostLonger) * 1e9 / options_.rate_hz;
  longer_ns_.store(static_cast<std::int64_t>(longer), std::memory_order_relaxed);
}

// Resets the device's watchdog, and reads the length of its queue.
void HostLoop::beat() {
  const std::int64_t now = TickClock::now_ns();
  if (now < next_beat_ns_) return;
  next_beat_ns_ = now + std::int64_t{options_.watchdog_ms} * 250'000;
  const std::int64_t asked_ns = TickClock::now_ns();
  const auto pulse = device_.heartbeat();
  round_trip_ns_ = TickClock::now_ns() - asked_ns;
  if (!pulse) return give_up(schema::message(pulse.error()));
  if (!armed_) enabled_ = pulse->enabled;  // there are no ticks now that report it
  if (!armed_) return;
  const std::uint32_t target = queue_target(), queued = pulse->drive_queued;
  queue_ns_ = static_cast<std::int64_t>(1e9 * queued / options_.rate_hz);
  follow_queue(queued);
  if (queued > 2 * target) to_trim_ = queued - target;
  if (queued < target / 4) to_pad_ = target - queued;
}

// Priority below the ticks and above all else, because a late drive increases the latency.
void HostLoop::carry_forever() {
  const firmware_host::RealtimePriority priority(options_.priority / 2);
  const std::int64_t silence_ns = std::int64_t{options_.watchdog_ms} * 1'000'000;
  last_count_ns_ = TickClock::now_ns();
  while (!ending_.load(std::memory_order_relaxed)) {
    follow_arming();
    if (const auto came = device_.receive(kCarryS); !came) give_up(schema::message(came.error()));
    take_faults();
    take_counts();
    if (TickClock::now_ns() - last_count_ns_ > silence_ns) give_up("the device sends no counts");
    if (!sound_) board_->set_enabled(false);
    if (armed_ && sound_) send_drives();
    beat();
  }
  (void)device_.command(wire::Disarm{});
  (void)device_.stop_stream();
}

}  // namespace tacto::playback
