// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace tacto::schema {

/// Processor, compiler and kind of build: what costs that were measured hold for.
std::string machine_words();

}  // namespace tacto::schema
