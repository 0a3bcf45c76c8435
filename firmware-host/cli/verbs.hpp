// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of this folder, for the table in tactograph.cpp.
#pragma once

#include "data-schema/command/help.hpp"
#include "data-schema/command/verb.hpp"

namespace tacto::firmware_host {

extern const cli::Verb kScanVerb;
extern const cli::HelpTopic kDevicesTopic, kSimTopic;

}  // namespace tacto::firmware_host
