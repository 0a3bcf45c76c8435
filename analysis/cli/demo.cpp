// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <memory>

#include "analysis/cli/verbs.hpp"
#include "analysis/demo/demo.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/terminal.hpp"

namespace tacto::analysis {
namespace {

struct DemoOptions {
  std::string folder = "demo";
};

cli::Report row_of(const DemoSurface& surface) {
  cli::Report row;
  row.add("surface", surface.surface)
      .add("record_speed_mps", surface.record_speed_mps)
      .add("force_rms_n", surface.force_rms_n)
      .add("peak_frequency_per_m", surface.peak_frequency_per_m)
      .add("replay_speed_mps", surface.replay_speed_mps)
      .add("gain_m_per_n", surface.gain_m_per_n)
      .add("target_rms_m", surface.target_rms_m)
      .add("drive_peak_v", surface.drive_peak_v)
      .add("error_rms_m", surface.error_rms_m)
      .add("error_db", surface.error_db)
      .add("delay_s", surface.delay_s);
  return row;
}

schema::Result<cli::Report> demonstrate(const DemoOptions& options) {
  cli::Progress progress("demo");
  const auto summary = run_demo(options.folder, [&](double fraction) { progress.update(fraction); });
  TACTO_TRY(summary);
  std::vector<cli::Report> rows;
  for (const DemoSurface& surface : summary->surfaces) rows.push_back(row_of(surface));
  cli::Report report;
  report.add("simulated", summary->simulated).add("surfaces", std::move(rows)).add("page", summary->page);
  report.add("recording", summary->recording);
  report.add("next",
             fmt::format("open {} in a browser; then: tactograph spatial {} --list (analysis/GUIDE.md)",
                         summary->page, cli::shell_word(summary->recording)));
  return report;
}

cli::Action declare_demo(CLI::App& app) {
  auto options = std::make_shared<DemoOptions>();
  app.add_option("-o,--output", options->folder,
                 "Output folder; the files of an earlier demo there are replaced")
      ->type_name("DIR");
  return [options] { return demonstrate(*options); };
}

}  // namespace

const cli::Verb kDemoVerb{"demo",
                          "Record five emulated surfaces, make textures and pictures, replay them, and write "
                          "one page about it; and "
                          "make a recording to work on",
                          "tactograph demo -o demo", declare_demo};

}  // namespace tacto::analysis
