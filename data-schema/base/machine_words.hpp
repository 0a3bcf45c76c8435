// SPDX-License-Identifier: GPL-3.0-or-later
// Describes the machine and the build on which something was measured.
#pragma once

#include <string>

namespace tacto::schema {

/// Processor, compiler and kind of build: the conditions under which measured costs are valid.
std::string machine_words();

}  // namespace tacto::schema
