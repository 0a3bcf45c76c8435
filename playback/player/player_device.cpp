// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/player_device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "data-schema/base/open_by.hpp"
#include "firmware-host/open_device.hpp"
#include "firmware-host/sim/device/sim_device.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "playback/player/force_program.hpp"
#include "playback/render/plane_render.hpp"
#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::playback {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr std::string_view kSimScheme = "sim:";
constexpr mode_t kForAll = 0666;

std::string lock_path(const std::string& device_name) {
  std::string name = device_name;
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; }, '_');
  const bool usual = access("/run/lock", W_OK) == 0;
  return (usual ? "/run/lock/tactograph-" : "/tmp/tactograph-") + name.substr(0, 100) + ".lock";
}

// Positions along a path at any time; only the knots are stored, because a path may last for hours.
class Script {
 public:
  Script(const FingerScript& script, bool closed)
      : repeated_(script.repeated), closed_(closed), knots_(std::make_shared<const Knots>(script.path)) {}

  double operator()(double time_s) const { return knots_->curve(on_path(time_s)); }
  /// Precondition: the path has a normal force.
  double force_n(double time_s) const {
    const FingerPath& path = knots_->path;
    const double at_s = on_path(time_s);
    const auto next = std::ranges::upper_bound(path.time_s, at_s);
    if (next == path.time_s.end()) return path.normal_force_n.back();
    const auto i = static_cast<std::size_t>(next - path.time_s.begin());  // above 0, since at_s >= time_s[0]
    const double part = (at_s - path.time_s[i - 1]) / (path.time_s[i] - path.time_s[i - 1]);
    return std::lerp(path.normal_force_n[i - 1], path.normal_force_n[i], part);
  }

 private:
  double on_path(double time_s) const {
    const double whole_s = knots_->path.duration_s();
    if (repeated_ && closed_)
      time_s = std::fmod(time_s, whole_s);
    else if (repeated_)
      time_s = whole_s - std::abs(std::fmod(time_s, 2 * whole_s) - whole_s);
    return knots_->path.time_s.front() + std::clamp(time_s, 0.0, whole_s);
  }

  struct Knots {
    explicit Knots(FingerPath along) : path(std::move(along)), curve(path.time_s, path.position_m) {}
    FingerPath path;
    spatial::HermiteCurve curve;
  };
  bool repeated_, closed_;
  std::shared_ptr<const Knots> knots_;
};

// Of each axis of the device; an axis z without a path stays at 0.
firmware_host::PlaneScript plane_script(const schema::Device& device, const std::vector<FingerPath>& paths,
                                        bool repeated) {
  std::vector<std::optional<Script>> ways;
  const bool closed = std::ranges::all_of(paths, ends_where_it_began);
  auto path = paths.begin();
  for (const schema::DeviceAxis& axis : device.axes)
    ways.push_back(axis.name == "z" && paths.size() < device.axes.size()
                       ? std::nullopt
                       : std::optional(Script(FingerScript{*path++, repeated}, closed)));
  return [ways](double time_s) {
    std::vector<double> places_m;
    for (const auto& way : ways) places_m.push_back(way ? (*way)(time_s) : 0);
    return places_m;
  };
}

struct ScriptedDevice {
  std::unique_ptr<firmware_host::Device> device;
  std::function<void()> begin_path;
};

Result<ScriptedDevice> open_scripted(const std::string& uri, const FingerScript& script,
                                     bool without_watchdog) {
  if (!uri.starts_with(kSimScheme) || without_watchdog) {
    TACTO_TRY(firmware_host::open_device_to_play(uri, without_watchdog));
    return fail(ErrorKind::unsuitable, "only an emulated finger follows a path", uri,
                "leave the finger's path out, or play on sim:");
  }
  auto device = firmware_host::make_sim_device(uri, std::string_view(uri).substr(kSimScheme.size()));
  TACTO_TRY(device);
  const Script way(script, ends_where_it_began(script.path));
  std::function<double(double)> force_n;
  if (!script.path.normal_force_n.empty()) force_n = [way](double time_s) { return way.force_n(time_s); };
  firmware_host::SimBoard& board = (*device)->board();
  board.set_script(way, std::move(force_n));
  board.hold_script(script.waits);
  ScriptedDevice scripted{std::move(*device), {}};
  if (script.waits) scripted.begin_path = [&board] { board.hold_script(false); };
  return scripted;
}

