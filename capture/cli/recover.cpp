// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "capture/cli/verbs.hpp"
#include "data-schema/cli/report.hpp"
#include "data-schema/live_recording.hpp"

namespace tacto::capture {
namespace {

schema::Result<cli::Report> run_recover(const std::string& name) {
  const auto recovered = schema::recover_recording(name);
  if (!recovered) return schema::forward_error(recovered);
  const schema::RecordingHeader& header = recovered->recording.header;
  const std::string& stem = recovered->recording.stem;
  cli::Report report;
  report.add("recording", stem).add("frames", header.frames);
  report.add("duration_s", static_cast<double>(header.frames) / header.sample_rate_hz);
  report.add("gaps", header.gaps.size())
      .add("marks", header.marks.size())
      .add("faults", header.faults.size());
  if (!recovered->notes.empty()) report.add("notes", recovered->notes);
  report.add("files", std::vector{stem + ".wav", stem + ".json"});
  return report.add("next", "tactograph validate " + stem);
}

cli::Action declare_recover(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  app.add_option("FILE", *name, "The recording that was broken off, by its stem or one of its files")
      ->required();
  return [name] { return run_recover(*name); };
}

}  // namespace

const cli::Verb kRecoverVerb{"recover", "Make a recording whole that was broken off: crash, kill, power cut",
                             "tactograph recover oak", declare_recover};

}  // namespace tacto::capture
