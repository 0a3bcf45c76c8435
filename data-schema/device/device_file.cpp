// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/device/device.hpp"
#include "data-schema/json/json_document.hpp"
#include "data-schema/json/known_members.hpp"
#include "data-schema/json/named_document.hpp"

namespace tacto::schema {
namespace {

constexpr std::string_view kDeviceKind = "device";

struct Mechanics {
  const char* name;
  double DeviceAxis::*member;
  double assumed;
};

// The assumed values are those of a small arm. Mass, Coulomb friction and step: datasheet of the PHANToM
// Premium 1.0 (inertia below 75 g, backdrive friction 0.04 N, resolution 0.03 mm); the viscous friction is
// our choice, small because it makes a device stable.
constexpr Mechanics kMechanics[] = {
    {"mass_kg", &DeviceAxis::mass_kg, 0.075},
    {"viscous_n_s_per_m", &DeviceAxis::viscous_n_s_per_m, 0.1},
    {"coulomb_n", &DeviceAxis::coulomb_n, 0.04},
    {"encoder_step_m", &DeviceAxis::encoder_step_m, 3e-5},
};

DeviceAxis axis_from(const Json& body) {
  DeviceAxis axis;
  axis.name = body["name"];
  for (const auto& [name, member, assumed] : kMechanics) axis.*member = number_or(body, name, assumed);
  axis.travel_from_m = body["travel_m"][0];
  axis.travel_to_m = body["travel_m"][1];
  axis.peak_force_n = body["peak_force_n"];
  axis.continuous_force_n = body["continuous_force_n"];
  return axis;
}

// The mechanics that the axes of a file leave out.
std::vector<AssumedNumber> left_out(const Json& axes) {
  std::vector<AssumedNumber> all;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const auto& [name, member, assumed] : kMechanics)
      if (!axes[i].contains(name)) all.push_back({fmt::format("axes/{}", i), name, assumed});
  return all;
}

Json axis_body(const DeviceAxis& axis) {
  return {{"name", axis.name},
          {"mass_kg", axis.mass_kg},
          {"viscous_n_s_per_m", axis.viscous_n_s_per_m},
          {"coulomb_n", axis.coulomb_n},
          {"encoder_step_m", axis.encoder_step_m},
          {"travel_m", {axis.travel_from_m, axis.travel_to_m}},
          {"peak_force_n", axis.peak_force_n},
          {"continuous_force_n", axis.continuous_force_n}};
}

Device device_from(const Document& document) {
  const Json& body = document.body;
  Device device;
  device.name = body["name"];
  for (const Json& axis : body["axes"]) device.axes.push_back(axis_from(axis));
  device.peak_force_n = body["peak_force_n"];
  device.continuous_force_n = body["continuous_force_n"];
  device.slew_n_per_s = body["slew_n_per_s"];
  device.delay_s = body["delay_s"];
  device.rates_hz = body["rates_hz"].get<std::vector<double>>();
  device.transducer = text_or(body, "transducer");
  device.source = text_or(body, "source");
  device.notes = text_or(body, "notes");
  keep_unknown(document, device);
  return device;
}

Json device_body(const Device& device) {
  Json body = Json::object();
  put_text(body, "version", device.newer_version);
  body["name"] = device.name;
  body["axes"] = Json::array();
  for (const DeviceAxis& axis : device.axes) body["axes"].push_back(axis_body(axis));
  body["peak_force_n"] = device.peak_force_n;
  body["continuous_force_n"] = device.continuous_force_n;
  body["slew_n_per_s"] = device.slew_n_per_s;
  body["delay_s"] = device.delay_s;
  body["rates_hz"] = device.rates_hz;
  put_text(body, "transducer", device.transducer);
  put_text(body, "source", device.source);
  put_text(body, "notes", device.notes);
  return body;
}

}  // namespace

std::vector<std::string_view> device_preset_names() {
  return preset_names(kDeviceKind);
}

Result<Device> read_device(const std::string& name, std::vector<AssumedNumber>* assumed) {
  const auto found = open_named(kDeviceKind, name);
  TACTO_TRY(found);
  TACTO_TRY(check_document_known(found->document, kDeviceKind, found->where));
  const auto missing = left_out(found->document.body["axes"]);
  if (assumed != nullptr)
    *assumed = missing;
  else if (!missing.empty())
    return fail(ErrorKind::malformed, fmt::format("Missing required property '{}'", missing.front().member),
                fmt::format("{}#/{}", found->where, missing.front().place), "`design --assume` fills it");
  Device device = device_from(found->document);
  TACTO_TRY(check_device(device, found->where));
  return device;
}

Result<void> write_device(const std::string& stem, const Device& device) {
  TACTO_TRY(check_device(device, path_of_kind(kDeviceKind, stem)));
  return write_named(kDeviceKind, stem, device_body(device), device.extra_json);
}

}  // namespace tacto::schema
