// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/sim_device.hpp"

#include <fmt/format.h>

#include "data-schema/quantity.hpp"
#include "data-schema/version.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Channel;
using schema::Dimension;
using schema::Fault;
using schema::for_people;

Channel channel_of(std::string name, std::string unit, double scale, std::string source) {
  Channel channel;
  channel.name = channel.quantity = std::move(name);
  channel.unit = std::move(unit);
  channel.scale = scale;
  channel.source = std::move(source);
  return channel;
}

Channel converted(std::string name, std::string unit, const Converter& converter, std::string source) {
  Channel channel = channel_of(std::move(name), std::move(unit), converter.scale(), std::move(source));
  channel.range_min = converter.least();
  channel.range_max = converter.most();
  return channel;
}

Channel load_channel(std::string name, const LoadCell& cell) {
  Channel channel = converted(std::move(name), "N", cell.converter(), "load cell under the transducer");
  channel.native_rate_hz = cell.native_rate_hz();
  return channel;
}

std::vector<Channel> channels_of(const SimRun& run, const SimParameters& parameters) {
  return {converted("tangential_force", "V", run.converter(), "transducer, piezo sensor"),
          channel_of("position", "m", parameters.encoder_quantum_m, "encoder on the finger, plain counts"),
          load_channel("normal_force", run.normal_cell()), load_channel("net_force", run.net_cell())};
}

std::string simulated_by(const SimParameters& p, std::string_view surface) {
  const std::string finger =
      p.finger_down
          ? fmt::format(
                "finger of person {} (elastic ridges, LuGre friction, mass-spring-damper pulp) at {} and {}",
                p.person, for_people(p.strokes.speed_mps, Dimension::speed),
                for_people(p.load_n, Dimension::force))
          : std::string("finger up");
  return fmt::format("by {}'s emulated device: {}, on {}, seed {}", kCreator, finger, surface, p.seed);
}

}  // namespace

SimDevice::SimDevice(std::string uri, const SimParameters& parameters, const schema::Transducer& transducer,
                     Surface surface)
    : parameters_(parameters), transducer_(transducer), profile_(std::move(surface.profile)) {
  capabilities_.uri = std::move(uri);
  capabilities_.name = "emulated transducer";
  capabilities_.serial = fmt::format("sim-{}", parameters.seed);
  capabilities_.simulated = simulated_by(parameters, surface.description);
  capabilities_.clock = "device";
  capabilities_.sample_rate_hz = parameters.sample_rate_hz;
  capabilities_.channels = channels_of(SimRun(parameters, transducer, profile_), parameters);
  capabilities_.transducer = transducer;
  capabilities_.surface = surface.description;
}

schema::Result<void> SimDevice::start() {
  run_ = std::make_unique<SimRun>(parameters_, transducer_, profile_);
  counts_ = {};
  pacer_ = Pacer();
  return {};
}

schema::Result<std::size_t> SimDevice::read(std::span<std::int32_t> interleaved) {
  if (!run_) return schema::fail(Fault::device, "the device is not started", capabilities_.uri);
  const std::size_t frames = interleaved.size() / kSimChannels;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto frame = interleaved.subspan(i * kSimChannels).first<kSimChannels>();
    if (!run_->next(frame)) return diverged();
    ++counts_.frames;
  }
  counts_.clipped = run_->clipped();
  if (parameters_.paced) pacer_.wait_until(static_cast<double>(counts_.frames) / parameters_.sample_rate_hz);
  return frames;
}

tl::unexpected<schema::Error> SimDevice::diverged() const {
  const double time_s = static_cast<double>(counts_.frames) / parameters_.sample_rate_hz;
  return schema::fail(Fault::device,
                      fmt::format("the simulated finger's motion diverged at {:.4f} s", time_s),
                      capabilities_.uri, "ask for less friction, load or depth");
}

schema::Result<void> SimDevice::stop() {
  run_.reset();
  return {};
}

StreamCounts SimDevice::counts() const {
  return counts_;
}

schema::Result<std::unique_ptr<Device>> open_sim_device(const std::string& uri, std::string_view parameters) {
  const auto asked = parse_sim_parameters(parameters);
  if (!asked) return schema::forward_error(asked);
  auto surface = make_surface(asked->surface);
  if (!surface) return schema::forward_error(surface);
  const auto transducer = schema::read_transducer(asked->transducer);
  if (!transducer) return schema::forward_error(transducer);
  return std::make_unique<SimDevice>(uri, *asked, *transducer, std::move(*surface));
}

}  // namespace tacto::firmware_host
