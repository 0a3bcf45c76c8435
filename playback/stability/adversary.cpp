// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/stability/adversary.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "firmware-host/core/scene/edge_speed.hpp"

namespace tacto::playback {
namespace {

constexpr std::size_t kLongestWay = 32;  // ticks

// A closed motion: in each tick even up to the change of the force, and even after it.
struct ClosedPath {
  double start_m = 0;
  std::vector<double> before_m, after_m;
};

class Adversary {
 public:
  Adversary(const schema::DeviceAxis& axis, const TickTiming& timing, double damping, double speed_mps,
            std::uint64_t seed)
      : axis_(axis), timing_(timing), damping_(damping), random_(seed) {
    whole_ = static_cast<std::size_t>(timing.delay_ticks);
    part_ = timing.delay_ticks - std::floor(timing.delay_ticks);
    // At any speed: steps in which Coulomb friction and rounding are small beside viscous friction and hold.
    const double viscous = std::max(axis.viscous_n_s_per_m, 1e-9);
    longest_m_ = std::isfinite(speed_mps)
                     ? speed_mps * timing.period_s
                     : 1e5 * std::max(axis.encoder_step_m, axis.coulomb_n * timing.period_s / viscous);
    speed_mps_ = speed_mps;
  }

  // The K from which on this path gives energy.
  double next() {
    draw();
    const std::size_t ticks = path_.before_m.size();
    counts_.clear();
    double place_m = path_.start_m, friction_j = 0;
    for (std::size_t i = 0; i < ticks; ++i) {
      counts_.push_back(std::round(place_m / axis_.encoder_step_m));
      place_m += path_.before_m[i] + path_.after_m[i];
      friction_j += dissipated_j(path_.before_m[i], part_) + dissipated_j(path_.after_m[i], 1 - part_);
    }
    if (damping_ > 0) find_speeds();
    double spring = 0, damper_j = 0;  // energy on the hand: of K = 1, and of B
    for (std::size_t i = 0; i < ticks; ++i) {
      const std::size_t now = (i + ticks * (1 + whole_ / ticks) - whole_) % ticks;
      const std::size_t last = (now + ticks - 1) % ticks;
      spring -= axis_.encoder_step_m * (counts_[last] * path_.before_m[i] + counts_[now] * path_.after_m[i]);
      if (damping_ > 0)
        damper_j -= damping_ * (speeds_[last] * path_.before_m[i] + speeds_[now] * path_.after_m[i]);
    }
    const double lacking_j = friction_j - damper_j;
    if (lacking_j < 0) return 0;
    return spring > 0 ? lacking_j / spring : INFINITY;
  }

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double log_uniform(double from, double to) { return from * std::pow(to / from, uniform()); }

  double dissipated_j(double way_m, double part) const {
    if (way_m == 0) return 0;
    return axis_.viscous_n_s_per_m * way_m * way_m / (part * timing_.period_s) +
           axis_.coulomb_n * std::abs(way_m);
  }

  // Often the longest step, or whole counts.
  double step() {
    const double step_m = axis_.encoder_step_m, kind = uniform();
    if (kind < 0.25) return longest_m_;
    const double way_m = log_uniform(std::min(step_m, longest_m_) * 1e-3, longest_m_);
    if (kind < 0.5 && longest_m_ >= step_m)
      return std::max(1.0, std::floor((uniform() < 0.5 ? longest_m_ : way_m) / step_m)) * step_m;
    return way_m;
  }

  // Divides the path of a tick at the change of the force, within the speed.
  void add(double way_m, double split) {
    path_.before_m.push_back(way_m * split);
    path_.after_m.push_back(way_m - way_m * split);
  }

  void draw() {
    const double step_m = axis_.encoder_step_m, kind = uniform();
    path_.before_m.clear();
    path_.after_m.clear();
    path_.start_m = step_m * (4 * uniform() - 2);
    double split = part_;
    if (part_ > 0 && uniform() < 0.7 && !std::isfinite(speed_mps_)) split = uniform();
    if (kind < 0.2) {  // across one border of the encoder
      const double way_m = std::min(longest_m_, log_uniform(1e-4, 1) * step_m);
      path_.start_m = step_m * (std::floor(4 * uniform()) - 1.5) + uniform() * way_m;
      add(-way_m, split);
      add(way_m, split);
    } else if (kind < 0.7) {  // there and back
      const double way_m = step();
      const auto ticks = 1 + static_cast<std::size_t>(uniform() * (uniform() < 0.5 ? 2 : kLongestWay));
      if (uniform() < 0.5) path_.start_m = step_m * (std::floor(4 * uniform()) - 1.5 + 1e-9);
      for (std::size_t i = 0; i < 2 * ticks; ++i) add(i < ticks ? -way_m : way_m, split);
    } else {  // random, and straight back in as few ticks as the speed permits
      const auto ticks = 1 + static_cast<std::size_t>(uniform() * 8);
      double sum_m = 0;
      for (std::size_t i = 0; i < ticks; ++i) {
        const double way_m = (uniform() < 0.5 ? -1 : 1) * step();
        sum_m += way_m;
        add(way_m, split);
      }
      const double back = std::max(1.0, std::ceil(std::abs(sum_m) / longest_m_));
      for (double i = 0; i < back; ++i) add(-sum_m / back, split);
    }
  }

  // Of the second of two cycles, m/s.
  void find_speeds() {
    core::EdgeSpeed speed;
    speeds_.clear();
    for (int cycle = 0; cycle < 2; ++cycle)
      for (const double count : counts_)
        speeds_.push_back(double{speed.track(static_cast<std::int32_t>(std::clamp(count, -1e9, 1e9)))});
    speeds_.erase(speeds_.begin(), speeds_.begin() + static_cast<std::ptrdiff_t>(counts_.size()));
    for (double& each : speeds_) each *= axis_.encoder_step_m / timing_.period_s;
  }

  const schema::DeviceAxis& axis_;
  const TickTiming timing_;
  double damping_, part_, longest_m_, speed_mps_;
  std::size_t whole_;
  std::mt19937_64 random_;
  ClosedPath path_;
  std::vector<double> counts_, speeds_;
};

}  // namespace

double least_generating_stiffness(const schema::DeviceAxis& axis, const TickTiming& timing,
                                  double virtual_damping_n_s_per_m, double speed_mps, std::size_t paths,
                                  std::uint64_t seed) {
  Adversary adversary(axis, timing, virtual_damping_n_s_per_m, speed_mps, seed);
  double least = INFINITY;
  for (std::size_t i = 0; i < paths; ++i) least = std::min(least, adversary.next());
  return least;
}

}  // namespace tacto::playback
