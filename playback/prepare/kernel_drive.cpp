// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/kernel_drive.hpp"

#include <cmath>

namespace tacto::playback {
namespace {

constexpr float kNoLimit = 1e9F;

KernelDrive driven(const core::KernelSetup& setup, float gain_m_per_n, const FingerPath& path,
                   const PrepareOptions& options, std::size_t ticks) {
  core::TickKernel kernel;
  kernel.set(setup);
  KernelDrive drive;
  for (const double position_m : positions_along(path, options.rate_hz, ticks)) {
    const double counts = std::floor((position_m - options.origin_m) / options.metres_per_count);
    const auto count = options.origin_count + static_cast<std::int32_t>(counts);
    const core::TickOutput output = kernel.tick({count, gain_m_per_n, true, core::kNoForce});
    drive.drive_v.push_back(output.drive_v);
    drive.tally.add(output);
  }
  return drive;
}

}  // namespace

KernelDrive kernel_drive(const Prepared& prepared, const FingerPath& path, const PrepareOptions& options,
                         std::size_t ticks) {
  return driven(prepared.setup(), prepared.gain_m_per_n, path, options, ticks);
}

std::vector<double> unlimited_drive(const Prepared& prepared, double gain_m_per_n, const FingerPath& path,
                                    const PrepareOptions& options, std::size_t ticks) {
  core::KernelSetup setup = prepared.setup();
  setup.limits.drive_v = setup.limits.slew_v_per_s = kNoLimit;
  return driven(setup, static_cast<float>(gain_m_per_n), path, options, ticks).drive_v;
}

}  // namespace tacto::playback
