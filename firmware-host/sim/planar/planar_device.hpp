// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated force device: axes and a hand behind the firmware's core, connected by the wire protocol.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/link/client.hpp"
#include "firmware-host/link/device.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/sim/device/emulated_board.hpp"
#include "firmware-host/sim/planar/planar_body.hpp"

namespace tacto::firmware_host {

/// Places of all axes, in the device's order, at a time since the ticks began.
using PlaneScript = std::function<std::vector<double>(double time_s)>;

/// Memory for a scene: 64 MB. A height map of 1024 x 1024 with all levels needs half of it.
inline constexpr std::uint32_t kPlanarWords = 1U << 24;

/// The axes of a force device as it describes them.
wire::Axes axes_on_wire(const schema::Device& device);

class PlanarBoard final : public EmulatedBoard {
 public:
  /// Without a hand the axes move along the script.
  PlanarBoard(schema::Device device, std::optional<schema::Hand> hand);

  /// Where the hand is moved to, or the axes, from the next time the rate is set; default: all at 0.
  void set_script(PlaneScript script) { script_ = std::move(script); }
  const schema::Device& device() const { return device_; }
  const std::optional<schema::Hand>& hand() const { return hand_; }

  bool ticking() const override { return rate_millihertz_ > 0; }
  double host_period_s() const override { return 1e3 / rate_millihertz_; }
  void step() override;
  void poll() override { firmware_->poll(); }
  double stream_bytes_per_s() const override { return 0; }

 private:
  static PlanarBoard& of(void* board) noexcept { return *static_cast<PlanarBoard*>(board); }
  core::Hal hal();
  core::Board about();
  void set_rate(std::uint32_t rate_millihertz);
  std::vector<double> script_at(std::uint64_t step) const;

  schema::Device device_;
  std::optional<schema::Hand> hand_;
  PlaneScript script_;
  wire::Axes axes_;
  std::vector<wire::Note> notes_;
  HostedProfile memory_{kPlanarWords};
  std::optional<PlanarBody> body_;
  std::vector<double> force_n_;
  std::int32_t counts_[wire::kMaxAxes] = {};
  std::uint32_t rate_millihertz_ = 0;
  std::uint64_t steps_ = 0, clock_before_ = 0;
  std::unique_ptr<core::Firmware> firmware_;
};

/// It has no channels to record: start() is refused.
class PlanarDevice final : public Device {
 public:
  static schema::Result<std::unique_ptr<PlanarDevice>> open(std::string uri, schema::Device device,
                                                            std::optional<schema::Hand> hand, bool paced);

  const Capabilities& capabilities() const override { return capabilities_; }
  schema::Result<void> start() override;
  schema::Result<std::size_t> read(std::span<std::int32_t> /*interleaved*/) override { return 0; }
  schema::Result<void> stop() override { return {}; }
  StreamCounts counts() const override { return {}; }
  bool is_real_time() const override { return paced_; }
  Client* conversation() override { return client_.get(); }
  PlanarBoard& board() { return *board_; }

 private:
  explicit PlanarDevice(bool paced) : paced_(paced) {}
  std::unique_ptr<PlanarBoard> board_;
  std::unique_ptr<Client> client_;
  bool paced_;
  Capabilities capabilities_;
};

inline constexpr std::string_view kPlanarScheme = "sim:planar";
/// The same, with the device `arm` of three axes as its default.
inline constexpr std::string_view kArmScheme = "sim:arm";

constexpr bool is_planar(std::string_view uri) {
  return uri.starts_with(kPlanarScheme) || uri.starts_with(kArmScheme);
}

/// `parameters` follows the scheme: ",device=NAME,hand=NAME,paced=1"; default: sandpaper-1990, no hand, as
/// fast as possible. Errors: usage, for another key; as read_device, read_hand.
schema::Result<std::unique_ptr<PlanarDevice>> make_planar_device(const std::string& uri,
                                                                 std::string_view parameters);
schema::Result<std::unique_ptr<Device>> open_planar_device(const std::string& uri,
                                                           std::string_view parameters);

}  // namespace tacto::firmware_host
