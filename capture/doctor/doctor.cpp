// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/doctor/doctor.hpp"
#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/link/client.hpp"
#include "firmware-host/open_device.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tacto::capture {
namespace {

using firmware_host::Capabilities;
using firmware_host::Device;

// The assumed data rate if there is no device: the paper's sample rate, four channels of 32 bits.
constexpr double kUsualBytesPerS = 10e3 * 4 * 4;

double bytes_per_s(const Capabilities& capabilities) {
  return capabilities.sample_rate_hz * static_cast<double>(capabilities.channels.size()) * 4;
}

Check device_seen(const Capabilities& said) {
  return {"device",
          Health::works,
          fmt::format("{}, serial {}{}", said.name, said.serial, said.simulated.empty() ? "" : ", emulated"),
          {}};
}

Check device_missing(const schema::Error& why) {
  if (is_denied(why)) return {"device", Health::works, "connected", {}};
  return {"device", Health::fails, schema::message({why.kind, why.what, why.where, {}}),
          why.remedy.empty() ? "plug it in; 'tactograph scan' lists connected devices" : why.remedy,
          why.kind};
}

// A device without a wire, as a recording, has the host's version.
unsigned minor_of(Device& device) {
  const firmware_host::Client* const client = device.conversation();
  return client != nullptr ? client->description().welcome.minor : wire::kProtocolMinor;
}

Check skipped(const char* name) {
  return {name, Health::skipped, "requires a device", {}};
}

void check_device(Device& device, const DoctorRequest& request, std::vector<Check>& checks) {
  const Capabilities& said = device.capabilities();
  checks.push_back(device_seen(said));
  checks.push_back({"permission", Health::works, "access is permitted", {}});
  checks.push_back(check_firmware(said, minor_of(device), wire::kProtocolMinor));
  checks.push_back(check_round_trip(device, request.questions));
  checks.push_back(check_real_time(request.root));
  checks.push_back(check_disk(request.folder, bytes_per_s(said)));
  checks.push_back(check_temporary_files(request.folder));
  checks.push_back(check_calibration(said, request));
}

void check_without_device(const schema::Error& why, const DoctorRequest& request,
                          std::vector<Check>& checks) {
  checks.push_back(device_missing(why));
  checks.push_back(check_permission(why, request.root));
  checks.push_back(skipped("firmware"));
  checks.push_back(skipped("round trip"));
  checks.push_back(check_real_time(request.root));
  checks.push_back(check_disk(request.folder, kUsualBytesPerS));
  checks.push_back(check_temporary_files(request.folder));
  checks.push_back(skipped("calibration"));
}

std::string next_of(const Diagnosis& diagnosis, const DoctorRequest& request, bool in_real_time) {
  if (const Check* const first_failure = diagnosis.first_failure())
    return first_failure->name == "device" && request.device.starts_with("usb:")
               ? "plug it in, or use the emulated device: tactograph doctor -d sim:surface=C"
               : first_failure->remedy;
  const auto calibration = std::ranges::find(diagnosis.checks, "calibration", &Check::name);
  if (calibration->health == Health::warns) return calibration->remedy;
  return fmt::format("tactograph record -d {} -o oak{}", request.device, in_real_time ? "" : " --time 2s");
}

}  // namespace

const Check* Diagnosis::first_failure() const {
  const auto found = std::ranges::find(checks, Health::fails, &Check::health);
  return found == checks.end() ? nullptr : &*found;
}

Diagnosis examine(const DoctorRequest& request) {
  Diagnosis diagnosis;
  const auto device = firmware_host::open_device(request.device);
  if (device)
    check_device(**device, request, diagnosis.checks);
  else
    check_without_device(device.error(), request, diagnosis.checks);
  diagnosis.next = next_of(diagnosis, request, !device || (*device)->is_real_time());
  return diagnosis;
}

}  // namespace tacto::capture
