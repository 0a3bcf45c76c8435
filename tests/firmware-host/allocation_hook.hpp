// SPDX-License-Identifier: GPL-3.0-or-later
// Counts what a thread takes from the heap. Its definition replaces operator new, in a unit of its own.
#pragma once

namespace tacto::tests {

/// By this thread, since it began.
long allocations_here();

}  // namespace tacto::tests
