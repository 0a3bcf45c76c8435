// SPDX-License-Identifier: GPL-3.0-or-later
// The part of render() that uses the kernel.
#pragma once

#include "data-schema/base/error.hpp"
#include "playback/render/reference/exact_drive.hpp"
#include "playback/render/render_job.hpp"

namespace tacto::playback {

/// Errors: unsuitable, for a path beyond the range of the kernel's encoder.
schema::Result<void> check_counts(const FingerPath& path, const RenderOptions& options);

/// The kernel's drive along the job's path, and the displacement; writes to `rendering` what the limits
/// removed and what the budget chose. Errors: as prepare(), decide(); unsuitable, for a drive that its limits
/// clip (unless over_limit allows it) or a displacement beyond its limit: which peak, when, and the largest
/// gain that fits. The kernel does not limit displacement, so that is never clipped. The end of the drive is
/// not counted as a step to rest, because a playback continues.
schema::Result<ExactDrive> kernels_drive(Rendering& rendering, const RenderJob& job);

}  // namespace tacto::playback