Result<ScriptedDevice> open_with(const std::string& uri, const std::optional<FingerScript>& script,
                                 bool without_watchdog) {
  if (script) return open_scripted(uri, *script, without_watchdog);
  auto device = firmware_host::open_device_to_play(uri, without_watchdog);
  TACTO_TRY(device);
  return ScriptedDevice{std::move(*device), {}};
}

}  // namespace

DeviceLock::DeviceLock(DeviceLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

DeviceLock& DeviceLock::operator=(DeviceLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

DeviceLock::~DeviceLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<DeviceLock> DeviceLock::take(const std::string& device_name) {
  const std::string path = lock_path(device_name);
  int opened = open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (opened < 0) opened = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kForAll);
  if (opened < 0)
    return fail(ErrorKind::cannot_write, fmt::format("the lock can't be made: {}", std::strerror(errno)),
                path, "check the owner of this file and of its folder");
  [[maybe_unused]] const int shared = fchmod(opened, kForAll);
  if (flock(opened, LOCK_EX | LOCK_NB) == 0) return DeviceLock(opened);
  ::close(opened);
  return fail(ErrorKind::unsuitable, "another program plays on the device", device_name,
              "stop " + schema::programs_with(path, "it: tactographd, or tactograph play"));
}

Result<std::optional<FingerScript>> read_finger_script(const std::string& file) {
  if (file.empty()) return std::optional<FingerScript>();
  auto path = read_finger_path(file);
  TACTO_TRY(path);
  return std::optional(FingerScript{std::move(*path), true});
}

Result<PlayerDevice> open_player_device(const std::string& uri, const std::optional<FingerScript>& script,
                                        bool without_watchdog) {
  auto opened = open_with(uri, script, without_watchdog);
  TACTO_TRY(opened);
  auto& device = opened->device;
  firmware_host::Client* const client = device->conversation();
  if (client == nullptr)
    return fail(ErrorKind::unsuitable, "nothing can be played on a replay", uri, "play on sim: or usb:");
  const firmware_host::Capabilities& about = device->capabilities();
  PlayerDevice player{std::move(device), client, about.uri, {}, std::move(opened->begin_path)};
  if (uri.starts_with(kSimScheme)) return player;  // only this process can use the emulation
  auto lock = DeviceLock::take(about.simulated.empty() ? about.serial : about.uri);
  TACTO_TRY(lock);
  player.lock = std::move(*lock);
  return player;
}

Result<ForceDevice> open_force_device(const std::string& uri, const std::string& path, bool repeated) {
  const bool emulated = firmware_host::is_planar(uri);
  auto player = open_player_device(uri, std::nullopt);
  TACTO_TRY(player);
  if (!player->client->description().axes)
    return fail(ErrorKind::unsuitable, "this device has no axes with forces", player->uri,
                "play the scene on a force device, for example sim:planar");
  if (!emulated) {
    if (!path.empty())
      return fail(ErrorKind::unsuitable, "only an emulated hand follows a path", uri,
                  "leave the path out, or play on sim:planar");
    schema::Device about = device_of(player->client->description());
    return ForceDevice{std::move(*player), std::move(about)};
  }
  firmware_host::PlanarBoard& board = static_cast<firmware_host::PlanarDevice&>(*player->device).board();
  ForceDevice opened{std::move(*player), board.device(), board.hand()};
  if (path.empty()) return opened;
  const auto paths = read_axis_paths(path, path_axes_of(opened.about, path));
  TACTO_TRY(paths);
  TACTO_TRY(check_travel(opened.about, *paths, path));
  board.set_script(plane_script(opened.about, *paths, repeated));
  opened.path_s = paths->front().duration_s();
  return opened;
}

}  // namespace tacto::playback
