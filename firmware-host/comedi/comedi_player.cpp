// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/comedi/comedi_player.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "data-schema/base/statistics.hpp"
#include "firmware-host/comedi/comedi_card.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/kernel/ring.hpp"
#include "firmware-host/link/awake_cores.hpp"
#include "firmware-host/link/code_range.hpp"
#include "firmware-host/link/hosted_board.hpp"
#include "firmware-host/link/memory_transport.hpp"
#include "firmware-host/link/realtime_priority.hpp"
#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/link/wire_fields.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr int kTickPriority = 50;  // as of the loop on the host
// Slower, the drive would need more than 20 ms to fall: core/firmware/drive_supervisor.hpp.
constexpr double kLeastRate_hz = 1000, kMostRate_hz = 20000, kRateStep_hz = 100;
constexpr double kInstructionShare = 0.5;  // of a period; the rest is for the kernel and for delays
constexpr int kTrials = 200;
constexpr double kFall_s = 0.025;
constexpr auto kCoreRest = std::chrono::microseconds(200);
constexpr std::size_t kMostInputs = wire::kMaxChannels - 1;

// A frame that was sampled by instructions.
struct CountedFrame {
  std::uint64_t number = 0;  // periods since the start
  double at_s = 0;           // of the steady clock
  std::int32_t codes[wire::kMaxChannels] = {};
};
using CountedFrames =
    core::Ring<CountedFrame, 1U << 15>;  // 1.6 s or more: so long the program may be stopped

// One thread ticks and polls, or samples.
class ComediBoard {
 public:
  static Result<std::unique_ptr<ComediBoard>> open(const schema::Wiring& wiring) {
    auto card = open_comedi_card(wiring);
    TACTO_TRY(card);
    std::unique_ptr<ComediBoard> board(new ComediBoard(std::move(*card), wiring));
    TACTO_TRY(board->find_output());
    TACTO_TRY(board->find_watchdog());
    TACTO_TRY(board->find_position());
    TACTO_TRY(board->find_inputs());
    TACTO_TRY(board->measure_rate());
    board->firmware_ = std::make_unique<core::Firmware>(board->about(), board->hal());
    board->thread_ = std::thread([&self = *board] { self.run(); });
    return board;
  }
  /// Without output, watchdog and core.
  static Result<std::unique_ptr<ComediBoard>> open_to_record(const schema::Wiring& wiring) {
    auto card = open_comedi_card(wiring);
    TACTO_TRY(card);
    std::unique_ptr<ComediBoard> board(new ComediBoard(std::move(*card), wiring));
    board->wiring_.output.reset();
    board->wiring_.watchdog.reset();
    board->frames_ = std::make_unique<CountedFrames>();
    TACTO_TRY(board->find_position());
    TACTO_TRY(board->find_inputs());
    TACTO_TRY(board->measure_rate());
    return board;
  }
  ComediBoard(const ComediBoard&) = delete;
  ComediBoard& operator=(const ComediBoard&) = delete;
  ~ComediBoard() { end(); }
  void end() {
    ending_.store(true);
    if (thread_.joinable()) thread_.join();
  }

  CoreLink& link() { return link_; }
  comedi_t* card() const { return card_.get(); }
  const std::vector<schema::Channel>& channels() const { return channels_; }
  double most_rate_hz() const { return most_rate_hz_; }
  /// Of a board that records: samples until end(). What was left in the queue is gone.
  void begin(double rate_hz) {
    ending_.store(false);
    frames_->clear();
    thread_ = std::thread([this, rate_hz] { sample(rate_hz); });
  }
  CountedFrames& frames() { return *frames_; }
  /// The library's number of the first instruction's error; 0: none.
  int failure() const { return failure_.load(); }

 private:
  ComediBoard(ComediCard card, const schema::Wiring& wiring) : wiring_(wiring), card_(std::move(card)) {}
  static ComediBoard& of(void* board) noexcept { return *static_cast<ComediBoard*>(board); }

  tl::unexpected<schema::Error> refused(const std::string& what) const {
    return fail(ErrorKind::device, fmt::format("{}: {}", what, comedi_strerror(comedi_errno())), wiring_.card,
                "if another program uses the card, end that program");
  }

