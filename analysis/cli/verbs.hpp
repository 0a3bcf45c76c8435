// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of this folder, for the table in tactograph.cpp.
#pragma once

#include "data-schema/command/verb.hpp"

namespace tacto::analysis {

extern const cli::Verb kCompareVerb;
extern const cli::Verb kCorpusVerb;
extern const cli::Verb kExperimentVerb;
extern const cli::Verb kFidelityVerb;
extern const cli::Verb kDemoVerb;
extern const cli::Verb kDesignVerb;
extern const cli::Verb kExtremesVerb;
extern const cli::Verb kReportVerb;
extern const cli::Verb kSceneVerb;
extern const cli::Verb kIdentifyVerb;
extern const cli::Verb kTradeVerb;
extern const cli::Verb kLiveVerb;

}  // namespace tacto::analysis
