// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/player/scene_play.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "data-schema/base/creation_time.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/version.hpp"
#include "firmware-host/core/firmware/drive_supervisor.hpp"
#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "firmware-host/link/wire_words.hpp"
#include "firmware-host/sim/planar/planar_device.hpp"
#include "playback/model/finger_path.hpp"
#include "playback/player/placed_textures.hpp"
#include "playback/player/player_device.hpp"
#include "playback/prepare/scene/scene_device.hpp"
#include "playback/render/plane_render.hpp"
#include "spatial/dsp/resample/hermite.hpp"

namespace tacto::playback {

using firmware_host::Client;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

namespace {

constexpr double kUsualPlayS = 10, kReceiveS = 0.01, kBeatS = 0.025, kRampS = 0.05, kSceneRestS = 1;
constexpr double kFastestMps = 10;  // of a hand; faster is a jump of the encoder
constexpr float kUsualReleaseS = 0.01F;
constexpr std::uint16_t kWatchdogMs = 100;

// The device as its file describes it, or as it describes itself.
struct ForceDevice {
  PlayerDevice player;
  schema::Device about;
  std::optional<schema::Hand> hand = std::nullopt;  ///< of an emulated device
};

// The shortest decimal number that gives this value in single precision: 1e-5, not 9.99999975e-6.
double decimal_of(float value) {
  return std::stod(fmt::format("{}", value));
}

schema::Device device_of(const firmware_host::Description& description) {
  const wire::Axes& axes = *description.axes;
  schema::Device device;
  device.name = description.welcome.name;
  for (std::uint8_t i = 0; i < axes.count; ++i) {
    const wire::Axis& axis = axes.axes[i];
    schema::DeviceAxis row;
    row.name = firmware_host::name_of(axis.along);
    row.encoder_step_m = decimal_of(axis.metres_per_count);
    row.travel_from_m = axis.from_m, row.travel_to_m = axis.to_m;
    row.peak_force_n = double{axis.peak_n}, row.continuous_force_n = double{axis.continuous_n};
    device.axes.push_back(row);
  }
  device.peak_force_n = double{axes.peak_n}, device.continuous_force_n = double{axes.continuous_n};
  device.slew_n_per_s = double{axes.slew_n_per_s};
  device.rates_hz = {1e-3 * description.welcome.most_rate_millihertz};
  return device;
}

// The curves refer to the knots of the paths.
struct PlaneScriptData {
  std::vector<FingerPath> paths;
  std::vector<std::optional<spatial::HermiteCurve>> curves = {};  // of each axis; none along z
};

firmware_host::PlaneScript script_of(const schema::Device& device, std::vector<FingerPath> paths) {
  const auto data = std::make_shared<PlaneScriptData>(PlaneScriptData{std::move(paths)});
  auto path = data->paths.begin();
  for (const schema::DeviceAxis& axis : device.axes) {
    data->curves.emplace_back();
    if (axis.name == "z") continue;
    data->curves.back().emplace(path->time_s, path->position_m);
    ++path;
  }
  return [data](double time_s) {
    const FingerPath& first = data->paths.front();
    const double at_s = std::min(first.time_s.front() + time_s, first.time_s.back());
    std::vector<double> places_m;
    for (const auto& curve : data->curves) places_m.push_back(curve ? (*curve)(at_s) : 0);
    return places_m;
  };
}

Result<ForceDevice> open_emulated(const ScenePlayOptions& options, double& duration_s) {
  auto planar = firmware_host::make_planar_device(
      options.device_uri, std::string_view(options.device_uri).substr(firmware_host::kPlanarScheme.size()));
  TACTO_TRY(planar);
  const schema::Device device = (*planar)->board().device();
  const std::optional<schema::Hand> hand = (*planar)->board().hand();
  if (!options.path.empty()) {
    auto paths = read_axis_paths(options.path, plane_axes_of(device));
    TACTO_TRY(paths);
    TACTO_TRY(check_travel(device, *paths, options.path));
    duration_s = paths->front().duration_s();
    (*planar)->board().set_script(script_of(device, std::move(*paths)));
  }
  Client* const client = (*planar)->conversation();
  PlayerDevice player{std::move(*planar), client, options.device_uri, {}, {}};
  return ForceDevice{std::move(player), device, hand};
}

Result<ForceDevice> open_force_device(const ScenePlayOptions& options, double& duration_s) {
  if (options.device_uri.starts_with(firmware_host::kPlanarScheme)) return open_emulated(options, duration_s);
  if (!options.path.empty())
    return fail(ErrorKind::unsuitable, "only an emulated hand follows a path", options.device_uri,
                "leave the path out, or play on sim:planar");
  auto player = open_player_device(options.device_uri, std::nullopt);
  TACTO_TRY(player);
  if (!player->client->description().axes)
    return fail(ErrorKind::unsuitable, "this device has no axes with forces", player->uri,
                "play the scene on a force device, for example sim:planar");
  schema::Device about = device_of(player->client->description());
  return ForceDevice{std::move(*player), std::move(about)};
}

Result<wire::ForceLimits> limits_for(const wire::Axes& own, double rate_hz, double onset_s,
                                     const std::string& uri) {
  wire::ForceLimits limits;
  double finest_m = INFINITY;
  for (std::uint8_t i = 0; i < own.count; ++i) {
    limits.axis_peak_n[i] = own.axes[i].peak_n;
    limits.axis_continuous_n[i] = own.axes[i].continuous_n;
    finest_m = std::min(finest_m, double{own.axes[i].metres_per_count});
  }
  limits.peak_n = own.peak_n, limits.continuous_n = own.continuous_n;
  limits.slew_n_per_s = own.slew_n_per_s;
  limits.onset_s = static_cast<float>(onset_s);
  const float longest_s = core::kLongestReleaseS - own.peak_n / own.slew_n_per_s;
  if (!(longest_s >= 0))
    return fail(ErrorKind::unsuitable,
                fmt::format("its force needs {:g} s to fall to zero", double{own.peak_n / own.slew_n_per_s}),
                uri,
                fmt::format("at most {:g} s are safe: raise slew_n_per_s of the device",
                            double{core::kLongestReleaseS}));
  limits.release_s = std::min(kUsualReleaseS, longest_s);
  limits.watchdog_ms = kWatchdogMs;
  limits.counts_per_tick = static_cast<std::uint32_t>(std::clamp(kFastestMps / finest_m / rate_hz, 1.0, 1e9));
  return limits;
}

schema::SessionHeader header_of(const ForceDevice& device, const std::string& scene_file, double rate_hz) {
  const firmware_host::Description& about = device.player.client->description();
  schema::SessionHeader header;
  header.created = schema::creation_time();
  header.creator = kCreator;
  header.build = __VERSION__;
  header.rate_hz = rate_hz;
  header.clock_hz = about.welcome.clock_hz;
  header.metres_per_count = decimal_of(about.axes->axes[0].metres_per_count);
  header.device_uri = device.player.uri;
  header.device_name = about.welcome.name;
  header.device_serial = about.welcome.serial;
  header.device_firmware = about.welcome.firmware;
  header.device_protocol = fmt::format("{}.{}", about.welcome.major, about.welcome.minor);
  header.simulated = firmware_host::simulated_device(about);
  header.scene_file = scene_file;
  header.scene_sha256 = schema::sha256_of_file(scene_file).value_or("");
  const schema::Device own = device_of(about);
  header.forces = schema::SessionForces{own.peak_force_n, own.continuous_force_n, own.slew_n_per_s, own.axes};
  return header;
}

Result<void> upload_scene(Client& client, const PreparedScene& scene, const wire::ForceLimits& limits) {
  TACTO_TRY(client.command(limits));
  wire::ScenePart part{};
  part.bytes = static_cast<std::uint32_t>(scene.bytes());
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(scene.words.data());
  for (; part.first < part.bytes; part.first += part.count) {
    part.count =
        static_cast<std::uint16_t>(std::min<std::size_t>(wire::kMaxScenePart, part.bytes - part.first));
    std::copy_n(bytes + part.first, part.count, part.data);
    TACTO_TRY(client.command(part));
  }
  return {};
}

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

// Sends, receives and records, from the upload to the end of the session.
class ScenePlayer {
 public:
  ScenePlayer(Client& client, FlightRecorder& recorder, double rate_hz, ScenePlayOutcome& outcome)
      : client_(client), recorder_(recorder), rate_hz_(rate_hz), outcome_(outcome) {
    client_.listen([this](std::span<const std::uint8_t> frame) {
      recorder_.command({expected_, now_ns(), {frame.begin(), frame.end()}});
    });
  }
  ScenePlayer(const ScenePlayer&) = delete;
  ScenePlayer& operator=(const ScenePlayer&) = delete;
  ~ScenePlayer() { client_.listen({}); }

