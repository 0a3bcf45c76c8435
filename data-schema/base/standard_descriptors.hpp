// SPDX-License-Identifier: GPL-3.0-or-later
// Makes sure that standard input, output and error are open.
#pragma once

namespace tacto::schema {

/// Opens /dev/null as each of the descriptors 0 to 2 that is closed. Otherwise the next file to be opened, a
/// recording for example, gets the number, and printed text goes into it. Call it first in main().
void open_closed_descriptors() noexcept;

}  // namespace tacto::schema
