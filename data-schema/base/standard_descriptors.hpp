// SPDX-License-Identifier: GPL-3.0-or-later
// Standard input, output and error are there, whoever started the program.
#pragma once

namespace tacto::schema {

/// Opens /dev/null as each of the descriptors 0 to 2 that is closed. Without it the next file to be opened,
/// a recording say, takes the number, and what is printed goes into it. First thing in main().
void open_closed_descriptors() noexcept;

}  // namespace tacto::schema
