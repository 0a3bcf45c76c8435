// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/scan.hpp"

#include "data-schema/report/report.hpp"
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

// A serial port on which no device answers may belong to anything.
bool is_real(const FoundDevice& found) {
  if (found.uri.starts_with("tty:")) return found.said.has_value();
  return found.uri.starts_with("usb:") && found.uri != "usb:";
}

// `record` without -d takes the only device on USB.
std::string record_from(const std::string& uri) {
  if (uri.empty()) return "tactograph record -d sim:surface=C --time 2s -o grating";
  return uri.starts_with("usb:") ? "tactograph record -o oak" : "tactograph record -d " + uri + " -o oak";
}

schema::Result<cli::Report> run_scan() {
  std::vector<cli::Report> rows;
  std::size_t real = 0;
  std::string ready;
  for (const FoundDevice& found : scan_devices()) {
    rows.push_back(row_of(found));
    real += is_real(found) ? 1 : 0;
    if (is_real(found) && found.said && ready.empty()) ready = found.uri;
  }
  cli::Report report;
  report.add("real_devices", real).add("devices", std::move(rows));
  return report.add("next", record_from(ready));
}

cli::Action declare_scan(CLI::App& app) {
  app.footer(app.get_footer() +
             "\nDevices on USB of any maker are found by their interface and identified by serial number or "
             "port. The USB serial ports are "
             "listed, too, with the reason where no device answers (it is asked for 2 s). A recording is "
             "also a device: replay:FILE, or replay:FILE,paced=1.");
  return [] { return run_scan(); };
}

}  // namespace

const cli::Verb kScanVerb{"scan", "List available devices, including emulated ones", "tactograph scan",
                          declare_scan};

}  // namespace tacto::firmware_host
