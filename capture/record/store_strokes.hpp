// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the strokes of a complete recording and stores them in its sidecar, for `info` and `list`.
#pragma once

#include "data-schema/recording/recording.hpp"

namespace tacto::capture {

/// Finds the strokes as `spatial` does (spatial::stroke_figures), and writes the sidecar again if there are
/// any. Errors: of reading; cannot_write. After an error the recording is as it was.
schema::Result<void> store_strokes(schema::Recording& recording);

}  // namespace tacto::capture
