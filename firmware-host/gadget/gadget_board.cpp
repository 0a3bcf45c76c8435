// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/gadget_board.hpp"

#include <fmt/format.h>

#include <string_view>

#include "firmware-host/gadget/replay_board.hpp"
#include "firmware-host/sim/device/sim_board.hpp"
#include "firmware-host/sim/device/sim_description.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::Result;

constexpr std::string_view kSim = "sim:", kReplay = "replay:", kLoop = ",loop=1";

class SimGadgetBoard final : public GadgetBoard {
 public:
  SimGadgetBoard(const SimParameters& parameters, const schema::Transducer& transducer, Surface surface)
      : serial_(sim_welcome(parameters, transducer).serial),
        board_(parameters, transducer, std::move(surface)) {}

  std::string serial() const override { return serial_; }
  bool ticking() const override { return board_.ticking(); }
  double period_s() const override { return board_.period_s(); }
  void step() override { board_.step(); }
  void poll() override { board_.poll(); }
  double drive_v() const override { return board_.drive_v(); }
  const core::DriveSupervisor& supervisor() const override { return board_.supervisor(); }
  std::vector<std::uint8_t>& from_host() override { return board_.from_host(); }
  std::vector<std::uint8_t>& to_host() override { return board_.to_host(); }

 private:
  std::string serial_;
  SimBoard board_;
};

Result<std::unique_ptr<GadgetBoard>> make_sim(std::string_view words, const std::string& serial) {
  auto parameters = parse_sim_parameters(words);
  TACTO_TRY(parameters);
  parameters->serial = serial;
  auto surface = make_surface(parameters->surface);
  TACTO_TRY(surface);
  const auto transducer = schema::read_transducer(parameters->transducer);
  TACTO_TRY(transducer);
  return std::make_unique<SimGadgetBoard>(*parameters, *transducer, std::move(*surface));
}

Result<std::unique_ptr<GadgetBoard>> make_replay(std::string_view words, const std::string& serial) {
  const bool loop = words.ends_with(kLoop);
  if (loop) words.remove_suffix(kLoop.size());
  auto board = ReplayBoard::open(std::string(words), loop, serial);
  TACTO_TRY(board);
  return std::unique_ptr<GadgetBoard>(std::move(*board));
}

}  // namespace

Result<std::unique_ptr<GadgetBoard>> make_gadget_board(const std::string& uri, const std::string& serial) {
  const std::string_view words = uri;
  if (words.starts_with(kSim)) return make_sim(words.substr(kSim.size()), serial);
  if (words.starts_with(kReplay)) return make_replay(words.substr(kReplay.size()), serial);
  return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a known board", uri), "--board",
                      "use sim: (for example sim:surface=C), replay:FILE, or replay:FILE,loop=1");
}

}  // namespace tacto::firmware_host
