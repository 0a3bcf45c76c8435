// SPDX-License-Identifier: GPL-3.0-or-later
// usb_link URI NAME SECONDS: records a device to NAME as `record` does, and drives it at the same time. Every
// value of the drive must be played once, in order and to the bit, as the device's ticks report. Prints
// counts; the exit code is 1 if anything was lost, damaged or refused.
#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "capture/record/record.hpp"
#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/open_device.hpp"
#include "tests/usb/drive_check.hpp"

namespace tacto::tests {
namespace {

using firmware_host::Capabilities;
using firmware_host::StreamCounts;
using firmware_host::StreamEvents;
using firmware_host::WireDevice;
using schema::Result;

constexpr float kDriveV = 0.5F;
constexpr std::uint16_t kMessage = 128;    // values
constexpr std::uint64_t kQueue = 1024;     // values in the device's queue
constexpr std::uint64_t kQueueFull = 960;  // a tenth of a second at 10 kHz
constexpr int kMessagesAtFirst = 4;

/// A device that is driven while the recorder reads it.
class DrivenDevice final : public firmware_host::Device {
 public:
  explicit DrivenDevice(WireDevice& device) : device_(device) {}

  const Capabilities& capabilities() const override { return device_.capabilities(); }
  StreamCounts counts() const override { return device_.counts(); }
  StreamEvents take_events() override { return device_.take_events(); }

  Result<void> start() override { return device_.start(); }

  Result<std::size_t> read(std::span<std::int32_t> interleaved) override {
    if (!std::exchange(playing_, true)) TACTO_TRY(play());
    for (const wire::Ticks& ticks : device_.client().take_ticks()) check_.take(ticks);
    TACTO_TRY(fill());
    return device_.read(interleaved);
  }

  // Stops the device first, after which all ticks are reported.
  Result<void> stop() override {
    if (const auto off = device_.client().command(wire::Disarm{}); !off) return off;
    do {
      const auto pulse = device_.client().heartbeat();
      TACTO_TRY(pulse);
      pulse_ = *pulse;
    } while (pulse_.state != wire::DriveState::idle && pulse_.state != wire::DriveState::fault);
    const auto stopped = device_.stop();
    for (const wire::Ticks& ticks : device_.client().take_ticks()) check_.take(ticks);
    return stopped;
  }

  const wire::Pulse& pulse() const { return pulse_; }
  const DriveCheck& check() const { return check_; }
  std::uint64_t sent() const { return sent_; }

 private:
  // Starts with the first read: from then on the recorder reads, and fills the queue, every 20 ms.
  Result<void> play() {
    if (const auto armed = arm(); !armed) return armed;
    for (int i = 0; i < kMessagesAtFirst; ++i)
      if (const auto sent = send(); !sent) return sent;
    return device_.client().command(wire::Play{});
  }

  Result<void> arm() {
    const wire::Welcome& welcome = device_.client().description().welcome;
    wire::Limits limits;
    limits.drive_v = 2 * kDriveV;
    limits.slew_v_per_s = welcome.slew_limit_v_per_s;
    limits.onset_s = 0;
    limits.release_s = 0.01F;
    limits.watchdog_ms = 1000;
    limits.counts_per_tick = 65535;
    if (const auto limited = device_.client().command(limits); !limited) return limited;
    return device_.client().command(wire::Arm{wire::DriveSource::host, welcome.default_rate_millihertz});
  }

  // Until the device's ticks show where the drive began, the number of values that passed unplayed is
  // unknown, so the device is queried. Reads do not measure its time: a delayed board delivers many blocks at
  // once.
  Result<void> fill() {
    if (!check_.begun()) return fill_as_told();
    while (sent_ - check_.used() + kMessage <= kQueueFull)
      if (const auto sent = send(); !sent) return sent;
    return {};
  }

  Result<void> fill_as_told() {
    const auto pulse = device_.client().heartbeat();
    TACTO_TRY(pulse);
    if (pulse->drive_queued + kMessage > kQueueFull) return {};
    return send();
  }

  Result<void> send() {
    wire::Drive drive;
    drive.count = kMessage;
    for (std::size_t i = 0; i < kMessage; ++i) drive.drive_v[i] = drive_of(sent_ + i);
    sent_ += kMessage;
    return device_.client().send_drive(drive);
  }

  WireDevice& device_;
  DriveCheck check_;
  wire::Pulse pulse_;
  std::uint64_t sent_ = 0;
  bool playing_ = false;
};

int tell(const schema::Error& error) {
  fmt::print(stderr, "usb_link: {}\n", schema::message(error));
  return 1;
}

bool say_counts(const DrivenDevice& device, const capture::Recorded& recorded,
                const firmware_host::LinkCounts& link) {
  const wire::Pulse& pulse = device.pulse();
  const StreamCounts& counts = recorded.counts;
  fmt::print("frames {} lost {} gaps {} | link: damaged {} missing {} stale {} refused drives {}\n",
             counts.frames, counts.lost_frames, recorded.recording.header.gaps.size(),
             link.frames.oversize + link.frames.bad_check + link.frames.truncated, link.lost, link.stale,
             link.refused_drives);
  const DriveCheck& drive = device.check();
  fmt::print("drive: sent {} played as sent {} otherwise {} missing ticks {}\n", device.sent(),
             drive.as_sent(), drive.otherwise(), drive.missing());
  fmt::print("device: state {} fault {} lost {} underruns {} damaged {} missing {}\n",
             static_cast<int>(pulse.state), static_cast<int>(pulse.fault), pulse.lost_records,
             pulse.underruns, pulse.damaged_frames, pulse.missing_frames);
  const auto damaged =
      link.frames.dropped_bytes + link.frames.oversize + link.frames.bad_check + link.frames.truncated;
  const bool to_host = counts.lost_frames + damaged + link.lost + link.stale + pulse.lost_records == 0;
  const bool to_device = link.refused_drives + pulse.damaged_frames + pulse.missing_frames == 0;
  const bool played = drive.missing() == 0 && drive.otherwise() == pulse.underruns &&
                      device.sent() - drive.used() <= kQueue && 10 * drive.as_sent() > counts.frames &&
                      pulse.state == wire::DriveState::idle;
  return to_host && to_device && played;
}

int run(const std::string& uri, const std::string& name, double time_s) {
  auto opened = firmware_host::open_device(uri);
  if (!opened) return tell(opened.error());
  auto* const wire = dynamic_cast<WireDevice*>(opened->get());
  if (wire == nullptr) return tell({schema::ErrorKind::usage, "speaks no wire", uri, {}});
  DrivenDevice device(*wire);
  capture::RecordRequest request;
  request.name = name;
  request.time_s = time_s;
  const auto recorded = capture::record(device, request);
  if (!recorded) return tell(recorded.error());
  const bool sound = say_counts(device, *recorded, wire->client().counts());
  if (recorded->ended_by) return tell(*recorded->ended_by);
  return sound ? 0 : 1;
}

}  // namespace
}  // namespace tacto::tests

int main(int count, char** values) {
  if (count != 4) return 2;
  return tacto::tests::run(values[1], values[2], std::atof(values[3]));
}
