// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/base/quantity.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/wiring/wiring.hpp"

namespace tacto::schema {

Result<cli::Report> describe_wiring(const std::string& path) {
  const auto wiring = read_wiring(path);
  TACTO_TRY(wiring);
  warn_of_unknown(path, *wiring);
  cli::Report report = report_of(FileKind::wiring, path, "");
  report.add("name", wiring->name).add("card", wiring->card).add("rate_hz", wiring->rate_hz);
  std::vector<cli::Report> inputs;
  for (const WiredInput& input : wiring->inputs) {
    cli::Report row;
    row.add("input", input.input).add("channel", input.name).add("reference", input.reference);
    row.add("range_from_v", input.range_from_v).add("range_to_v", input.range_to_v);
    const auto unit = si_symbol(quantity_named(input.quantity)->dimension);
    const std::string at_zero =
        input.at_zero_volt == 0 ? "" : fmt::format(", {:g} {} at 0 V", input.at_zero_volt, unit);
    row.add("sensor", input.per_volt ? fmt::format("{:g} {}/V{}", *input.per_volt, unit, at_zero)
                                     : wiring->transducer_name + ", its output voltage");
    inputs.push_back(std::move(row));
  }
  report.add("inputs", std::move(inputs));
  add_text(report, "notes", wiring->notes);
  return report;
}

}  // namespace tacto::schema
