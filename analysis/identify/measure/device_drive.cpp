// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/device_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware-host/link/client.hpp"
#include "firmware-host/link/wire_fields.hpp"

namespace tacto::analysis {
namespace {

using firmware_host::Client;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::uint8_t kFramesOfMessage = 32;
constexpr std::uint16_t kWatchdogMs = 500;
constexpr std::size_t kLeastRefill = 32;  // samples: 128 bytes, in a message of 20 more
constexpr double kWaitS = 5e-3, kIdleWaitS = 1;
// Silence before the drive. Ticks also take samples before `play` is in effect, and do not play them.
constexpr double kLeadS = 0.25;
constexpr std::size_t kMostWaits = 20;  // one after another: 0.1 s, well within the watchdog's time
constexpr std::uint32_t kLimited =
    wire::kTickAmplitudeLimited | wire::kTickSlewLimited | wire::kTickEnergyLimited | wire::kTickGated;

Result<std::size_t> tray_channel(const firmware_host::Capabilities& about) {
  const auto found = std::ranges::find(about.channels, "displacement", &schema::Channel::quantity);
  if (found != about.channels.end()) return static_cast<std::size_t>(found - about.channels.begin());
  return fail(
      ErrorKind::unsuitable, "the device does not measure its tray: it has no channel of displacement",
      about.uri,
      "for an emulated device add tray_sensor=on, on a board connect the pin for the tray's sensor to "
      "ground (firmware-host/RIG.md); else give a file of measured values");
}

// One run: the frames and ticks so far, by the device's numbers.
class Run {
 public:
  Run(Client& client, const firmware_host::Capabilities& about, std::size_t channel)
      : client_(client), about_(about), channel_(channel) {}

  Result<void> begin() {
    const auto limits = limits_of();
    client_.take_ticks();
    client_.take_faults();
    auto done = client_.command(limits);
    const std::uint32_t rate = firmware_host::millihertz(about_.sample_rate_hz);
    if (done) done = client_.start_stream(rate, kFramesOfMessage);
    if (done) done = client_.command(wire::Arm{wire::DriveSource::host, rate});
    return done;
  }
  // What waits in the device is known from its ticks, and is not more: to ask each time would take as many
  // bytes as the drive. It is asked at the end, and if it is silent.
  Result<void> feed(std::span<const float> drive_v) {
    const std::size_t left = drive_v.size() - sent_;
    const std::size_t waiting = sent_ - std::min(sent_, played_);
    const std::size_t queue = client_.description().welcome.drive_queue;
    const std::size_t count = std::min({queue - std::min(queue, waiting), left, wire::kMaxChunk});
    if (count > 0 && count >= std::min(kLeastRefill, left)) {
      waits_ = 0;
      return send(drive_v.subspan(sent_, count));
    }
    if (left == 0 || ++waits_ % kMostWaits == 0) {
      const auto pulse = client_.heartbeat();
      TACTO_TRY(pulse);
      empty_ = left == 0 && pulse->drive_queued == 0;
    }
    return client_.receive(kWaitS);
  }
  Result<void> take() {
    if (client_.samples().has_gap() && client_.samples().at_gap())
      return fail(ErrorKind::device, "frames were lost on the link", about_.uri,
                  "identify again, with less other load on the computer");
    take_frames();
    for (const wire::Ticks& block : client_.take_ticks())
      if (const auto kept = keep(block); !kept) return kept;
    if (const auto faults = client_.take_faults(); !faults.empty())
      return fail(ErrorKind::device,
                  fmt::format("the device stopped with fault {}", static_cast<int>(faults[0].code)),
                  about_.uri, "check that its enable input is closed and the computer not too busy");
    return {};
  }
  Result<void> end() {
    auto done = client_.command(wire::Disarm{});
    for (double waited_s = 0; done && waited_s < kIdleWaitS; waited_s += kWaitS) {
      const auto pulse = client_.heartbeat();
      TACTO_TRY(pulse);
      if (pulse->state == wire::DriveState::idle) break;
      done = client_.receive(kWaitS);
    }
    const auto stopped = client_.stop_stream();
    return done ? stopped : done;
  }
  bool all_played() const { return empty_; }
  double sent() const { return static_cast<double>(sent_); }

  // Aligns frames and ticks in time, from the first sample of the plan on.
  Result<DrivenTray> paired(std::span<const float> plan) const {
    if (displacement_m_.empty() || drive_.empty())
      return fail(ErrorKind::device, "the device sent no samples", about_.uri);
    const auto shift =
        static_cast<std::ptrdiff_t>(std::llround((first_tick_s_ - first_frame_s_) * about_.sample_rate_hz));
    const auto loud = [](float v) { return v != 0; };
    const auto in_plan = std::ranges::find_if(plan, loud) - plan.begin();
    const auto in_ticks = std::ranges::find_if(drive_, loud) - drive_.begin();
    const std::ptrdiff_t first = in_ticks - in_plan;
    const auto count = static_cast<std::ptrdiff_t>(plan.size());
    if (first < 0 || first + count > static_cast<std::ptrdiff_t>(drive_.size()) || first + shift < 0 ||
        first + shift + count > static_cast<std::ptrdiff_t>(displacement_m_.size()))
      return fail(ErrorKind::device, "the device sent fewer samples than it played", about_.uri);
    DrivenTray tray{about_.sample_rate_hz, {}, {}, limited_};
    tray.drive_v.assign(drive_.begin() + first, drive_.begin() + first + count);
    tray.displacement_m.assign(displacement_m_.begin() + first + shift,
                               displacement_m_.begin() + first + shift + count);
    return late(plan, tray) ? late_words() : Result<DrivenTray>(std::move(tray));
  }