  // Nothing else may write to the output while this board exists.
  Result<void> find_output() {
    const schema::WiredOutput& wired = *wiring_.output;
    const auto subdevice = find_comedi_channel(card_.get(), wiring_, {COMEDI_SUBD_AO}, std::nullopt,
                                               wired.output, "analog output");
    TACTO_TRY(subdevice);
    output_ = *subdevice;
    const auto range = comedi_range_of(card_.get(), wiring_, output_, wired.output, wired.range_from_v,
                                       wired.range_to_v, fmt::format("output {}", wired.output));
    TACTO_TRY(range);
    output_range_ = *range;
    output_most_ = comedi_get_maxdata(card_.get(), output_, wired.output);
    codes_per_volt_ = output_most_ / (wired.range_to_v - wired.range_from_v);
    if (comedi_lock(card_.get(), output_) < 0) return refused("the output cannot be reserved");
    write_drive(0);
    return check("the output cannot be set to 0 V");
  }

  Result<void> find_watchdog() {
    if (!wiring_.watchdog) return {};
    const auto subdevice =
        find_comedi_channel(card_.get(), wiring_, {COMEDI_SUBD_DIO, COMEDI_SUBD_DO},
                            wiring_.watchdog->subdevice, wiring_.watchdog->line, "digital output");
    TACTO_TRY(subdevice);
    watchdog_ = *subdevice;
    if (comedi_get_subdevice_type(card_.get(), *watchdog_) == COMEDI_SUBD_DIO &&
        comedi_dio_config(card_.get(), *watchdog_, wiring_.watchdog->line, COMEDI_OUTPUT) < 0)
      return refused(fmt::format("line {} cannot be an output", wiring_.watchdog->line));
    write_watchdog(0);
    return check("the watchdog's line cannot be set");
  }

  Result<void> find_position() {
    if (!wiring_.encoder) return {};
    const schema::WiredEncoder& wired = *wiring_.encoder;
    const auto subdevice = find_comedi_channel(card_.get(), wiring_, {COMEDI_SUBD_COUNTER}, wired.subdevice,
                                               wired.counter, "counter");
    TACTO_TRY(subdevice);
    counter_ = *subdevice;
    counter_most_ = comedi_get_maxdata(card_.get(), *counter_, wired.counter);
    if (std::string_view(comedi_get_driver_name(card_.get())).starts_with("ni_"))
      TACTO_TRY(start_ni_counter());
    schema::Channel& channel = channels_.emplace_back();
    channel.name = channel.quantity = "position";
    channel.unit = "m";
    channel.scale = wired.step_m;
    channel.source = fmt::format("counter {}, encoder", wired.counter);
    read_position();
    count_ = 0;
    return check("the counter cannot be read");
  }

  // As comedilib's demo gpct_encoder.c: all four edges, without index. Cards with fixed inputs (660x) refuse
  // other sources.
  Result<void> start_ni_counter() {
    comedi_t* const card = card_.get();
    const schema::WiredEncoder& wired = *wiring_.encoder;
    const unsigned counter = wired.counter;
    comedi_reset_channel(card, *counter_, counter);
    for (const unsigned gate : {0U, 1U})
      comedi_set_gate_source(card, *counter_, counter, gate, NI_GPCT_DISABLED_GATE_SELECT);
    for (const auto& [source, pfi] :
         {std::pair{NI_GPCT_SOURCE_ENCODER_A, wired.pfi_a}, std::pair{NI_GPCT_SOURCE_ENCODER_B, wired.pfi_b}})
      if (pfi &&
          comedi_set_other_source(card, *counter_, counter, source, NI_GPCT_PFI_OTHER_SELECT(*pfi)) < 0)
        return refused(fmt::format("PFI {} cannot be an input of the counter", *pfi));
    constexpr unsigned kQuadrature =
        NI_GPCT_COUNTING_MODE_QUADRATURE_X4_BITS | NI_GPCT_COUNTING_DIRECTION_HW_UP_DOWN_BITS;
    if (comedi_set_counter_mode(card, *counter_, counter, kQuadrature) < 0 ||
        comedi_arm_channel(card, *counter_, counter, NI_GPCT_ARM_IMMEDIATE) < 0)
      return refused("the counter cannot count an encoder");
    return {};
  }

