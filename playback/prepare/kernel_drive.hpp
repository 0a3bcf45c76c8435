// SPDX-License-Identifier: GPL-3.0-or-later
// The tick kernel run offline, along a finger's path.
#pragma once

#include <cstddef>
#include <vector>

#include "playback/model/finger_path.hpp"
#include "playback/model/limit_tally.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

struct KernelDrive {
  std::vector<double> drive_v;  ///< as single precision has it, one a tick
  LimitTally tally;
};

/// The drive of `ticks` ticks from the path's first time on. The encoder counts what lies below the finger
/// (floor), by metres_per_count, from origin_count at origin_m; the drive is asked for from the first tick
/// on.
KernelDrive kernel_drive(const Prepared& prepared, const FingerPath& path, const PrepareOptions& options,
                         std::size_t ticks);

/// The same at another gain, with no limit of amplitude or slew (an energy limit stays): what they are asked
/// to hold, V.
std::vector<double> unlimited_drive(const Prepared& prepared, double gain_m_per_n, const FingerPath& path,
                                    const PrepareOptions& options, std::size_t ticks);

}  // namespace tacto::playback