 private:
  wire::Limits limits_of() const {
    const wire::Welcome& welcome = client_.description().welcome;
    wire::Limits limits{welcome.drive_limit_v, welcome.slew_limit_v_per_s, 0, 0, kWatchdogMs, 65535};
    if (!about_.transducer) return limits;
    limits.drive_v = std::min(limits.drive_v, firmware_host::not_above(about_.transducer->drive_limit_v));
    limits.slew_v_per_s =
        std::min(limits.slew_v_per_s, firmware_host::not_above(about_.transducer->slew_limit_v_per_s));
    return limits;
  }
  Result<void> send(std::span<const float> part) {
    wire::Drive drive;
    drive.count = static_cast<std::uint16_t>(part.size());
    std::ranges::copy(part, drive.drive_v);
    const auto sent = client_.send_drive(drive);
    const bool first = sent_ == 0;
    sent_ += part.size();
    return sent && first ? client_.command(wire::Play{}) : sent;
  }
  double begin_s(double device_s, std::uint64_t number) const {
    return device_s - static_cast<double>(number) / about_.sample_rate_hz;
  }
  void take_frames() {
    const std::size_t channels = about_.channels.size();
    codes_.resize(client_.samples().frames() * channels);
    const std::size_t frames = client_.samples().take(codes_);
    const schema::Channel& tray = about_.channels[channel_];
    for (std::size_t i = 0; i < frames; ++i)
      displacement_m_.push_back(tray.physical(codes_[i * channels + channel_]));
    if (const auto& last = client_.last_arrival())
      first_frame_s_ = std::min(first_frame_s_, begin_s(last->device_s, last->frame));
  }
  Result<void> keep(const wire::Ticks& block) {
    const double device_s = static_cast<double>(block.device_ticks) / client_.description().welcome.clock_hz;
    first_tick_s_ = std::min(first_tick_s_, begin_s(device_s, block.first_tick));
    if (block.first_tick != drive_.size())
      return fail(ErrorKind::device, "ticks were lost on the link", about_.uri,
                  "identify again, with less other load on the computer");
    for (std::size_t i = 0; i < block.count; ++i) {
      drive_.push_back(block.ticks[i].drive_v);
      limited_ += (block.ticks[i].flags & kLimited) != 0;
      played_ += (block.ticks[i].flags & wire::kTickPlaying) != 0;
    }
    return {};
  }
  // Whether the drive differs from the plan in more ticks than limits explain.
  bool late(std::span<const float> plan, const DrivenTray& tray) const {
    std::size_t other = 0;
    for (std::size_t i = 0; i < plan.size(); ++i)
      other += std::abs(tray.drive_v[i] - static_cast<double>(plan[i])) > 1e-5;
    return other > 2 * limited_;
  }
  Result<DrivenTray> late_words() const {
    return fail(ErrorKind::device, "the device did not play the requested drive: it arrived too late",
                about_.uri, "identify again, with less other load on the computer");
  }

  Client& client_;
  const firmware_host::Capabilities& about_;
  std::size_t channel_;
  std::size_t sent_ = 0, played_ = 0, limited_ = 0, waits_ = 0;
  bool empty_ = false;
  std::vector<std::int32_t> codes_;
  std::vector<double> displacement_m_;
  std::vector<float> drive_;
  // The time of number 0 by the device's clock: a device can read it late, but not early, so the least of
  // all.
  double first_frame_s_ = std::numeric_limits<double>::infinity(), first_tick_s_ = first_frame_s_;
};

Result<void> played(Run& run, std::span<const float> drive_v, const std::function<bool()>& stop_asked,
                    const std::function<void(double)>& progress) {
  while (!run.all_played()) {
    if (stop_asked()) return fail(ErrorKind::usage, "stopped before the end", "identify");
    auto done = run.feed(drive_v);
    if (done) done = run.take();
    if (!done) return done;
    progress(run.sent() / static_cast<double>(drive_v.size()));
  }
  return {};
}

}  // namespace

double drive_rate_hz(const firmware_host::Device& device) {
  return device.capabilities().sample_rate_hz;
}

Result<DrivenTray> drive_tray(firmware_host::Device& device, std::span<const float> drive_v,
                              const std::function<bool()>& stop_asked,
                              const std::function<void(double)>& progress) {
  Client* const client = device.conversation();
  if (client == nullptr)
    return fail(ErrorKind::unsuitable, "nothing can be played on a replay", device.capabilities().uri);
  const auto channel = tray_channel(device.capabilities());
  TACTO_TRY(channel);
  Run run(*client, device.capabilities(), *channel);
  std::vector<float> sent_v(static_cast<std::size_t>(kLeadS * drive_rate_hz(device)));
  sent_v.insert(sent_v.end(), drive_v.begin(), drive_v.end());
  auto done = run.begin();
  if (done) done = played(run, sent_v, stop_asked, progress);
  const auto ended = run.end();
  if (done) done = ended;
  if (done) done = run.take();
  TACTO_TRY(done);
  return run.paired(drive_v);
}

}  // namespace tacto::analysis