  // Without an encoder the first input with the position takes its place: its codes are the counts, and 0 is
  // at 0 m.
  Result<void> find_inputs() {
    if (wiring_.inputs.size() > kMostInputs)
      return fail(ErrorKind::unsuitable, fmt::format("the wiring has {} inputs", wiring_.inputs.size()),
                  wiring_.name, fmt::format("beside an encoder, or to play, use at most {}", kMostInputs));
    const auto subdevice =
        find_comedi_channel(card_.get(), wiring_, {COMEDI_SUBD_AI}, std::nullopt, 0, "analog input");
    TACTO_TRY(subdevice);
    analog_input_ = *subdevice;
    for (const schema::WiredInput& wired : wiring_.inputs) {
      auto input = find_comedi_input(card_.get(), wiring_, analog_input_, wired);
      TACTO_TRY(input);
      if (!counter_ && !position_input_ && wired.quantity == "position") {
        const double step_m = *wired.per_volt * input->code_v;
        if (step_m < 0)
          return fail(ErrorKind::unsuitable, "the position grows against its voltage", wiring_.name,
                      "exchange the sensor's wires, and give per_volt without its sign");
        position_input_ = inputs_.size();
        origin_ = std::lround((*wired.per_volt * wired.range_from_v + wired.at_zero_volt) / step_m);
        input->channel.scale = step_m;
        input->channel.offset = 0;
      }
      channels_.push_back(input->channel);
      inputs_.push_back(std::move(*input));
    }
    codes_.resize(inputs_.size());
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      readings_.push_back({INSN_READ, 1, &codes_[i], analog_input_, inputs_[i].packed, {}});
    return {};
  }

  // All instructions that a tick can need, with the output at 0 V and the watchdog still.
  Result<void> measure_rate() {
    std::vector<std::int64_t> times_ns;
    std::vector<std::int32_t> codes(channels_.size());
    for (int i = 0; i < kTrials && failure() == 0; ++i) {
      const std::int64_t began_ns = TickClock::now_ns();
      read_position();
      read_channels(codes.data());
      write_drive(0);
      if (watchdog_) write_watchdog(0);
      times_ns.push_back(TickClock::now_ns() - began_ns);
    }
    TACTO_TRY(check("the card refuses an instruction"));
    const double tick_s = 1e-9 * static_cast<double>(schema::upper_median(std::span(times_ns)));
    most_rate_hz_ =
        std::min(kMostRate_hz, std::floor(kInstructionShare / tick_s / kRateStep_hz) * kRateStep_hz);
    if (most_rate_hz_ >= kLeastRate_hz) return {};
    return fail(
        ErrorKind::unsuitable,
        fmt::format("the card is too slow: the instructions of a tick take {:.3g} ms", 1e3 * tick_s),
        wiring_.card,
        fmt::format("they may take {:g} ms at {:g} ticks per second: use fewer inputs, or another card",
                    1e3 * kInstructionShare / kLeastRate_hz, kLeastRate_hz));
  }

  Result<void> check(const char* what) const {
    if (failure() == 0) return {};
    return fail(ErrorKind::device, fmt::format("{}: {}", what, comedi_strerror(failure())), wiring_.card,
                "check the card, its driver and the wiring");
  }

  core::Board about() {
    wire::Welcome welcome;
    const Capabilities said = described(card_.get(), wiring_, {});
    put_text(welcome.name, said.name);
    put_text(welcome.serial, said.serial);
    put_text(welcome.firmware,  // shorter, because it has 23 characters
             fmt::format("{} {}", comedi_get_driver_name(card_.get()), comedi_version(card_.get())));
    welcome.features = wire::kFeatureDrive;
    welcome.clock_hz = 1'000'000'000;
    welcome.drive_limit_v = not_above(wiring_.transducer->drive_limit_v);
    welcome.slew_limit_v_per_s = not_above(wiring_.transducer->slew_limit_v_per_s);
    welcome.least_rate_millihertz = millihertz(kLeastRate_hz);
    welcome.most_rate_millihertz = millihertz(most_rate_hz_);
    welcome.default_rate_millihertz = millihertz(std::clamp(wiring_.rate_hz, kLeastRate_hz, most_rate_hz_));
    messages_ = wire_channels(channels_);
    notes_ = {note_of(wire::NoteKind::transducer, wiring_.transducer_file)};
    return board_of(welcome, messages_, notes_, profile_);
  }

