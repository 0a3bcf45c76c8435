// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/reference/exact_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::playback {
namespace {

double smooth_weight(double level) {
  return level * level * (3 - 2 * level);
}

double ramped(double level, bool raise, double rise_ticks, double fall_ticks) {
  return std::clamp(level + (raise ? 1 / std::max(1.0, rise_ticks) : -1 / std::max(1.0, fall_ticks)), 0.0,
                    1.0);
}

// The kernel's approximate measure of speed (core::half_octaves), here in double precision.
double coarseness_of(double ratio) {
  if (!(ratio > 1)) return 0;
  int exponent = 0;
  const double rest = 2 * std::frexp(ratio, &exponent) - 1;
  return 2 * (exponent - 1 + rest + double{0.3431F} * rest * (1 - rest));
}

}  // namespace

ExactKernel::ExactKernel(const Prepared& prepared)
    : prepared_(prepared),
      rate_hz_(prepared.rate_hz),
      past_(prepared.taps.size()),
      plays_(prepared.play_operators.count),
      sections_(prepared.sections.size()),
      root_v_(prepared.energy_rms_v) {
  std::size_t first = 0;
  for (std::uint8_t level = 0; level < prepared.scale.levels; ++level) {
    first_.push_back(first);
    first += core::level_samples(prepared.scale, level);
  }
}

double ExactKernel::sample(int level, double index) const {
  const double size = core::level_samples(prepared_.scale, static_cast<std::uint32_t>(level));
  if (prepared_.scale.ends == Ends::loop) index -= size * std::floor(index / size);
  if (prepared_.scale.ends == Ends::mirror) {
    index = std::fmod(std::abs(index), 2 * (size - 1));
    index = std::min(index, 2 * (size - 1) - index);
  }
  if (index < 0 || index >= size) return 0;
  return prepared_.samples[first_[static_cast<std::size_t>(level)] + static_cast<std::size_t>(index)];
}

// Cubic Hermite with slopes of fourth order: the only interpolation that has a reference here.
double ExactKernel::level_at(int level, double place) const {
  place = std::ldexp(place, -(level / 2));
  const double i = std::floor(place), u = place - i;
  const auto slope = [&](double at) {
    return (8 * (sample(level, at + 1) - sample(level, at - 1)) -
            (sample(level, at + 2) - sample(level, at - 2))) /
           12;
  };
  return (1 + 2 * u) * (1 - u) * (1 - u) * sample(level, i) + u * (1 - u) * (1 - u) * slope(i) +
         u * u * (3 - 2 * u) * sample(level, i + 1) + u * u * (u - 1) * slope(i + 1);
}

double ExactKernel::texture_at(double count, double counts_per_tick) const {
  const core::ProfileScale& scale = prepared_.scale;
  const double per_count = std::ldexp(static_cast<double>(scale.samples_per_count_q32), -32);
  const double place =
      (count - scale.origin_count) * per_count + std::ldexp(static_cast<double>(scale.at_origin_q32), -32);
  const double ratio = std::abs(counts_per_tick) / prepared_.full_detail_counts_per_tick;
  const double coarseness = scale.levels > 1 ? coarseness_of(ratio) : 0;
  if (coarseness < 1) return level_at(0, place);
  const int coarser = static_cast<int>(coarseness);
  if (coarser > scale.levels) return 0;
  const double fade = coarseness - coarser;
  return (1 - fade) * level_at(coarser - 1, place) +
         (coarser < scale.levels ? fade * level_at(coarser, place) : 0);
}

void ExactKernel::see(double moved) {
  offset_ -= moved;
  if (moved * speed_ < 0) {
    offset_ = moved > 0 ? 0 : 1;
    speed_ = 0;
    seen_ = 1;
    return;
  }
  const double per_tick = std::min(std::abs(speed_), 1.0);
  const double miss = (moved > 0 ? 0 : 1) + 0.5 * std::copysign(per_tick, speed_) - offset_;
  if (seen_ > 1 && std::abs(miss) > 4) {
    offset_ += miss;
    speed_ = moved / since_;
    seen_ = 2;
    return;
  }
  const double excess = std::abs(miss) - double{0.1F} - 0.5 * per_tick, haste = double{0.2F} * (2 - per_tick);
  double alpha = std::min(since_ / (since_ + prepared_.tracker.smoothing_ticks), double{0.1F});
  if (excess > 0) alpha = std::max(alpha, std::min(haste * (1 + excess), 0.5));
  double beta = alpha * alpha / (2 - alpha);
  const double n = seen_ < 400 ? ++seen_ : 1e9, line = 2 * (2 * n - 1) / (n * (n + 1));
  if (line > alpha) alpha = line, beta = n > 1 ? 6 / (n * (n + 1)) : 0;
  offset_ += alpha * miss;
  speed_ += beta * miss / since_;
}

