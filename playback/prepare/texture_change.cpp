// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/texture_change.hpp"

#include <fmt/format.h>

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr const char* kDisarmFirst = "disarm first, then load";

tl::unexpected<schema::Error> can_not_change(std::string what) {
  return fail(ErrorKind::unsuitable, std::move(what), "change of texture", kDisarmFirst);
}

bool same_tracker(const core::TrackerSetup& a, const core::TrackerSetup& b) {
  return a.between_counts == b.between_counts && a.look_ahead_ticks == b.look_ahead_ticks &&
         a.smoothing_ticks == b.smoothing_ticks;
}

bool same_plays(const wire::Hysteresis& a, const wire::Hysteresis& b) {
  const auto same = [](const wire::HysteresisPlay& x, const wire::HysteresisPlay& y) {
    return x.threshold == y.threshold && x.weight == y.weight;
  };
  return a.straight == b.straight && std::equal(a.play_operators, a.play_operators + a.count,
                                                b.play_operators, b.play_operators + b.count, same);
}

bool same_limits(const Prepared& a, const Prepared& b) {
  return a.limits.drive_v == b.limits.drive_v && a.limits.slew_v_per_s == b.limits.slew_v_per_s &&
         a.energy_rms_v == b.energy_rms_v && a.energy_window_s == b.energy_window_s &&
         a.gate_on_n == b.gate_on_n && a.gate_off_n == b.gate_off_n;
}

}  // namespace

Result<void> check_texture_change(const Prepared& playing, const Prepared& next,
                                  std::uint32_t profile_samples) {
  if (playing.rate_millihertz() != next.rate_millihertz())
    return can_not_change(fmt::format("the texture is for {:g} ticks per second, the device runs at {:g}",
                                      next.rate_hz, playing.rate_hz));
  if (playing.taps != next.taps || !same_plays(playing.play_operators, next.play_operators) ||
      !same_tracker(playing.tracker, next.tracker))
    return can_not_change("the texture is for another transducer, filter or encoder than the playing one");
  if (!same_limits(playing, next))
    return can_not_change("the texture's limits differ from those of the playing one");
  const std::size_t room = profile_samples - std::min<std::size_t>(profile_samples, playing.samples.size());
  if (next.samples.size() > room)
    return can_not_change(
        fmt::format("the texture needs {} samples, the memory beside the playing one holds {}",
                    next.samples.size(), room));
  return {};
}

}  // namespace tacto::playback
