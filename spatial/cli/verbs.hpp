// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of this folder, for the table in tactograph.cpp.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::spatial {

extern const cli::Verb kSpatialVerb;
extern const cli::Verb kSpectrogramVerb;
extern const cli::Verb kSheetVerb;
extern const cli::Verb kFormantsVerb;
extern const cli::Verb kDescribeVerb;
extern const cli::Verb kCertifyVerb;
extern const cli::Verb kTransformVerb;

}  // namespace tacto::spatial