  Result<void> begin(const PreparedScene& scene, const wire::ForceLimits& limits) {
    TACTO_TRY(upload_scene(client_, scene, limits));
    client_.take_axis_ticks();
    TACTO_TRY(recorder_.start());
    TACTO_TRY(client_.command(wire::Arm{wire::DriveSource::scene, firmware_host::millihertz(rate_hz_)}));
    event("armed");
    TACTO_TRY(client_.command(wire::Play{}));
    event("playing");
    return {};
  }
  double armed_s() const { return static_cast<double>(expected_) / rate_hz_; }
  Result<void> step() {
    TACTO_TRY(client_.receive(kReceiveS));
    if (client_.transport().now_s() >= next_beat_s_) {
      TACTO_TRY(client_.heartbeat());
      next_beat_s_ = client_.transport().now_s() + kBeatS;
    }
    take();
    return {};
  }
  Result<void> end() {
    TACTO_TRY(client_.command(wire::Stop{}));
    for (const double until_s = armed_s() + kRampS; armed_s() < until_s && outcome_.fault.empty();)
      TACTO_TRY(step());
    TACTO_TRY(client_.command(wire::Disarm{}));
    const double until_s = client_.transport().now_s() + kSceneRestS;
    while (client_.transport().now_s() < until_s) {
      const auto pulse = client_.heartbeat();
      TACTO_TRY(pulse);
      take();
      if (pulse->state == wire::DriveState::idle) return event("idle"), Result<void>();
      TACTO_TRY(client_.receive(kReceiveS));
    }
    return fail(ErrorKind::device, "the device did not come to rest", client_.where(), "switch it off");
  }

