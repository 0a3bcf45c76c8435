// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/kernel_drive.hpp"

#include <cmath>

namespace tacto::playback {

KernelDrive kernel_drive(const Prepared& prepared, const FingerPath& path, const PrepareOptions& options,
                         std::size_t ticks) {
  core::TickKernel kernel;
  kernel.set(prepared.setup());
  KernelDrive drive;
  for (const double position_m : positions_along(path, options.rate_hz, ticks)) {
    const double counts = std::floor((position_m - options.origin_m) / options.metres_per_count);
    const auto count = options.origin_count + static_cast<std::int32_t>(counts);
    const core::TickOutput output = kernel.tick({count, prepared.gain_m_per_n, true, core::kNoForce});
    drive.drive_v.push_back(output.drive_v);
    drive.tally.add(output);
  }
  return drive;
}

}  // namespace tacto::playback
