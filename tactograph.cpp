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

using namespace tacto;

// The groups of README.
const cli::VerbGroup kGroups[] = {
    {"Record",
     {&firmware_host::kScanVerb, &capture::kDoctorVerb, &capture::kCalibrateVerb, &capture::kRecordVerb,
      &capture::kRecoverVerb, &capture::kListVerb, &capture::kImportVerb}},
    {"See",
     {&spatial::kSpatialVerb, &spatial::kSpectrogramVerb, &spatial::kSheetVerb, &spatial::kFormantsVerb,
      &spatial::kDescribeVerb, &spatial::kCertifyVerb, &spatial::kTransformVerb, &analysis::kSceneVerb,
      &schema::kInfoVerb, &schema::kValidateVerb, &schema::kExportVerb}},
    {"Play",
     {&playback::kRenderVerb, &playback::kPlayVerb, &playback::kCtlVerb, &playback::kSessionVerb,
      &playback::kReplayVerb, &playback::kExplainVerb, &analysis::kLiveVerb}},
    {"Ask",
     {&analysis::kIdentifyVerb, &analysis::kFidelityVerb, &analysis::kCompareVerb, &analysis::kExperimentVerb,
      &analysis::kReportVerb, &analysis::kCorpusVerb, &analysis::kDesignVerb, &analysis::kTradeVerb,
      &analysis::kExtremesVerb, &analysis::kDemoVerb}},
};

constexpr std::array<const cli::HelpTopic*, 2> kTopics = {&firmware_host::kDevicesTopic,
                                                          &firmware_host::kSimTopic};

}  // namespace

int main(int argc, char** argv) {
  schema::open_closed_descriptors();
  return cli::run_command(kGroups, argc, argv, kTopics);
}