 private:
  void event(const std::string& words) { recorder_.event({expected_, now_ns(), words}); }
  void take() {
    for (const wire::AxisTicks& message : client_.take_axis_ticks()) take(message);
    for (const wire::Fault& fault : client_.take_faults()) {
      const firmware_host::FaultWords words = firmware_host::words_of(fault.code, fault.detail);
      event(words.what);
      if (fault.code == wire::FaultCode::ring_full || fault.code == wire::FaultCode::converter) continue;
      outcome_.fault = words.remedy.empty() ? words.what : words.what + " (" + words.remedy + ")";
    }
  }
  void take(const wire::AxisTicks& message) {
    if (message.first_tick > expected_) {
      const std::uint64_t lost = message.first_tick - expected_;
      outcome_.link_lost += lost;
      recorder_.loss({expected_, lost, schema::SessionLoss::Why::link});
    }
    const double ns_per_clock = 1e9 / std::max(1U, client_.description().welcome.clock_hz);
    const auto time_ns = std::llround(static_cast<double>(message.device_ticks) * ns_per_clock);
    for (std::uint8_t i = 0; i < message.count; ++i) {
      const wire::AxisTick& tick = message.ticks[i];
      schema::SessionTick row;
      row.tick = message.first_tick + i;
      row.time_ns = time_ns + std::llround(i * 1e9 / rate_hz_);
      row.encoder = tick.counts[0];
      row.flags = tick.flags;
      row.axes = message.axes;
      std::copy_n(tick.counts, message.axes, row.counts.begin());
      std::copy_n(tick.force_n, message.axes, row.force_n.begin());
      recorder_.tick(row);
      count(row);
    }
    expected_ = message.first_tick + message.count;
  }
  void count(const schema::SessionTick& row) {
    outcome_.peak_limited += (row.flags & wire::kTickAmplitudeLimited) != 0;
    outcome_.slew_limited += (row.flags & wire::kTickSlewLimited) != 0;
    outcome_.rms_limited += (row.flags & wire::kTickEnergyLimited) != 0;
    double square = 0;
    for (const float force_n : row.force_n) square += double{force_n} * double{force_n};
    outcome_.force_peak_n = std::max(outcome_.force_peak_n, std::sqrt(square));
  }

