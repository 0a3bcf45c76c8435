// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel's half of render().
#pragma once

#include "data-schema/base/error.hpp"
#include "playback/render/reference/exact_drive.hpp"
#include "playback/render/render_job.hpp"

namespace tacto::playback {

/// Errors: unsuitable, for a path that goes beyond what the kernel's encoder counts.
schema::Result<void> check_counts(const FingerPath& path, const RenderOptions& options);

/// The kernel's drive along the job's path, and what it moves; tells in `rendering` what its limits took and
/// what its budget chose. Errors: as prepare(), decide(); unsuitable, for a drive that its limits cut (unless
/// over_limit allows it) or that moves the tray beyond its own: by which peak, when, and the largest gain
/// that fits. The kernel holds no displacement: that is never clipped. The drive's end is no step to rest:
/// whoever plays goes on.
schema::Result<ExactDrive> kernels_drive(Rendering& rendering, const RenderJob& job);

}  // namespace tacto::playback
