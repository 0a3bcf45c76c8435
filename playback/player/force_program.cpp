// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/force_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/core/firmware/drive_supervisor.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "playback/player/placed_textures.hpp"
#include "playback/player/program.hpp"
#include "playback/player/served_folder.hpp"
#include "playback/prepare/scene/scene_device.hpp"

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

// The shortest decimal number that gives this value in single precision: 1e-5, not 9.99999975e-6.
double decimal_of(float value) {
  return std::stod(fmt::format("{}", value));
}

Result<wire::ForceLimits> limits_for(const ForceRequest& request, const schema::Device& device,
                                     const wire::Axes& own, double rate_hz) {
  wire::ForceLimits limits;
  double finest_m = INFINITY;
  for (std::uint8_t i = 0; i < own.count; ++i) {
    limits.axis_peak_n[i] = own.axes[i].peak_n;
    limits.axis_continuous_n[i] = own.axes[i].continuous_n;
    finest_m = std::min(finest_m, double{own.axes[i].metres_per_count});
  }
  limits.peak_n = own.peak_n, limits.continuous_n = own.continuous_n;
  limits.slew_n_per_s = own.slew_n_per_s;
  limits.onset_s = static_cast<float>(request.onset_s);
  const float longest_s = core::kLongestReleaseS - own.peak_n / own.slew_n_per_s;
  if (!(longest_s >= 0))
    return fail(ErrorKind::unsuitable,
                fmt::format("its force needs {:g} s to fall to zero", double{own.peak_n / own.slew_n_per_s}),
                device.name,
                fmt::format("at most {:g} s are safe: raise slew_n_per_s of the device",
                            double{core::kLongestReleaseS}));
  limits.release_s = std::min(static_cast<float>(schema::kReleaseS), longest_s);
  limits.watchdog_ms = request.watchdog_ms;
  limits.counts_per_tick =
      static_cast<std::uint32_t>(std::clamp(kFastestHandMps / finest_m / rate_hz, 1.0, 1e9));
  return limits;
}

schema::SessionForces forces_of(const wire::Axes& axes) {
  schema::SessionForces forces{double{axes.peak_n}, double{axes.continuous_n}, double{axes.slew_n_per_s}, {}};
  for (std::uint8_t i = 0; i < axes.count; ++i) {
    const wire::Axis& axis = axes.axes[i];
    schema::DeviceAxis row;
    row.name = firmware_host::name_of(axis.along);
    row.encoder_step_m = decimal_of(axis.metres_per_count);
    row.travel_from_m = axis.from_m, row.travel_to_m = axis.to_m;
    row.peak_force_n = double{axis.peak_n}, row.continuous_force_n = double{axis.continuous_n};
    forces.axes.push_back(row);
  }
  return forces;
}

schema::SessionHeader header_of(const std::string& scene_file, const wire::Axes& own, double rate_hz) {
  schema::SessionHeader header;
  header.created = schema::creation_time();
  header.creator = kCreator;
  header.build = __VERSION__;
  header.rate_hz = rate_hz;
  header.scene_file = scene_file;
  header.scene_sha256 = schema::sha256_of_file(scene_file).value_or("");
  header.forces = forces_of(own);
  header.metres_per_count = header.forces->axes.front().encoder_step_m;
  return header;
}

}  // namespace

schema::Device device_of(const firmware_host::Description& description) {
  schema::SessionForces own = forces_of(*description.axes);
  schema::Device device;
  device.name = description.welcome.name;
  device.axes = std::move(own.axes);
  device.peak_force_n = own.peak_n, device.continuous_force_n = own.continuous_n;
  device.slew_n_per_s = own.slew_n_per_s;
  device.rates_hz = {1e-3 * description.welcome.most_rate_millihertz};
  return device;
}

Result<ForceProgram> make_force_program(const ForceRequest& request, const schema::Device& device,
                                        const std::optional<schema::Hand>& hand, const wire::Axes& own) {
  if (!names_a_scene(request.file))
    return fail(ErrorKind::unsuitable, "is a texture; a force device plays the force patches of a scene",
                request.file, "name a scene, or play on a device with a tray");
  TACTO_TRY(check_onset(request.onset_s));
  const auto served = request.only_in ? served_file(*request.only_in, request.file) : request.file;
  TACTO_TRY(served);
  const std::string file = schema::scene_path(*served);
  auto scene = schema::read_scene(file);
  TACTO_TRY(scene);
  const auto setup = force_setup_of(device, request.rate_hz);
  TACTO_TRY(setup);
  const double rate_hz = request.rate_hz.value_or(device.rates_hz.back());
  auto prepared = prepare_scene(std::move(*scene), file, device, rate_hz, hand);
  TACTO_TRY(prepared);
  std::vector<HeldLayer> held;
  if (request.hold_stable) {
    auto scaled = hold_stable(*prepared, device, rate_hz, hand);
    TACTO_TRY(scaled);
    held = std::move(*scaled);
  }
  const auto limits = limits_for(request, device, own, rate_hz);
  TACTO_TRY(limits);
  if (prepared->room_bytes() > own.scene_bytes)
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the scene needs {} bytes, the device has {}", prepared->room_bytes(), own.scene_bytes),
        file, prepared->remedy_for(own.scene_bytes));
  auto notes = limits_of_device(*prepared, device, *setup, hand);
  schema::SessionHeader header = header_of(file, own, rate_hz);
  for (const schema::Piece& piece : prepared->pieces)
    if (piece.slide) header.forces->slides.push_back(piece.name);
  return ForceProgram{std::move(*prepared), *limits, std::move(header), std::move(notes), std::move(held)};
}

Result<void> upload_scene(firmware_host::Client& client, const ForceProgram& forces) {
  TACTO_TRY(client.command(forces.limits));
  wire::ScenePart part{};
  part.bytes = static_cast<std::uint32_t>(forces.scene.bytes());
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(forces.scene.words.data());
  for (; part.first < part.bytes; part.first += part.count) {
    part.count =
        static_cast<std::uint16_t>(std::min<std::size_t>(wire::kMaxScenePart, part.bytes - part.first));
    std::copy_n(bytes + part.first, part.count, part.data);
    TACTO_TRY(client.command(part));
  }
  return {};
}

}  // namespace tacto::playback