  Client& client_;
  FlightRecorder& recorder_;
  double rate_hz_, next_beat_s_ = 0;
  ScenePlayOutcome& outcome_;
  std::uint64_t expected_ = 0;
};

Result<void> play_through(ScenePlayer& player, const PreparedScene& scene, const wire::ForceLimits& limits,
                          double time_s, const std::function<bool()>& stop_asked,
                          const std::function<void(double)>& progress, const ScenePlayOutcome& outcome) {
  TACTO_TRY(player.begin(scene, limits));
  while (player.armed_s() < time_s && !stop_asked() && outcome.fault.empty()) {
    TACTO_TRY(player.step());
    if (progress) progress(player.armed_s() / time_s);
  }
  return player.end();
}

}  // namespace

bool plays_forces(const std::string& what, const std::string& device_uri) {
  if (device_uri.starts_with(firmware_host::kPlanarScheme)) return true;
  if (!names_a_scene(what)) return false;
  const auto scene = schema::read_scene(what);
  return scene && !scene->patches.empty();
}

Result<ScenePlayOutcome> play_scene(const ScenePlayOptions& options, const std::function<bool()>& stop_asked,
                                    const std::function<void(double)>& progress) {
  if (!names_a_scene(options.scene))
    return fail(ErrorKind::unsuitable, "is a texture; a force device plays the force patches of a scene",
                options.scene, "name a scene, or play on a device with a tray");
  const std::string file = schema::scene_path(options.scene);
  const auto scene = schema::read_scene(file);
  TACTO_TRY(scene);
  double time_s = kUsualPlayS;
  const auto device = open_force_device(options, time_s);
  TACTO_TRY(device);
  const auto setup = force_setup_of(device->about, options.rate_hz);
  TACTO_TRY(setup);
  const auto prepared = prepare_scene(*scene, file, device->about, double{setup->rate_hz}, device->hand);
  TACTO_TRY(prepared);
  Client& client = *device->player.client;
  const double rate_hz = options.rate_hz.value_or(device->about.rates_hz.back());
  const auto limits = limits_for(*client.description().axes, rate_hz, options.onset_s, device->player.uri);
  TACTO_TRY(limits);
  ScenePlayOutcome outcome;
  outcome.device = device->player.uri;
  outcome.simulated = firmware_host::simulated_device(client.description());
  outcome.rate_hz = rate_hz;
  outcome.notes = limits_of_device(*prepared, device->about, *setup);
  const FullQueue full = device->player.device->is_real_time() ? FullQueue::lose : FullQueue::wait;
  const auto recorder = FlightRecorder::begin(options.session, header_of(*device, file, rate_hz), full);
  TACTO_TRY(recorder);
  ScenePlayer player(client, **recorder, rate_hz, outcome);
  const auto played = play_through(player, *prepared, *limits, options.time_s.value_or(time_s), stop_asked,
                                   progress, outcome);
  if (!played && (*recorder)->counts().ticks == 0) (*recorder)->discard();
  const auto closed = (*recorder)->close();
  TACTO_TRY(played);
  TACTO_TRY(closed);
  outcome.recorder = (*recorder)->counts();
  return outcome;
}

}  // namespace tacto::playback
