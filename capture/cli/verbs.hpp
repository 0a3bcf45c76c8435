// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of this folder, for the table in tactograph.cpp.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::capture {

extern const cli::Verb kImportVerb;
extern const cli::Verb kRecordVerb;
extern const cli::Verb kRecoverVerb;
extern const cli::Verb kListVerb;
extern const cli::Verb kCalibrateVerb;
extern const cli::Verb kDoctorVerb;

}  // namespace tacto::capture
