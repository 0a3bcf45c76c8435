// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>
#include <utility>
#include <vector>

#include "capture/cli/calibrate_parts.hpp"
#include "capture/cli/verbs.hpp"

namespace tacto::capture {
namespace {

struct Way {
  const char *name, *summary;
  cli::Action (*declare)(CLI::App& app);
};

constexpr Way kWays[] = {
    {"tare", "Without any contact: offset, noise floor and mains of each force channel", declare_tare},
    {"force", "Force scale: by known weights on a load cell, or of the piezo against a load cell",
     declare_force},
    {"encoder", "Position scale, by a known travel", declare_encoder},
};

cli::Action declare_calibrate(CLI::App& app) {
  auto actions = std::make_shared<std::vector<std::pair<CLI::App*, cli::Action>>>();
  for (const Way& way : kWays) {
    CLI::App* const one = app.add_subcommand(way.name, way.summary);
    actions->emplace_back(one, way.declare(*one));
  }
  app.require_subcommand(1);
  return [actions]() -> schema::Result<cli::Report> {
    for (const auto& [one, action] : *actions)
      if (one->parsed()) return action();
    return schema::fail(schema::ErrorKind::usage, "the calibration is missing", "calibrate",
                        "give tare, force or encoder");
  };
}

}  // namespace

const cli::Verb kCalibrateVerb{
    "calibrate", "Measure a device's offsets, scales and noise, and store them for its recordings",
    "tactograph calibrate tare\n"
    "  tactograph calibrate force --mass 0g --mass 100g --mass 200g\n"
    "  tactograph calibrate force --reference net_force --time 20s\n"
    "  tactograph calibrate encoder --travel 50mm --repeats 6\n"
    "  tactograph calibrate force --channel net_force --mass 0g=empty --mass 100g=loaded@1s..3s",
    declare_calibrate};

}  // namespace tacto::capture
