// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/cli/calibrate_parts.hpp"
#include "capture/cli/verbs.hpp"

namespace tacto::capture {
namespace {

constexpr cli::VerbPart kWays[] = {
    {"tare", "Without any contact: offset, noise floor and mains of each force channel", declare_tare},
    {"force", "Force scale: by known weights on a load cell, or of the piezo against a load cell",
     declare_force},
    {"encoder", "Position scale, by a known travel", declare_encoder},
};

cli::Action declare_calibrate(CLI::App& app) {
  return cli::declare_parts(app, kWays);
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
