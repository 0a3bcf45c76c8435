// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/comedi/comedi_device.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

#include "firmware-host/comedi/comedi_card.hpp"
#include "firmware-host/comedi/comedi_player.hpp"
#include "firmware-host/link/code_range.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr double kBuffer_s = 2;      // how long the program may be stopped before samples are lost
constexpr double kSilence_s = 2;     // the card sends nothing: it has failed
constexpr double kClockPairs_s = 1;  // between two readings of both clocks
constexpr double kSameRate = 1e-6;   // relative; below any difference that a card's divider makes
constexpr int kMostTests =
    5;  // comedi(7): a command is accepted after two; more if the driver adapts it again

double host_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class ComediDevice final : public Device {
 public:
  static Result<std::unique_ptr<Device>> open(const std::string& uri, const schema::Wiring& wiring) {
    auto card = open_comedi_card(wiring);
    TACTO_TRY(card);
    auto device = std::make_unique<ComediDevice>();
    device->card_ = std::move(*card);
    Capabilities& about = device->about_;
    about = described(device->card_.get(), wiring, uri);
    about.clock = "device";
    TACTO_TRY(device->find_inputs(wiring));
    TACTO_TRY(device->plan_command(wiring.rate_hz));
    const auto asked_bytes = static_cast<unsigned>(kBuffer_s * about.sample_rate_hz) *
                             static_cast<unsigned>(wiring.inputs.size() * device->sample_bytes_);
    const int most = comedi_get_max_buffer_size(device->card_.get(), device->subdevice_);
    comedi_set_buffer_size(device->card_.get(), device->subdevice_,
                           std::min<unsigned>(asked_bytes, std::max(most, 0)));
    return std::unique_ptr<Device>(std::move(device));
  }

  ~ComediDevice() override {
    if (running_) comedi_cancel(card_.get(), subdevice_);
  }

  const Capabilities& capabilities() const override { return about_; }
  Result<void> start() override {
    comedi_cmd asked = command();
    if (comedi_command(card_.get(), &asked) < 0)
      return fail(ErrorKind::device,
                  fmt::format("the card does not start: {}", comedi_strerror(comedi_errno())), about_.uri,
                  "if another program samples with it, end that program");
    running_ = true;
    waiting_.clear();
    counts_ = {};
    events_ = {};
    next_pair_s_ = 0;
    return {};
  }

  Result<std::size_t> read(std::span<std::int32_t> interleaved) override {
    if (!running_ && waiting_.empty())
      return fail(ErrorKind::device, "the device is not started", about_.uri);
    std::size_t frames = 0;
    while ((frames = take_frames(interleaved)) == 0) TACTO_TRY(receive());
    counts_.clipped += clipped_codes(interleaved.first(frames * inputs_.size()), about_.channels);
    counts_.frames += frames;
    if (const double now_s = host_s(); now_s >= next_pair_s_) {
      const std::uint64_t last = counts_.frames - 1;
      events_.clock_pairs.push_back({last, static_cast<double>(last) / about_.sample_rate_hz, now_s});
      next_pair_s_ = now_s + kClockPairs_s;
    }
    return frames;
  }

  Result<void> stop() override {
    if (std::exchange(running_, false) && comedi_cancel(card_.get(), subdevice_) < 0)
      return fail(ErrorKind::device,
                  fmt::format("the card does not stop: {}", comedi_strerror(comedi_errno())), about_.uri);
    return {};
  }

  StreamCounts counts() const override { return counts_; }
  StreamEvents take_events() override { return std::exchange(events_, {}); }

 private:
  Result<void> find_inputs(const schema::Wiring& wiring) {
    const int found = comedi_find_subdevice_by_type(card_.get(), COMEDI_SUBD_AI, 0);
    const int flags = found < 0 ? 0 : comedi_get_subdevice_flags(card_.get(), static_cast<unsigned>(found));
    if ((flags & SDF_CMD_READ) == 0)
      return fail(
          ErrorKind::unsuitable,
          found < 0 ? "the card has no analog inputs" : "the card's inputs cannot be sampled by its clock",
          wiring.card, "use another card");
    subdevice_ = static_cast<unsigned>(found);
    if ((flags & SDF_LSAMPL) != 0) sample_bytes_ = sizeof(lsampl_t);
    comedi_set_read_subdevice(card_.get(), subdevice_);  // where the card has several
    for (const schema::WiredInput& wired : wiring.inputs) {
      auto input = find_comedi_input(card_.get(), wiring, subdevice_, wired);
      TACTO_TRY(input);
      chanlist_.push_back(input->packed);
      about_.channels.push_back(input->channel);
      inputs_.push_back(std::move(*input));
    }
    return {};
  }

  // The driver changes what it cannot do to the nearest that it can, and says so until nothing is left to
  // change.
  Result<void> plan_command(double rate_hz) {
    const auto refused = [&](const std::string& why) {
      return fail(ErrorKind::unsuitable, why, about_.uri, "ask for another rate, or fewer inputs");
    };
    const auto count = static_cast<unsigned>(inputs_.size());
    const auto period_ns = static_cast<unsigned>(std::lround(1e9 / rate_hz));
    if (comedi_get_cmd_generic_timed(card_.get(), subdevice_, &planned_, count, period_ns) < 0)
      return refused("the card cannot sample at a fixed rate");
    comedi_cmd tested = command();
    tested.stop_src = TRIG_NONE;
    tested.stop_arg = 0;
    tested.scan_end_arg = count;
    int left = 1;
    for (int i = 0; i < kMostTests && left > 0; ++i) left = comedi_command_test(card_.get(), &tested);
    if (left != 0)
      return refused(
          fmt::format("the driver refuses {} inputs at {:g} Hz (step {} of its test)", count, rate_hz, left));
    planned_ = tested;
    const double true_ns = tested.scan_begin_src == TRIG_TIMER
                               ? tested.scan_begin_arg
                               : static_cast<double>(tested.convert_arg) * count;
    about_.sample_rate_hz = 1e9 / true_ns;
    if (std::abs(about_.sample_rate_hz / rate_hz - 1) > kSameRate)
      about_.warnings.push_back(
          fmt::format("the card samples {} inputs at {:.6g} Hz, not at the {:g} Hz of the wiring", count,
                      about_.sample_rate_hz, rate_hz));
    return {};
  }

  comedi_cmd command() {
    comedi_cmd command = planned_;
    command.chanlist = chanlist_.data();
    command.chanlist_len = static_cast<unsigned>(inputs_.size());
    return command;
  }

  // Waits for bytes. The kernel reports with EPIPE that its buffer ran over; the card has then stopped.
  Result<void> receive() {
    pollfd ready{comedi_fileno(card_.get()), POLLIN, 0};
    if (::poll(&ready, 1, static_cast<int>(1e3 * kSilence_s)) == 0)
      return fail(ErrorKind::device, fmt::format("the card has sent no samples for {:g} s", kSilence_s),
                  about_.uri);
    const std::size_t before = waiting_.size();
    waiting_.resize(before + (1U << 16));
    const ssize_t got = ::read(ready.fd, waiting_.data() + before, waiting_.size() - before);
    const int why = errno;
    waiting_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got > 0 || (got < 0 && (why == EINTR || why == EAGAIN))) return {};
    running_ = false;
    const std::string frames = fmt::format("after {} frames", counts_.frames);
    if (got < 0 && why == EPIPE)
      return fail(
          ErrorKind::device,
          fmt::format("the card's buffer ran over {}: the program did not read for longer than it holds",
                      frames),
          about_.uri, "record again, with a lower rate or with less other work on this computer");
    return fail(ErrorKind::device,
                fmt::format("the card ended the sampling {}: {}", frames,
                            got == 0 ? "no reason given" : std::strerror(why)),
                about_.uri, "check the card");
  }

  std::size_t take_frames(std::span<std::int32_t> interleaved) {
    const std::size_t channels = inputs_.size(), frame_bytes = channels * sample_bytes_;
    const std::size_t frames = std::min(interleaved.size() / channels, waiting_.size() / frame_bytes);
    for (std::size_t i = 0; i < frames * channels; ++i) {
      std::uint32_t code =
          0;  // of the host's byte order, which is little-endian on all that Debian calls amd64 and arm64
      std::memcpy(&code, waiting_.data() + i * sample_bytes_, sample_bytes_);
      interleaved[i] = inputs_[i % channels].justified(code);
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(frames * frame_bytes));
    return frames;
  }

  ComediCard card_;
  unsigned subdevice_ = 0;
  std::vector<ComediInput> inputs_;
  std::vector<unsigned> chanlist_;  // of the inputs
  std::size_t sample_bytes_ = sizeof(sampl_t);
  comedi_cmd planned_{};
  Capabilities about_;
  std::vector<std::uint8_t> waiting_;  // received, not yet returned
  bool running_ = false;
  StreamCounts counts_;
  StreamEvents events_;
  double next_pair_s_ = 0;
};

}  // namespace

Result<std::unique_ptr<Device>> open_comedi_device(const std::string& uri, std::string_view parameters) {
  const auto wiring = read_comedi_wiring(uri, parameters);
  TACTO_TRY(wiring);
  return wiring->encoder ? open_comedi_counter(uri, *wiring) : ComediDevice::open(uri, *wiring);
}

}  // namespace tacto::firmware_host
