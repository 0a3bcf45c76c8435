// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "analysis/cli/verbs.hpp"
#include "data-schema/command/stop_signals.hpp"

namespace tacto::analysis {
namespace {

schema::Result<cli::Report> serve_live(const LiveOptions& options) {
  const cli::StopSignals signals;
  const auto announce = [](const std::string& address) {
    fmt::print(stderr, "open this address in a browser on this computer (Ctrl-C ends):\n{}\n", address);
    std::fflush(stderr);
  };
  const auto summary = run_live(options, announce, [&] { return signals.stop_asked(); });
  TACTO_TRY(summary);
  cli::Report report;
  report.add("address", summary->address).add("sessions_kept", summary->kept);
  return report;
}

cli::Action declare_live(CLI::App& app) {
  auto options = std::make_shared<LiveOptions>();
  app.add_option("folder", options->folder,
                 "Folder with textures, scenes and recordings; sessions, textures and recordings that you "
                 "keep, and pages "
                 "of jobs, are written there");
  app.add_option("--transducer", options->transducer,
                 "A preset or NAME.transducer.json: the tray that is modelled")
      ->capture_default_str();
  app.add_option("--port", options->port, "Port on 127.0.0.1; default: a free one from 7230 on")
      ->check(CLI::Range(1, 65535));
  app.add_option("--socket", options->socket, "Socket of the daemon tactographd, for the page of the device")
      ->capture_default_str();
  app.add_option("-d,--device", options->device,
                 "What the page of the device records from, as of record: usb:serial=XYZ, tty:, "
                 "sim:surface=C,paced=1; the daemon must not have it open")
      ->capture_default_str();
  return [options] { return serve_live(*options); };
}

}  // namespace

const cli::Verb kLiveVerb{
    "live", "Serve a page on which textures are played with mouse, touch or keys, heard and seen",
    "tactograph live demo", declare_live};

}  // namespace tacto::analysis
