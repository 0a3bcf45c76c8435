// SPDX-License-Identifier: GPL-3.0-or-later
// The texture's kernel in double precision: the reference for the rounding error of single precision.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// drive = slew(amplitude(energy(envelope x gate x sections(plays(taps(gain x levels(place))))))), the
/// formulas of core::TickKernel, implemented from those formulas and not from its source: places as doubles,
/// fmod for the ends, the filter as a sum. The samples are the rounded ones. What is a free choice of the
/// kernel is the same here: the tracker's gains and thresholds, the measure of speed for the fade between
/// levels, one Newton step per tick. Slow; not for the tick.
class ExactKernel {
 public:
  explicit ExactKernel(const Prepared& prepared);

  struct Input {
    std::int64_t count = 0;
    double gain = 0;
    bool raise = false;
    double normal_force_n = 0;  ///< used if the setup has a contact gate
  };
  double tick(const Input& input);

 private:
  double level_at(int level, double place) const;
  double sample(int level, double index) const;
  double texture_at(double count, double counts_per_tick) const;
  void track(std::int64_t count);
  void see(double moved);
  double gain(double aim);
  double filtered(double value);
  double played(double value);
  double sectioned(double value);
  double energy_limited(double value);

  const Prepared& prepared_;
  double rate_hz_;
  std::vector<std::size_t> first_;
  // State of the finger's tracker.
  bool begun_ = false;
  std::int64_t count_ = 0;
  double offset_ = 0, speed_ = 0, since_ = 0, place_ = 0;
  int seen_ = 0;
  // State of gain, filter and limits.
  bool gained_ = false;
  double gain_ = 0, gain_aim_ = 0, gain_step_ = 0;
  int gain_left_ = 0;
  std::vector<double> past_, plays_;
  std::vector<std::array<double, 4>> sections_;  // x_-1, x_-2, y_-1, y_-2 of each section
  double mean_square_ = 0, root_v_ = 0, level_ = 0, gate_ = 0, last_v_ = 0;
  bool touching_ = false;
};

}  // namespace tacto::playback
