// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/planar/planar_device.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/version.hpp"
#include "firmware-host/link/wire_fields.hpp"
#include "firmware-host/sim/device/sim_transport.hpp"

namespace tacto::firmware_host {

using schema::ErrorKind;
using schema::Result;

namespace {

constexpr std::uint32_t kPlanarClockHz = 1'000'000;

}  // namespace

wire::Axes axes_on_wire(const schema::Device& device) {
  wire::Axes axes;
  axes.count = static_cast<std::uint8_t>(device.axes.size());
  axes.peak_n = not_above(device.peak_force_n);
  axes.continuous_n = not_above(device.continuous_force_n);
  axes.slew_n_per_s = not_above(device.slew_n_per_s);
  std::ranges::transform(device.axes, axes.axes, [](const schema::DeviceAxis& axis) {
    return wire::Axis{along_of(axis.name),
                      {},
                      not_above(axis.peak_force_n),
                      not_above(axis.continuous_force_n),
                      static_cast<float>(axis.encoder_step_m),
                      axis.travel_from_m,
                      axis.travel_to_m};
  });
  return axes;
}

PlanarBoard::PlanarBoard(schema::Device device, std::optional<schema::Hand> hand)
    : device_(std::move(device)),
      hand_(std::move(hand)),
      axes_(axes_on_wire(device_)),
      force_n_(device_.axes.size()) {
  notes_ = {note_of(wire::NoteKind::simulated_by, fmt::format("tactograph sim:planar, device {}, hand {}",
                                                              device_.name, hand_ ? hand_->name : "none"))};
  firmware_ = std::make_unique<core::Firmware>(about(), hal());
}

core::Board PlanarBoard::about() {
  wire::Welcome welcome;
  put_text(welcome.name, device_.name);
  put_text(welcome.serial, "emulated");
  put_text(welcome.firmware, kCreator);
  welcome.features = wire::kFeatureSimulated;
  static const std::vector<wire::Channel> kNoChannels;
  core::Board board = board_of(welcome, kNoChannels, notes_, memory_);
  board.axes = &axes_;
  board.about.clock_hz = kPlanarClockHz;
  board.about.default_rate_millihertz = board.about.most_rate_millihertz =
      millihertz(device_.rates_hz.back());
  board.about.least_rate_millihertz = millihertz(device_.rates_hz.front());
  return board;
}

core::Hal PlanarBoard::hal() {
  core::Hal hal;
  hal.board = this;
  hal.read_encoder = [](void* b) noexcept { return of(b).counts_[0]; };
  hal.read_channels = [](void* /*board*/, std::int32_t* /*codes*/) noexcept { return true; };
  hal.write_drive = [](void* /*board*/, float /*volts*/) noexcept {};
  hal.read_axes = [](void* b, std::int32_t* counts) noexcept {
    std::copy_n(of(b).counts_, of(b).device_.axes.size(), counts);
  };
  hal.write_forces = [](void* b, const float* force_n) noexcept {
    std::copy_n(force_n, of(b).force_n_.size(), of(b).force_n_.begin());
  };
  hal.enable_closed = [](void* /*board*/) noexcept { return true; };
  hal.clock = [](void* b) noexcept {
    const PlanarBoard& board = of(b);
    const std::uint64_t ticks =
        board.ticking() ? board.steps_ * kPlanarClockHz * 1000 / board.rate_millihertz_ : 0;
    return board.clock_before_ + ticks;
  };
  hal.set_rate = [](void* b, std::uint32_t rate) noexcept { of(b).set_rate(rate); };
  use_queues<PlanarBoard, &PlanarBoard::from_host_, &PlanarBoard::to_host_>(hal);
  hal.restart = [](void* b) noexcept { of(b).set_rate(0); };
  return hal;
}

void PlanarBoard::set_rate(std::uint32_t rate_millihertz) {
  if (ticking()) clock_before_ += steps_ * kPlanarClockHz * 1000 / rate_millihertz_;
  steps_ = 0;
  rate_millihertz_ = rate_millihertz;
  if (!ticking()) return;
  std::ranges::fill(force_n_, 0);
  body_.reset();
  if (hand_) body_.emplace(device_, *hand_, host_period_s());
  if (body_) body_->rest_at(script_at(0));
  for (std::size_t i = 0; i < device_.axes.size(); ++i)
    counts_[i] = encoder_count(device_.axes[i], script_at(0)[i]);
}

std::vector<double> PlanarBoard::script_at(std::uint64_t step) const {
  if (!script_) return std::vector<double>(device_.axes.size());
  return script_(static_cast<double>(step) * host_period_s());
}

// The first tick is at the beginning of the script, with the hand at rest.
void PlanarBoard::step() {
  if (steps_ > 0 && body_) body_->step(force_n_, script_at(steps_ - 1), script_at(steps_));
  const std::vector<double> script_m = script_at(steps_);
  for (std::size_t i = 0; i < device_.axes.size(); ++i)
    counts_[i] = body_ ? body_->count(i) : encoder_count(device_.axes[i], script_m[i]);
  ++steps_;
  firmware_->tick();
}

Result<std::unique_ptr<PlanarDevice>> PlanarDevice::open(std::string uri, schema::Device device,
                                                         std::optional<schema::Hand> hand, bool paced) {
  std::unique_ptr<PlanarDevice> opened(new PlanarDevice(paced));
  opened->board_ = std::make_unique<PlanarBoard>(std::move(device), std::move(hand));
  auto client = Client::connect(std::make_unique<SimTransport>(*opened->board_, paced), uri);
  TACTO_TRY(client);
  opened->client_ = std::move(*client);
  const wire::Welcome& welcome = opened->client_->description().welcome;
  opened->capabilities_.uri = std::move(uri);
  opened->capabilities_.name = welcome.name;
  opened->capabilities_.serial = welcome.serial;
  opened->capabilities_.firmware = welcome.firmware;
  opened->capabilities_.simulated = opened->capabilities_.simulated_device =
      opened->client_->description().notes.front().text;
  return opened;
}

Result<void> PlanarDevice::start() {
  return schema::fail(ErrorKind::unsuitable, "a force device has no channels to record", capabilities_.uri,
                      "play a scene with force patches on it");
}

Result<std::unique_ptr<PlanarDevice>> make_planar_device(const std::string& uri,
                                                         std::string_view parameters) {
  std::string device_name = uri.starts_with(kArmScheme) ? "arm" : "sandpaper-1990", hand_name, paced = "0";
  while (!parameters.empty()) {
    const std::string_view part = parameters.substr(1, parameters.find(',', 1) - 1);
    const std::string_view key = part.substr(0, part.find('='));
    std::string* const value = key == "device"  ? &device_name
                               : key == "hand"  ? &hand_name
                               : key == "paced" ? &paced
                                                : nullptr;
    if (parameters.front() != ',' || value == nullptr || key.size() == part.size())
      return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a part of it", parameters), uri,
                          fmt::format("for example {},hand=minsky-radial,paced=1",
                                      uri.starts_with(kArmScheme) ? kArmScheme : kPlanarScheme));
    *value = part.substr(key.size() + 1);
    parameters.remove_prefix(1 + part.size());
  }
  if (paced != "0" && paced != "1")
    return schema::fail(ErrorKind::usage, fmt::format("paced is '{}'", paced), uri, "use paced=1 or paced=0");
  auto device = schema::read_device(device_name);
  TACTO_TRY(device);
  std::optional<schema::Hand> hand;
  if (!hand_name.empty()) {
    auto read = schema::read_hand(hand_name);
    TACTO_TRY(read);
    hand = std::move(*read);
  }
  return PlanarDevice::open(uri, std::move(*device), std::move(hand), paced == "1");
}

Result<std::unique_ptr<Device>> open_planar_device(const std::string& uri, std::string_view parameters) {
  return make_planar_device(uri, parameters);
}

}  // namespace tacto::firmware_host
