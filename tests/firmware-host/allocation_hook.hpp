// SPDX-License-Identifier: GPL-3.0-or-later
// Counts a thread's heap allocations. The definition replaces operator new, in a source of its own.
#pragma once

namespace tacto::tests {

/// Allocations by this thread since its start.
long allocations_here();

}  // namespace tacto::tests
