// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/scan.hpp"

#include "data-schema/cli/report.hpp"
#include "firmware-host/cli/verbs.hpp"

namespace tacto::firmware_host {
namespace {

cli::Report row_of(const FoundDevice& found) {
  cli::Report row;
  row.add("uri", found.uri);
  if (!found.said) return row.add("problem", schema::message(found.said.error()));
  const Capabilities& said = *found.said;
  row.add("name", said.name).add("serial", said.serial).add("firmware", said.firmware);
  row.add("simulated", !said.simulated.empty()).add("channels", said.channels.size());
  return row.add("sample_rate_hz", said.sample_rate_hz).add("surface", said.surface);
}

schema::Result<cli::Report> run() {
  std::vector<cli::Report> rows;
  for (const FoundDevice& found : scan_devices()) rows.push_back(row_of(found));
  cli::Report report;
  report.add("real_devices", 0).add("devices", std::move(rows));
  return report.add("next", "tactograph record -d sim:surface=C --time 2s -o grating");
}

cli::Action declare(CLI::App& app) {
  app.footer(app.get_footer() +
             "\nReal devices are not looked for yet. A recording is a device too: replay:FILE, or "
             "replay:FILE,paced=1.");
  return [] { return run(); };
}

}  // namespace

const cli::Verb kScanVerb{"scan", "List the devices that are there, emulated ones too", "tactograph scan",
                          declare};

}  // namespace tacto::firmware_host
