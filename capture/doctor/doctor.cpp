// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/doctor/doctor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/link/client.hpp"
#include "firmware-host/link/realtime_priority.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::capture {
namespace {

using firmware_host::Capabilities;
using firmware_host::Device;
using schema::ErrorKind;
using schema::Result;

constexpr std::size_t kSyncs = 20, kTrialBytes = 1 << 20, kPieces = 16;

// A file whose name is removed as soon as it is open.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& folder) {
    std::string name = folder + "/.tactograph-doctor-XXXXXX";
    handle_ = mkstemp(name.data());
    if (handle_ >= 0) unlink(name.c_str());
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    if (handle_ >= 0) close(handle_);
  }

  bool is_open() const { return handle_ >= 0; }
  bool write_synced(const std::vector<char>& bytes) const {
    return write_all(bytes) && fdatasync(handle_) == 0;
  }
  bool write_all(const std::vector<char>& bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const auto written = write(handle_, bytes.data() + done, bytes.size() - done);
      if (written <= 0) return false;
      done += static_cast<std::size_t>(written);
    }
    return true;
  }
  bool sync() const { return fsync(handle_) == 0; }

 private:
  int handle_;
};

tl::unexpected<schema::Error> refused(const std::string& folder) {
  return schema::fail(ErrorKind::cannot_write, std::string("cannot be written to: ") + std::strerror(errno),
                      folder, "record to another folder, or check the owner of this one");
}

template <class Job>
double seconds_of(Job job) {
  const auto begun = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

std::optional<double> number_in(const std::string& path) {
  std::ifstream file(path);
  double number = 0;
  return file >> number ? std::optional(number) : std::nullopt;
}

std::optional<double> runtime_part(const std::string& root) {
  const auto runtime_us = number_in(root + "proc/sys/kernel/sched_rt_runtime_us");
  const auto period_us = number_in(root + "proc/sys/kernel/sched_rt_period_us");
  if (!runtime_us || !period_us || *period_us <= 0) return std::nullopt;
  return *runtime_us < 0 ? 1 : *runtime_us / *period_us;
}

// In a separate thread, so that the priority of this one does not change.
bool is_granted() {
  bool granted = false;
  std::thread([&] { granted = firmware_host::RealtimePriority().granted(); }).join();
  return granted;
}

// The assumed data rate if there is no device: the paper's sample rate, four channels of 32 bits.
constexpr double kUsualBytesPerS = 10e3 * 4 * 4;

double bytes_per_s(const Capabilities& capabilities) {
  return capabilities.sample_rate_hz * static_cast<double>(capabilities.channels.size()) * 4;
}

Check device_seen(const Capabilities& said) {
  return {"device", said.warnings.empty() ? Health::works : Health::warns,
          fmt::format("{}, serial {}{}", said.name, said.serial, said.simulated.empty() ? "" : ", emulated"),
          fmt::to_string(fmt::join(said.warnings, "; "))};
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
  if (request.device.starts_with("comedi:")) checks.push_back(check_playing(request.device));
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

Result<DiskSpeed> measure_disk(const std::string& folder, std::size_t block_bytes) {
  const ScratchFile file(folder);
  if (!file.is_open()) return refused(folder);
  bool written = true;
  const std::vector<char> block(block_bytes, 'x'), piece(kTrialBytes, 'x');
  std::vector<double> syncs_s;
  for (std::size_t i = 0; i < kSyncs; ++i)
    syncs_s.push_back(seconds_of([&] { written = written && file.write_synced(block); }));
  const double all_s = seconds_of([&] {
    for (std::size_t i = 0; i < kPieces; ++i) written = written && file.write_all(piece);
    written = written && file.sync();
  });
  if (!written) return refused(folder);
  std::ranges::sort(syncs_s);
  std::error_code unknown;
  const auto space = std::filesystem::space(folder, unknown);
  return DiskSpeed{unknown ? 0 : static_cast<double>(space.available), kPieces * kTrialBytes / all_s,
                   syncs_s[kSyncs / 2], syncs_s.back()};
}

RealtimeLimits realtime_limits(const std::string& root) {
  RealtimeLimits limits;
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) == 0) limits.priority = limit.rlim_cur;
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    limits.locked_bytes = static_cast<double>(limit.rlim_cur);
  limits.granted = is_granted();
  limits.runtime = runtime_part(root);
  return limits;
}

const Check* Diagnosis::first_failure() const {
  const auto found = std::ranges::find(checks, Health::fails, &Check::health);
  return found == checks.end() ? nullptr : &*found;
}

Diagnosis examine(const DoctorRequest& request) {
  Diagnosis diagnosis;
  const auto device = firmware_host::open_device(request.device);
  if (device) {
    check_device(**device, request, diagnosis.checks);
    diagnosis.channels = (*device)->capabilities().channels;
  } else {
    check_without_device(device.error(), request, diagnosis.checks);
  }
  diagnosis.next = next_of(diagnosis, request, !device || (*device)->is_real_time());
  return diagnosis;
}

}  // namespace tacto::capture
