// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/fidelity/emulated_trays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "data-schema/version.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"
#include "firmware-host/sim/physics/tray_mechanics.hpp"

namespace tacto::analysis {
namespace {

using firmware_host::TrayPhysics;

constexpr double kPaperHysteresis = 0.16;

bool names_physics(const TrayPhysics& physics) {
  return physics.second_mode || physics.finger_load || physics.hysteresis > 0 ||
         physics.reconstruction_cutoff_hz;
}

firmware_host::SecondMode usual_mode(const schema::Transducer& transducer) {
  firmware_host::SecondMode mode;
  mode.frequency_hz =
      std::max(mode.frequency_hz, 1.2 * firmware_host::least_second_mode_hz(transducer, mode));
  return mode;
}

std::vector<Tray> usual_trays(const schema::Transducer& transducer) {
  TrayPhysics hysteresis, mode, load, all;
  hysteresis.hysteresis = all.hysteresis = kPaperHysteresis;
  mode.second_mode = all.second_mode = usual_mode(transducer);
  load.finger_load.emplace();
  all.finger_load.emplace();
  return {{"ideal", {}},
          {fmt::format("hysteresis {:g} %", 100 * kPaperHysteresis), hysteresis},
          {fmt::format("mode at {:.0f} Hz", mode.second_mode->frequency_hz), mode},
          {"finger's load", load},
          {"all three", all}};
}

}  // namespace

schema::Result<Trays> trays_of(const std::string& uri) {
  constexpr std::string_view kScheme = "sim:";
  const auto parameters = firmware_host::parse_sim_parameters(std::string_view(uri).substr(kScheme.size()));
  TACTO_TRY(parameters);
  auto transducer = schema::read_transducer(parameters->transducer);
  TACTO_TRY(transducer);
  Trays trays{std::move(*transducer), fmt::format("by the emulated device of {}", kCreator), {}};
  const TrayPhysics named = parameters->tray();
  trays.trays =
      names_physics(named) ? std::vector<Tray>{{"defined by " + uri, named}} : usual_trays(trays.transducer);
  return trays;
}

}  // namespace tacto::analysis