  core::Hal hal() {
    core::Hal hal;
    hal.board = this;
    hal.read_encoder = [](void* b) noexcept { return of(b).read_position(); };
    hal.encoder_unseen = [](void* b) noexcept { return of(b).missed_; };
    hal.read_channels = [](void* b, std::int32_t* codes) noexcept { return of(b).read_channels(codes); };
    hal.write_drive = [](void* b, float volts) noexcept { of(b).write_drive(volts); };
    hal.enable_closed = [](void* b) noexcept { return of(b).enabled_ && of(b).failure() == 0; };
    hal.clock = [](void* b) noexcept { return static_cast<std::uint64_t>(of(b).now_ns_ - of(b).began_ns_); };
    hal.set_rate = [](void* b, std::uint32_t rate) noexcept {
      of(b).rate_millihertz_ = rate;
      of(b).begins_ = true;
      of(b).write_drive(0);
    };
    hal.receive = [](void* b, std::uint8_t* bytes, std::size_t size) noexcept {
      return of(b).link_.to_core.take({bytes, size});
    };
    hal.send = [](void* b, const std::uint8_t* bytes, std::size_t size) noexcept {
      return of(b).link_.from_core.put({bytes, size});
    };
    hal.restart = [](void*) noexcept {};
    return hal;
  }

  // In the tick. An instruction is a system call; nothing here allocates or locks. After the first that fails
  // the drive falls, and the watchdog rests.
  bool done(bool good) noexcept {
    const int why = comedi_errno();
    int none = 0;
    if (!good) failure_.compare_exchange_strong(none, why != 0 ? why : EIO);
    return good;
  }

  std::int32_t read_position() noexcept {
    lsampl_t code = 0;
    if (counter_) {
      if (!done(comedi_data_read(card_.get(), *counter_, wiring_.encoder->counter, 0, 0, &code) >= 0))
        return count_;
      // The counter wraps; half of its range is never passed between two ticks.
      const std::uint32_t way = (code - counted_) & counter_most_;
      const std::uint32_t step = way > counter_most_ / 2 ? way - counter_most_ - 1 : way;
      count_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(count_) + step);
      counted_ = code;
    } else if (unsigned packed = inputs_[*position_input_].packed;
               done(comedi_data_read(card_.get(), analog_input_, CR_CHAN(packed), CR_RANGE(packed),
                                     CR_AREF(packed), &code) >= 0)) {
      count_ = count_of(code);
    }
    return count_;
  }
  std::int32_t count_of(lsampl_t code) const noexcept {
    return static_cast<std::int32_t>(static_cast<std::int64_t>(code) + origin_);
  }

  bool read_channels(std::int32_t* codes) noexcept {
    comedi_insnlist list{static_cast<unsigned>(readings_.size()), readings_.data()};
    if (!done(comedi_do_insnlist(card_.get(), &list) == static_cast<int>(readings_.size()))) return false;
    if (counter_) *codes++ = count_;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      codes[i] = i == position_input_ ? count_of(codes_[i]) : inputs_[i].justified(codes_[i]);
    return true;
  }

  void write_drive(float volts) noexcept {
    if (!wiring_.output) return;
    const schema::WiredOutput& wired = *wiring_.output;
    const double code = std::round((volts - wired.range_from_v) * codes_per_volt_);
    const auto held = static_cast<lsampl_t>(std::clamp(code, 0.0, static_cast<double>(output_most_)));
    done(comedi_data_write(card_.get(), output_, wired.output, output_range_, AREF_GROUND, held) >= 0);
  }

  void write_watchdog(unsigned level) noexcept {
    done(comedi_dio_write(card_.get(), *watchdog_, wiring_.watchdog->line, level) >= 0);
  }

  void tick(std::int64_t late_ns) noexcept {
    now_ns_ = TickClock::now_ns();
    missed_ = static_cast<std::uint32_t>(std::max<std::int64_t>(late_ns, 0) / clock_.period_ns());
    firmware_->tick();
    level_ ^= 1U;
    if (watchdog_ && failure() == 0) write_watchdog(level_);
  }

  // The real-time thread. At the end, whatever its reason, the drive falls as after a fault.
  void run() noexcept {
    const RealtimePriority priority(kTickPriority);
    std::optional<AwakeCores> awake;
    now_ns_ = began_ns_ = TickClock::now_ns();
    std::uint64_t missed = 0;
    while (!ending_.load(std::memory_order_relaxed)) {
      if (rate_millihertz_ == 0) {
        awake.reset();
        std::this_thread::sleep_for(kCoreRest);
        now_ns_ = TickClock::now_ns();
      } else {
        if (!awake) awake.emplace();
        if (std::exchange(begins_, false)) clock_.begin(1e-3 * rate_millihertz_);
        tick(clock_.wait(missed));
      }
      firmware_->poll();
    }
    enabled_ = false;
    for (std::int64_t end_ns = TickClock::now_ns() + static_cast<std::int64_t>(1e9 * kFall_s);
         rate_millihertz_ > 0 && TickClock::now_ns() < end_ns;)
      tick(clock_.wait(missed));
    write_drive(0);
  }

  // The real-time thread of a recording. A period that is missed is skipped; so is a frame for which there is
  // no room.
  void sample(double rate_hz) noexcept {
    const RealtimePriority priority(kTickPriority);
    const AwakeCores awake;
    clock_.begin(rate_hz);
    std::uint64_t missed = 0;
    for (std::uint64_t number = 0; !ending_.load(std::memory_order_relaxed) && failure() == 0; ++number) {
      const std::uint64_t before = missed;
      clock_.wait(missed);
      number += missed - before;
      CountedFrame* const frame = frames_->place();
      if (frame == nullptr) continue;
      frame->number = number;
      frame->at_s = 1e-9 * static_cast<double>(TickClock::now_ns());
      read_position();
      if (read_channels(frame->codes)) frames_->push();
    }
  }

  schema::Wiring wiring_;
  ComediCard card_;
  unsigned output_ = 0, output_range_ = 0, analog_input_ = 0;  // subdevices, and an index
  lsampl_t output_most_ = 0, counter_most_ = 0, counted_ = 0;
  double codes_per_volt_ = 0, most_rate_hz_ = 0;
  std::optional<unsigned> watchdog_, counter_;  // subdevices
  std::optional<std::size_t> position_input_;
  std::int64_t origin_ = 0;
  std::vector<ComediInput> inputs_;
  std::vector<lsampl_t> codes_;
  std::vector<comedi_insn> readings_;
  std::vector<schema::Channel> channels_;
  std::vector<wire::Channel> messages_;
  std::vector<wire::Note> notes_;
  HostedProfile profile_;
  CoreLink link_;
  std::unique_ptr<CountedFrames> frames_;  // of a recording
  std::atomic<int> failure_{0};
  std::atomic<bool> ending_{false};
  // Of the real-time thread.
  TickClock clock_;
  std::int32_t count_ = 0;
  std::uint32_t missed_ = 0, rate_millihertz_ = 0;
  unsigned level_ = 0;
  std::int64_t now_ns_ = 0, began_ns_ = 0;
  bool begins_ = false, enabled_ = true;
  std::unique_ptr<core::Firmware> firmware_;
  std::thread thread_;
};