void ExactKernel::track(std::int64_t count) {
  if (!begun_) count_ = count, offset_ = 0.5, begun_ = true;
  const auto moved = static_cast<double>(count - count_);
  count_ = count;
  since_ += 1;
  offset_ += speed_;
  if (moved != 0) {
    see(moved);
    since_ = 0;
  } else {
    speed_ = std::clamp(speed_, -1.5 / since_, 1.5 / since_);
    offset_ = std::clamp(offset_, -1.0, 2.0);
  }
  const core::TrackerSetup& setup = prepared_.tracker;
  place_ = static_cast<double>(count) + (setup.between_counts ? std::clamp(offset_, 0.0, 1.0) : 0) +
           setup.look_ahead_ticks * speed_;
}

double ExactKernel::gain(double aim) {
  const int ticks = std::max(1, static_cast<int>(0.01F * static_cast<float>(rate_hz_)));
  if (!gained_) gain_ = gain_aim_ = aim, gained_ = true;
  if (aim != gain_aim_) gain_aim_ = aim, gain_left_ = ticks, gain_step_ = (aim - gain_) / ticks;
  if (gain_left_ > 0) gain_ = --gain_left_ > 0 ? gain_ + gain_step_ : gain_aim_;
  return gain_;
}

double ExactKernel::filtered(double value) {
  if (past_.empty()) return value;
  past_.insert(past_.begin(), value);
  past_.pop_back();
  double sum = 0;
  for (std::size_t i = 0; i < past_.size(); ++i) sum += past_[i] * prepared_.taps[i];
  return sum;
}

double ExactKernel::played(double value) {
  const wire::Hysteresis& play_operators = prepared_.play_operators;
  double sum = play_operators.straight * value;
  for (std::size_t i = 0; i < plays_.size(); ++i) {
    const double threshold = play_operators.play_operators[i].threshold;
    plays_[i] = std::max(value - threshold, std::min(value + threshold, plays_[i]));
    sum += play_operators.play_operators[i].weight * plays_[i];
  }
  return sum;
}

double ExactKernel::sectioned(double value) {
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const wire::Section& h = prepared_.sections[i];
    auto& [x1, x2, y1, y2] = sections_[i];
    const double y = h.b0 * value + h.b1 * x1 + h.b2 * x2 - h.a1 * y1 - h.a2 * y2;
    sections_[i] = {value, x1, y, y1};
    value = y;
  }
  return value;
}

// One Newton step per tick defines the root; the exact root would respond at once.
double ExactKernel::energy_limited(double value) {
  const double limit_v = prepared_.energy_rms_v;
  if (!(limit_v > 0)) return value;
  mean_square_ += (value * value - mean_square_) / std::max(1.0, prepared_.energy_window_s * rate_hz_);
  root_v_ = 0.5 * (root_v_ + std::max(mean_square_, limit_v * limit_v) / root_v_);
  return value * limit_v / root_v_;
}

double ExactKernel::tick(const Input& input) {
  track(input.count);
  const double unlimited = sectioned(played(filtered(gain(input.gain) * texture_at(place_, speed_))));
  if (prepared_.gate_on_n > 0) {
    touching_ = input.normal_force_n >= (touching_ ? prepared_.gate_off_n : prepared_.gate_on_n);
    gate_ = ramped(gate_, touching_, 0.02 * rate_hz_, 0.02 * rate_hz_);
  }
  const wire::Limits& limits = prepared_.limits;
  level_ = ramped(level_, input.raise, limits.onset_s * rate_hz_, limits.release_s * rate_hz_);
  const double touch = prepared_.gate_on_n > 0 ? smooth_weight(gate_) : 1;
  const double held = std::clamp<double>(energy_limited(unlimited * smooth_weight(level_) * touch),
                                         -limits.drive_v, limits.drive_v);
  const double step_v = limits.slew_v_per_s / rate_hz_;
  return last_v_ = std::clamp(held, last_v_ - step_v, last_v_ + step_v);
}

}  // namespace tacto::playback
