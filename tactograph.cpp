// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of the verbs and of the additional topics of `help`.
#include <array>

#include "analysis/cli/verbs.hpp"
#include "capture/cli/verbs.hpp"
#include "data-schema/base/standard_descriptors.hpp"
#include "data-schema/cli/verbs.hpp"
#include "data-schema/command/command.hpp"
#include "firmware-host/cli/verbs.hpp"
#include "playback/cli/verbs.hpp"
#include "spatial/cli/verbs.hpp"

namespace {

// In the order of use: get data, inspect them, make textures, show them, play them.
constexpr std::array<const tacto::cli::Verb*, 28> kVerbs = {
    &tacto::firmware_host::kScanVerb, &tacto::capture::kDoctorVerb,      &tacto::capture::kCalibrateVerb,
    &tacto::capture::kImportVerb,     &tacto::capture::kRecordVerb,      &tacto::capture::kRecoverVerb,
    &tacto::capture::kListVerb,       &tacto::schema::kInfoVerb,         &tacto::schema::kValidateVerb,
    &tacto::spatial::kSpatialVerb,    &tacto::spatial::kSpectrogramVerb, &tacto::spatial::kSheetVerb,
    &tacto::spatial::kFormantsVerb,   &tacto::spatial::kDescribeVerb,    &tacto::spatial::kCertifyVerb,
    &tacto::playback::kRenderVerb,    &tacto::playback::kExplainVerb,    &tacto::playback::kPlayVerb,
    &tacto::playback::kCtlVerb,       &tacto::playback::kSessionVerb,    &tacto::playback::kReplayVerb,
    &tacto::analysis::kCompareVerb,   &tacto::analysis::kFidelityVerb,   &tacto::analysis::kReportVerb,
    &tacto::analysis::kExtremesVerb,  &tacto::analysis::kIdentifyVerb,   &tacto::analysis::kTradeVerb,
    &tacto::analysis::kDemoVerb,
};

constexpr std::array<const tacto::cli::HelpTopic*, 1> kTopics = {&tacto::firmware_host::kSimTopic};

}  // namespace

int main(int argc, char** argv) {
  tacto::schema::open_closed_descriptors();
  return tacto::cli::run_command(kVerbs, argc, argv, kTopics);
}