class ComediTransport final : public MemoryTransport {
 public:
  ComediTransport(std::unique_ptr<ComediBoard> board, std::string uri)
      : MemoryTransport(board->link(), uri), board_(std::move(board)), uri_(std::move(uri)) {}
  Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override {
    auto got = MemoryTransport::read(bytes, timeout_s);
    if (const int why = board_->failure(); why != 0)
      return fail(ErrorKind::device, fmt::format("the card refuses an instruction: {}", comedi_strerror(why)),
                  uri_, "check the card and its driver, and whether the amplifier is still enabled");
    return got;
  }

 private:
  std::unique_ptr<ComediBoard> board_;
  std::string uri_;
};

// Records with the encoder at a counter.
class CountedDevice final : public Device {
 public:
  static Result<std::unique_ptr<Device>> open(const std::string& uri, const schema::Wiring& wiring) {
    auto board = ComediBoard::open_to_record(wiring);
    TACTO_TRY(board);
    auto device = std::make_unique<CountedDevice>();
    device->board_ = std::move(*board);
    Capabilities& about = device->about_;
    about = described(device->board_->card(), wiring, uri);
    about.clock = "host";
    about.channels = device->board_->channels();
    const double possible_hz = std::min(wiring.rate_hz, device->board_->most_rate_hz());
    about.sample_rate_hz = 1e9 / std::floor(1e9 / possible_hz);  // whole nanoseconds, as TickClock has them
    about.warnings.push_back(
        fmt::format("sampled by instructions, at the times of this computer, because a card's clock does not "
                    "sample the counter of the encoder: {:.6g} Hz{}",
                    about.sample_rate_hz,
                    possible_hz < wiring.rate_hz ? fmt::format(", not {:g} Hz", wiring.rate_hz) : ""));
    return std::unique_ptr<Device>(std::move(device));
  }

