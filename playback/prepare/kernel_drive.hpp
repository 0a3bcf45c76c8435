// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the tick kernel offline, along a finger's path.
#pragma once

#include <cstddef>
#include <vector>

#include "playback/model/finger_path.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

struct KernelDrive {
  std::vector<double> drive_v;  ///< single precision, one per tick
  LimitTally tally;
};

/// The drive of `ticks` ticks from the path's first time on. The encoder counts in steps of metres_per_count,
/// rounded down, with origin_count at origin_m; the drive is on from the first tick.
KernelDrive kernel_drive(const Prepared& prepared, const FingerPath& path, const PrepareOptions& options,
                         std::size_t ticks);

/// The same at another gain, without limits of amplitude and slew (an energy limit stays): the drive before
/// these limits, V.
std::vector<double> unlimited_drive(const Prepared& prepared, double gain_m_per_n, const FingerPath& path,
                                    const PrepareOptions& options, std::size_t ticks);

}  // namespace tacto::playback
