// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record.hpp"

#include <memory>
#include <optional>

#include "capture/cli/verbs.hpp"
#include "data-schema/cli/progress.hpp"
#include "data-schema/cli/report.hpp"
#include "firmware-host/sim/sim_parameters.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::Result;

struct Options {
  std::string device;
  RecordRequest request;
  std::optional<double> time_s;
};

void declare_options(CLI::App& app, Options& options) {
  RecordRequest& request = options.request;
  app.add_option("-d,--device", options.device,
                 "The device, as sim:surface=C,speed=50mm/s,seed=1 (keys below)")
      ->required();
  app.add_option("-o,--output", request.name,
                 "The recording's name: NAME.wav and NAME.json; never overwrites")
      ->required();
  cli::add_quantity(app, "--time", options.time_s, Dimension::time, "How long to record")->required();
  app.add_option("--subject", request.subject, "A code for the person, never a name");
  app.add_option("--finger", request.finger, "Which finger, or what slides instead of one");
  app.add_option("--surface", request.surface, "What is touched; what the device says, unless told");
  app.add_option("--notes", request.notes, "Anything else");
}

std::string footer_text() {
  return "\nThe emulated device's keys, with their defaults; a seed gives the same recording on every "
         "machine:\n" +
         firmware_host::sim_parameters_help() +
         "Its finger rests 0.1 s, goes to the end of the surface and back (strokes=2), and then stays; at "
         "its rests and\n"
         "turns it eases the load. 40 mm there and back at 50 mm/s take 1.8 s.";
}

cli::Report row_of(const schema::Channel& channel, const schema::Statistics& statistics) {
  cli::Report row;
  row.add("name", channel.name).add("unit", channel.unit);
  row.add("smallest", statistics.min()).add("largest", statistics.max()).add("rms", statistics.rms());
  return row.add("from", channel.source);
}

std::vector<cli::Report> rows_of(const Recorded& recorded) {
  std::vector<cli::Report> rows;
  for (std::size_t i = 0; i < recorded.statistics.size(); ++i)
    rows.push_back(row_of(recorded.recording.header.channels[i], recorded.statistics[i]));
  return rows;
}

cli::Report report_on(const Recorded& recorded) {
  const schema::RecordingHeader& header = recorded.recording.header;
  const std::string& stem = recorded.recording.stem;
  cli::Report report;
  report.add("device", header.device).add("simulated", header.simulated).add("surface", header.surface);
  report.add("frames", header.frames).add("sample_rate_hz", header.sample_rate_hz);
  report.add("duration_s", static_cast<double>(header.frames) / header.sample_rate_hz);
  report.add("clipped_samples", recorded.counts.clipped).add("lost_frames", recorded.counts.lost_frames);
  report.add("channels", rows_of(recorded));
  if (!header.warnings.empty()) report.add("warnings", header.warnings);
  report.add("files", std::vector{stem + ".wav", stem + ".json"});
  return report.add("next", "tactograph spatial " + stem + " -o " + stem);
}

Result<cli::Report> run(const Options& options) {
  RecordRequest request = options.request;
  request.time_s = options.time_s.value_or(0);
  const auto device = firmware_host::open_device(options.device);
  if (!device) return schema::forward_error(device);
  const Result<Recorded> recorded = [&] {
    cli::Progress progress("recording");
    return record(**device, request, [&](double fraction) { progress.update(fraction); });
  }();
  if (!recorded) return schema::forward_error(recorded);
  for (const std::string& warning : recorded->recording.header.warnings) cli::warn(warning);
  return report_on(*recorded);
}

cli::Action declare(CLI::App& app) {
  auto options = std::make_shared<Options>();
  declare_options(app, *options);
  app.footer(app.get_footer() + "\n" + footer_text());
  return [options] { return run(*options); };
}

}  // namespace

const cli::Verb kRecordVerb{"record", "Record from a device",
                            "tactograph record -d sim:surface=C,speed=50mm/s,seed=1 --time 2s -o grating\n"
                            "  tactograph record -d sim:surface=triangle,period=1mm,depth=0.1mm,load=0.6N "
                            "--time 1s -o figure1 --subject S01",
                            declare};

}  // namespace tacto::capture
