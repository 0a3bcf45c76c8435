// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of the emulated device, for the tests of calibration.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "capture/calibrate/uncertain.hpp"
#include "capture/record/take.hpp"
#include "firmware-host/open_device.hpp"
#include "tests/measured.hpp"

namespace tacto::capture {

/// `keys` as after "sim:".
inline Take sim_take(const std::string& keys, double time_s) {
  const auto device = firmware_host::open_device("sim:" + keys);
  EXPECT_TRUE(device) << keys;
  auto take = take_from(**device, time_s);
  EXPECT_TRUE(take) << keys;
  return std::move(*take);
}

/// Compares errors with the stated uncertainty: the share within the stated interval of 95 %, and the RMS of
/// error over standard uncertainty.
class Coverage {
 public:
  void add(const Uncertain& found, double truth) {
    const double relative = (found.value - truth) / found.uncertainty;
    inside_ += std::abs(relative) <= coverage_factor_95(found.degrees_of_freedom) ? 1 : 0;
    squares_ += relative * relative;
    ++count_;
  }
  double inside() const { return inside_ / count_; }
  double rms() const { return std::sqrt(squares_ / count_); }
  /// KEY.inside of KEY.draws, and KEY.rms.
  void print(const std::string& key) const {
    std::printf("%s: %.0f of %.0f within the stated 95 %%, RMS of error over uncertainty %.2f\n", key.c_str(),
                inside_, count_, rms());
    measured(key + ".inside", inside_);
    measured(key + ".draws", count_);
    measured(key + ".rms", rms());
  }

 private:
  double inside_ = 0, squares_ = 0, count_ = 0;
};

}  // namespace tacto::capture
