// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of this folder, for the table in tactograph.cpp.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::schema {

extern const cli::Verb kExportVerb;
extern const cli::Verb kInfoVerb;
extern const cli::Verb kValidateVerb;

}  // namespace tacto::schema