  const Capabilities& capabilities() const override { return about_; }
  Result<void> start() override {
    board_->end();
    counts_ = {};
    events_ = {};
    next_number_ = 0;
    next_pair_s_ = 0;
    started_ = true;
    board_->begin(about_.sample_rate_hz);
    return {};
  }

  Result<std::size_t> read(std::span<std::int32_t> interleaved) override {
    if (!started_) return fail(ErrorKind::device, "the device is not started", about_.uri);
    const std::size_t channels = about_.channels.size(), room = interleaved.size() / channels;
    std::size_t frames = 0;
    while (frames == 0 && room > 0) {
      const int why = board_->failure();  // read first: all frames before it are in the queue
      const CountedFrame* front = nullptr;
      while (frames < room && (front = board_->frames().front()) != nullptr) {
        if (front->number != next_number_) {
          if (frames > 0) break;
          add_gap(front->number);
        }
        std::copy_n(front->codes, channels,
                    interleaved.begin() + static_cast<std::ptrdiff_t>(frames * channels));
        note_clock(*front);
        ++next_number_;
        ++frames;
        board_->frames().pop();
      }
      if (frames > 0) break;
      if (why != 0)
        return fail(ErrorKind::device,
                    fmt::format("the card refuses an instruction: {}", comedi_strerror(why)), about_.uri,
                    "check the card and its driver");
      std::this_thread::sleep_for(kCountedWait);
    }
    counts_.clipped += clipped_codes(interleaved.first(frames * channels), about_.channels);
    counts_.frames += frames;
    return frames;
  }

  Result<void> stop() override {
    board_->end();
    started_ = false;
    return {};
  }
  StreamCounts counts() const override { return counts_; }
  StreamEvents take_events() override { return std::exchange(events_, {}); }

 private:
  void add_gap(std::uint64_t number) {
    events_.gaps.push_back({counts_.frames, number, number - next_number_});
    counts_.lost_frames += number - next_number_;
    next_number_ = number;
  }
  void note_clock(const CountedFrame& frame) {
    if (frame.at_s < next_pair_s_) return;
    next_pair_s_ = frame.at_s + 1;
    events_.clock_pairs.push_back(
        {frame.number, static_cast<double>(frame.number) / about_.sample_rate_hz, frame.at_s});
  }

  static constexpr auto kCountedWait = std::chrono::milliseconds(2);
  std::unique_ptr<ComediBoard> board_;
  Capabilities about_;
  StreamCounts counts_;
  StreamEvents events_;
  std::uint64_t next_number_ = 0;
  double next_pair_s_ = 0;
  bool started_ = false;
};

Result<void> check_wired(const schema::Wiring& wiring, const std::string& uri, bool without_watchdog) {
  if (!wiring.output)
    return fail(ErrorKind::unsuitable, "the wiring names no output", uri,
                R"(add for example "output": {"output": 0, "range_v": [-10, 10]})");
  if (!wiring.encoder &&
      std::ranges::none_of(wiring.inputs, [](const auto& input) { return input.quantity == "position"; }))
    return fail(ErrorKind::unsuitable, "the wiring names no encoder, and no input with the position", uri,
                R"(add for example "encoder": {"counter": 0, "step_m": 1e-6})");
  if (wiring.watchdog || without_watchdog) return {};
  return fail(ErrorKind::unsuitable,
              "the wiring names no watchdog, and the card keeps its last voltage if this program dies", uri,
              R"(wire a one-shot to a digital line (firmware-host/RIG.md) and add "watchdog": {"line": 0}; )"
              "or play with --no-watchdog, with the amplifier's switch in reach");
}

}  // namespace

Result<std::unique_ptr<Device>> open_comedi_counter(const std::string& uri, const schema::Wiring& wiring) {
  return CountedDevice::open(uri, wiring);
}

Result<std::unique_ptr<Device>> open_comedi_to_play(const std::string& uri, std::string_view parameters,
                                                    bool without_watchdog) {
  auto wiring = read_comedi_wiring(uri, parameters);
  TACTO_TRY(wiring);
  if (without_watchdog) wiring->watchdog.reset();
  TACTO_TRY(check_wired(*wiring, uri, without_watchdog));
  auto board = ComediBoard::open(*wiring);
  TACTO_TRY(board);
  return WireDevice::open(uri, std::make_unique<ComediTransport>(std::move(*board), uri));
}

}  // namespace tacto::firmware_host
