// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/live/live_texture.hpp"

#include <algorithm>
#include <complex>
#include <memory>
#include <numeric>

#include "data-schema/base/statistics.hpp"
#include "data-schema/texture/texture.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "playback/model/chain.hpp"
#include "playback/prepare/texture_change.hpp"
#include "playback/prepare/upload.hpp"
#include "playback/wasm/browser_board.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

using schema::Result;

// The page's board in this process, at rest: it checks the upload and accepts it as the page's does.
class RestingBoard final : public firmware_host::Transport {
 public:
  RestingBoard(const wire::Axes* axes, std::uint32_t rate_hz)
      : firmware_(std::make_unique<core::Firmware>(
            axes == nullptr ? browser::board(channel_, profile_.data())
                            : browser::board(channel_, profile_.data(), axes, rate_hz),
            hal())) {}

  Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    firmware_->poll();
    if (to_host_.empty()) now_s_ += timeout_s;
    return firmware_host::take_first(to_host_, bytes);
  }
  Result<void> write(std::span<const std::uint8_t> bytes, double) override {
    from_host_.insert(from_host_.end(), bytes.begin(), bytes.end());
    firmware_->poll();
    return {};
  }
  double now_s() override { return now_s_; }

 private:
  core::Hal hal() {
    core::Hal hal;
    hal.board = this;
    hal.read_encoder = [](void*) noexcept { return std::int32_t{0}; };
    hal.read_channels = [](void*, std::int32_t*) noexcept { return true; };
    hal.write_drive = [](void*, float) noexcept {};
    hal.read_axes = [](void*, std::int32_t*) noexcept {};
    hal.write_forces = [](void*, const float*) noexcept {};
    hal.enable_closed = [](void*) noexcept { return true; };
    hal.clock = [](void*) noexcept { return std::uint64_t{0}; };
    hal.set_rate = [](void*, std::uint32_t) noexcept {};
    firmware_host::use_queues<RestingBoard, &RestingBoard::from_host_, &RestingBoard::to_host_>(hal);
    hal.restart = [](void*) noexcept {};
    return hal;
  }

  wire::Channel channel_ = browser::encoder_channel();
  firmware_host::HostedProfile profile_;
  std::vector<std::uint8_t> from_host_, to_host_;
  double now_s_ = 0;
  std::unique_ptr<core::Firmware> firmware_;
};
static_assert(browser::kProfileSamples == firmware_host::HostedProfile::kSamples);

playback::PrepareOptions page_options() {
  playback::PrepareOptions options;
  options.rate_hz = browser::kRateHz;
  options.metres_per_count = browser::kMetresPerCount;
  options.most_samples = browser::kProfileSamples;
  return options;
}

}  // namespace

Result<std::vector<Frame>> frames_of(const std::string& name,
                                     const std::function<Result<void>(firmware_host::Client&)>& send,
                                     const wire::Axes* axes, std::uint32_t rate_hz) {
  auto client = firmware_host::Client::connect(std::make_unique<RestingBoard>(axes, rate_hz), "the page");
  TACTO_TRY(client);
  std::vector<Frame> frames;
  (*client)->listen(
      [&](std::span<const std::uint8_t> frame) { frames.emplace_back(frame.begin(), frame.end()); });
  if (const auto sent = send(**client); !sent) {
    schema::Error error = sent.error();
    error.where = name;
    return tl::unexpected(error);
  }
  return frames;
}

std::vector<float> texture_map(const std::vector<double>& values, std::size_t columns) {
  std::vector<float> map;
  for (std::size_t column = 0; column < columns; ++column) {
    const std::size_t first = std::min(column * values.size() / columns, values.size() - 1);
    const std::size_t end = std::max((column + 1) * values.size() / columns, first + 1);
    const auto [least, most] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                                                   values.begin() + static_cast<std::ptrdiff_t>(end));
    map.push_back(static_cast<float>(*least));
    map.push_back(static_cast<float>(*most));
  }
  return map;
}

double rms_about_mean(std::vector<double> values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  return schema::rms_of(values);
}

std::vector<float> tray_response(const schema::Transducer& transducer) {
  constexpr std::size_t kLength = 4 * kTrayTaps;
  playback::Chain chain;
  chain.transducer = transducer;
  chain.hold = playback::Hold::zero_order;
  chain.sample_rate_hz = browser::kRateHz;
  spatial::RealFft fft(kLength);
  std::vector<std::complex<double>> response(fft.bins());
  for (std::size_t k = 0; k < response.size(); ++k)
    response[k] = playback::chain_response(chain, static_cast<double>(k) * browser::kRateHz / kLength);
  response.back() = response.back().real();
  std::vector<double> impulse(kLength);
  fft.inverse(response, impulse);
  return {impulse.begin(), impulse.begin() + kTrayTaps};
}

Result<LiveTexture> make_live_texture(const std::string& file, const std::string& transducer,
                                      const std::optional<std::string>& inverse) {
  const auto texture = schema::read_texture(file);
  TACTO_TRY(texture);
  playback::ProgramRequest request;
  request.file = file;
  request.choices.inverse = inverse;
  LiveTexture live;
  live.file = file;
  auto program = playback::make_program(request, transducer, page_options());
  TACTO_TRY(program);
  live.program = std::move(*program);
  auto upload = frames_of(
      file, [&](firmware_host::Client& client) { return playback::upload(client, live.program.prepared); });
  TACTO_TRY(upload);
  live.upload = std::move(*upload);
  live.rms = rms_about_mean(texture->signal.values);
  live.map = texture_map(texture->signal.values);
  live.tray = tray_response(live.program.session.transducer);
  return live;
}

// At rest the board accepts the same frames as while it plays. The device has one gain, which belongs to the
// texture that it got at rest, so the samples are scaled.
Result<LiveChange> make_change(const LiveTexture& playing, const LiveTexture& next, double times) {
  const playback::Prepared& to = next.program.prepared;
  TACTO_TRY(playback::check_texture_change(playing.program.prepared, to, browser::kProfileSamples));
  auto frames = frames_of(next.file, [&](firmware_host::Client& client) {
    return playback::upload_next(client, to, double{to.gain_m_per_n} / times);
  });
  TACTO_TRY(frames);
  const schema::SessionProgram& program = next.program.session;
  LiveChange change{std::move(*frames), program};
  for (schema::SessionTexture& texture : change.program.textures)
    texture.gain_m_per_n = times * double{playing.program.prepared.gain_m_per_n};
  return change;
}

}  // namespace tacto::analysis
