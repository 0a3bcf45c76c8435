// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/reference/exact_tick.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::firmware_host {

ExactTick::ExactTick(TickSetup setup) : setup_(std::move(setup)), pasts_(setup_.sections.size()) {}

double ExactTick::sample(double index) const {
  const double size = setup_.scale.samples;
  if (setup_.scale.ends == wire::ProfileEnds::loop) index -= size * std::floor(index / size);
  if (setup_.scale.ends == wire::ProfileEnds::mirror) {
    const double round_trip = 2 * (size - 1);
    index = std::fmod(std::abs(index), round_trip);
    index = std::min(index, round_trip - index);
  }
  return index < 0 || index >= size ? 0 : setup_.profile[static_cast<std::size_t>(index)];
}

double ExactTick::profile_at(std::int64_t count) const {
  const double per_count = std::ldexp(static_cast<double>(setup_.scale.samples_per_count_q32), -32);
  const double origin = std::ldexp(static_cast<double>(setup_.scale.at_origin_q32), -32);
  const double place = static_cast<double>(count - setup_.scale.origin_count) * per_count + origin;
  const double index = std::floor(place), u = place - index;
  const auto slope = [&](double at) {
    return (8 * (sample(at + 1) - sample(at - 1)) - (sample(at + 2) - sample(at - 2))) / 12;
  };
  const double h00 = (1 + 2 * u) * (1 - u) * (1 - u), h10 = u * (1 - u) * (1 - u);
  const double h01 = u * u * (3 - 2 * u), h11 = u * u * (u - 1);
  return h00 * sample(index) + h10 * slope(index) + h01 * sample(index + 1) + h11 * slope(index + 1);
}

double ExactTick::tick(std::int64_t count, bool raise) {
  double x = setup_.gain * profile_at(count);
  for (std::size_t i = 0; i < pasts_.size(); ++i) {
    const wire::Section& h = setup_.sections[i];
    Past& past = pasts_[i];
    const double y = h.b0 * x + h.b1 * past.x1 + h.b2 * past.x2 - h.a1 * past.y1 - h.a2 * past.y2;
    past = {x, past.x1, y, past.y1};
    x = y;
  }
  const wire::Limits& limits = setup_.limits;
  level_ += raise ? 1 / std::max(1.0, limits.onset_s * setup_.rate_hz)
                  : -1 / std::max(1.0, limits.release_s * setup_.rate_hz);
  level_ = std::clamp(level_, 0.0, 1.0);
  const double target_v =
      std::clamp<double>(x * level_ * level_ * (3 - 2 * level_), -limits.drive_v, limits.drive_v);
  const double step_v = limits.slew_v_per_s / setup_.rate_hz;
  last_v_ = std::clamp(target_v, last_v_ - step_v, last_v_ + step_v);
  return last_v_;
}

}  // namespace tacto::firmware_host
