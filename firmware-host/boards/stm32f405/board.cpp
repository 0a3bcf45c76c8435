// SPDX-License-Identifier: Apache-2.0
// An STM32F405 as a device: USART1 as the link, SysTick as the tick, TIM2 as the encoder's counter, ADC and
// DAC.
//
//   PA9, PA10   USART1 to and from the host, 1,000,000 baud
//   PA0, PA1    encoder A and B
//   PB0, PB1    tangential force, normal force: 0 to 3.3 V
//   PA4         drive: 1.65 V is 0 V at the amplifier's input, 0 and 3.3 V are -5 and +5 V
//   PB12        enable input: 3.3 V through the emergency stop; an open wire reads as open
//   PB13        enable output to the amplifier: high while the device is not idle
#include "firmware-host/boards/stm32f405/registers.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/wire/crc32c.hpp"

inline void* operator new(size_t, void* place) noexcept {
  return place;
}

extern "C" {
extern const uint8_t image_begin, image_check, image_end;  // memory.ld
}

namespace tacto::stm32f405 {
namespace {

constexpr uint32_t kClockHz = 168'000'000, kCrystalHz = 8'000'000, kBaud = 1'000'000;
constexpr uint32_t kWakingPeriod = kClockHz / 1000;
constexpr uint32_t kProfileSamples = 12'000;
constexpr float kDriveFullV = 5;
constexpr uint32_t kPatience = 1'000'000;  // loops; some milliseconds more than any clock needs to start
constexpr uint8_t kChannels = 3;

// Bytes between an interrupt and the main loop; a power of two.
template <uint32_t kSize>
struct ByteRing {
  bool put(uint8_t byte) {
    if (in - out == kSize) return false;
    bytes[in % kSize] = byte;
    in = in + 1;
    return true;
  }
  bool empty() const { return in == out; }
  bool take(uint8_t& byte) {
    if (empty()) return false;
    byte = bytes[out % kSize];
    out = out + 1;
    return true;
  }
  volatile uint32_t in = 0, out = 0;
  uint8_t bytes[kSize];
};

ByteRing<4096> received;
ByteRing<4096> to_send;
volatile bool sending = false;    // the interrupt of the empty sender is on
volatile uint32_t ticks = 0;      // of SysTick, since the rate was set
volatile bool ticking = false;    // otherwise SysTick only wakes the main loop
uint32_t period = kWakingPeriod;  // of SysTick, in periods of the core's clock
uint64_t clock_before = 0;        // when the rate was set
bool emulated = false;            // QEMU: clocks, ports and converters are not there

// QEMU has no reset and clock control: it reads as 0, but on the chip the internal oscillator always runs
// here.
bool is_emulated() {
  return rcc_cr == 0;
}

bool await(const volatile uint32_t& flags, uint32_t mask, uint32_t wanted) {
  for (uint32_t i = 0; i < kPatience; ++i)
    if ((flags & mask) == wanted) return true;
  return false;
}

// 168 MHz from the crystal, or from the internal oscillator of 16 MHz (1 %) if the crystal does not start.
// APB1 at 42, APB2 at 84 MHz; five wait states of the flash.
void start_clocks() {
  if (emulated) return;
  rcc_cr |= 1U << 16;
  const bool crystal = await(rcc_cr, 1U << 17, 1U << 17);
  const uint32_t divider = (crystal ? kCrystalHz : 16'000'000) / 1'000'000;
  flash_acr = 0x700 | 5;
  rcc_pllcfgr = (7U << 24) | (crystal ? 1U << 22 : 0) | (336U << 6) | divider;
  rcc_cr |= 1U << 24;
  await(rcc_cr, 1U << 25, 1U << 25);
  rcc_cfgr = (4U << 13) | (5U << 10) | 2;
  await(rcc_cfgr, 3U << 2, 2U << 2);
}

void drive_zero() {
  dac_value = 2048;
  kPortB.set_reset() = 1U << (13 + 16);
}

void start_ports() {
  rcc_ahb1enr |= 3;                      // ports A and B
  rcc_apb1enr |= (1U << 29) | 1;         // DAC, TIM2
  rcc_apb2enr |= (1U << 8) | (1U << 4);  // ADC1, USART1
  dac_value = 2048;                      // before its pin is connected
  dac_cr = 3;                            // on, without its output buffer, which ends 0.2 V from the rails
  set_mode(kPortA, 4, Mode::analog);
  kPortB.set_reset() = 1U << (13 + 16);
  set_mode(kPortB, 13, Mode::output);
  pull(kPortB, 12, Pull::down);
  set_mode(kPortB, 0, Mode::analog);
  set_mode(kPortB, 1, Mode::analog);
  set_function(kPortA, 0, 1);
  set_function(kPortA, 1, 1);
  set_function(kPortA, 9, 7);
  pull(kPortA, 10, Pull::up);  // no bytes from an open wire
  set_function(kPortA, 10, 7);
}

void start_encoder() {
  tim2_arr = 0xFFFFFFFF;
  tim2_ccmr1 = 0x3131;  // both inputs, filtered over 8 periods of 84 MHz
  tim2_smcr = 3;        // all edges of both
  tim2_cr1 = 1;
}

void start_converter() {
  adc_ccr = 1U << 16;  // 84 / 4 MHz
  adc_smpr2 = (1U << 24) | (1U << 27);
  adc_cr2 = 1;
}

void start_link() {
  usart_brr = kClockHz / 2 / kBaud;
  usart_cr1 = kUsartOn | kSender | kReceiver;
}

void serve_link_by_interrupt() {
  usart_cr1 = usart_cr1 | kReceivedInterrupt;
  scb_shpr3 = 0x10U << 24;  // SysTick below USART1: a byte comes every 10 us, a tick may last longer
  nvic_iser1 = 1U << (kUsart1Interrupt - 32);
}

void set_sending(bool on) {
  if (on == sending) return;
  sending = on;
  usart_cr1 = on ? usart_cr1 | kSendEmptyInterrupt : usart_cr1 & ~kSendEmptyInterrupt;
}

// Called in the interrupt, and with it disabled.
void send_some() {
  uint8_t byte = 0;
  while ((usart_sr & kSendEmpty) != 0) {
    if (!to_send.take(byte)) return set_sending(false);
    usart_dr = byte;
  }
  set_sending(true);
}

// 12 bits of ADC1, left-justified around its middle.
bool convert(uint32_t channel, int32_t& code) {
  adc_sqr3 = channel;
  adc_sr = 0;
  adc_cr2 = (1U << 30) | 1;
  for (uint32_t i = 0; (adc_sr & 2) == 0; ++i)
    if (i > 1000) return false;
  code = static_cast<int32_t>((adc_dr - 2048) << 20);
  return true;
}

// In QEMU a finger moves back and forth over 30,000 counts, 20 counts per tick, and the codes contain the
// tick.
int32_t emulated_count() {
  const uint32_t at = ticks * 20 % 60'000;
  return static_cast<int32_t>(at < 30'000 ? at : 60'000 - at);
}

uint64_t clock() {
  uint32_t before = 0, left = 0;
  do {
    before = ticks;
    left = syst_cvr;
  } while (before != ticks);
  return clock_before + uint64_t{before} * period + (period - 1 - left);
}

// Without ticks SysTick wakes the main loop every millisecond, for the watchdog.
void set_rate(uint32_t rate_millihertz) {
  syst_csr = 0;
  clock_before = clock();
  ticks = 0;
  ticking = rate_millihertz != 0;
  period = kWakingPeriod;
  // 168e9 mHz / rate, rounded, without a division of 64 bits: 40 x 4.2e9 = 168e9.
  constexpr uint32_t kPart = 4'200'000'000;
  static_assert(uint64_t{kPart} * 40 == uint64_t{kClockHz} * 1000);
  if (ticking)
    period =
        kPart / rate_millihertz * 40 + (kPart % rate_millihertz * 40 + rate_millihertz / 2) / rate_millihertz;
  syst_rvr = period - 1;
  syst_cvr = 0;
  syst_csr = 7;
}

core::Hal make_hal() {
  core::Hal hal;
  hal.read_encoder = [](void*) noexcept {
    return emulated ? emulated_count() : static_cast<int32_t>(tim2_cnt);
  };
  hal.read_channels = [](void*, int32_t* codes) noexcept {
    codes[0] = emulated ? emulated_count() : static_cast<int32_t>(tim2_cnt);
    if (emulated) {
      codes[1] = static_cast<int32_t>(ticks << 12);
      codes[2] = static_cast<int32_t>(~ticks << 12);
      return true;
    }
    return convert(8, codes[1]) && convert(9, codes[2]);
  };
  hal.write_drive = [](void*, float volts) noexcept {
    const float code = 2048.5F + volts * (2047 / kDriveFullV);  // rounded
    dac_value = static_cast<uint32_t>(code < 0 ? 0 : code > 4095 ? 4095 : code);
  };
  hal.enable_closed = [](void*) noexcept { return emulated || (kPortB.input() & (1U << 12)) != 0; };
  hal.clock = [](void*) noexcept { return clock(); };
  hal.set_rate = [](void*, uint32_t rate) noexcept { set_rate(rate); };
  hal.receive = [](void*, uint8_t* bytes, size_t capacity) noexcept {
    size_t size = 0;
    while (size < capacity && received.take(bytes[size])) ++size;
    return size;
  };
  hal.send = [](void*, const uint8_t* bytes, size_t size) noexcept {
    size_t accepted = 0;
    while (accepted < size && to_send.put(bytes[accepted])) ++accepted;
    return accepted;
  };
  hal.restart = [](void*) noexcept {
    drive_zero();
    scb_aircr = 0x05FA0004;
  };
  return hal;
}

template <size_t kSize>
void put(char (&field)[kSize], const char* text) {
  for (size_t i = 0; i + 1 < kSize && text[i] != 0; ++i) field[i] = text[i];
}

void put_serial(char (&field)[32]) {
  if (emulated) return put(field, "qemu");
  for (uint32_t i = 0; i < 24; ++i)
    field[i] = "0123456789abcdef"[at(kUniqueId + 4 * (i / 8)) >> (28 - 4 * (i % 8)) & 15];
}

uint32_t stored_check() {
  return at(reinterpret_cast<uint32_t>(&image_check));
}

// As eight digits, behind what is in the field; image.py prints the same.
void put_build(char (&field)[24]) {
  put(field, TACTO_VERSION " build ");
  size_t at = sizeof TACTO_VERSION " build " - 1;
  for (uint32_t i = 0; i < 8; ++i) field[at++] = "0123456789abcdef"[stored_check() >> (28 - 4 * i) & 15];
  static_assert(sizeof TACTO_VERSION " build " + 8 <= sizeof field);
}

wire::Channel channel(uint8_t index, const char* name, const char* unit, double scale, const char* source) {
  wire::Channel about{};
  about.index = index;
  put(about.name, name);
  put(about.quantity, name);
  put(about.unit, unit);
  put(about.source, source);
  about.scale = scale;
  about.range_min = about.range_max = about.native_rate_hz = __builtin_nan("");
  return about;
}

wire::Note note(uint8_t index, wire::NoteKind kind, const char* text) {
  wire::Note about{};
  about.index = index;
  about.kind = kind;
  put(about.text, text);
  return about;
}

wire::Channel channels[kChannels];
wire::Note notes[2];
float profile_memory[kProfileSamples];

// A code of 2^31 is 1.65 V at the pin. The normal force is a load cell of 10 N there; `calibrate` measures
// its scale. The transducer is that of RIG.md.
core::Board make_board() {
  channels[0] = channel(0, "position", "m", 1e-6, "encoder");
  channels[1] = channel(1, "tangential_force", "V", 1.65 / 2147483648.0, "adc 8");
  channels[2] = channel(2, "normal_force", "N", 10 / 2147483648.0, "adc 9");
  core::Board board;
  put(board.about.name, "stm32f405");
  put_serial(board.about.serial);
  put_build(board.about.firmware);
  board.about.features = wire::kFeatureDrive | wire::kFeatureEnableInput;
  board.about.clock_hz = kClockHz;
  board.about.default_rate_millihertz = 2'000'000;
  board.about.least_rate_millihertz = 500'000;
  board.about.most_rate_millihertz = 5'000'000;
  board.about.drive_limit_v = kDriveFullV;
  board.about.slew_limit_v_per_s = 15'000;
  board.channels = channels;
  board.channel_count = kChannels;
  board.profile_memory = profile_memory;
  board.profile_samples = kProfileSamples;
  board.notes = notes;
  board.note_count = 1;
  notes[0] = note(0, wire::NoteKind::transducer, "wiertlewski2011");
  if (!emulated) return board;
  board.about.features |= wire::kFeatureSimulated;
  board.note_count = 2;
  notes[1] = note(1, wire::NoteKind::simulated_by, "QEMU: encoder and converters are simulated");
  return board;
}

core::Firmware* firmware = nullptr;

// RM0090, 21.3: 400 periods of the internal 32 kHz / 4 are 50 ms; at the oscillator's limits 34 to 94 ms.
void start_watchdog() {
  iwdg_kr = 0x5555;
  iwdg_pr = 0;
  iwdg_rlr = 400;
  iwdg_kr = 0xCCCC;
}

// The check covers all of the image but its own word, which firmware-host/boards/image.py writes.
bool flash_is_intact() {
  const uint32_t before = wire::crc32c(&image_begin, static_cast<size_t>(&image_check - &image_begin));
  const uint8_t* const after = &image_check + sizeof(uint32_t);
  return wire::crc32c(after, static_cast<size_t>(&image_end - after), before) == stored_check();
}

// Answers every byte with a text, which the host shows as the first bytes of a device without the wire.
[[noreturn]] void refuse(const char* text) {
  for (;;) {
    while ((usart_sr & (kReceived | kOverrun)) == 0) {
    }
    static_cast<void>(usart_dr);
    for (const char* next = text; *next != 0; ++next) {
      while ((usart_sr & kSendEmpty) == 0) {
      }
      usart_dr = static_cast<uint8_t>(*next);
    }
  }
}

void set_enable(bool on) {
  kPortB.set_reset() = on ? 1U << 13 : 1U << (13 + 16);
}

// With interrupts disabled, so that none comes between the question and the sleep; a pending one ends it.
// QEMU receives a byte only between accesses to registers: beside a program that never sleeps, it takes 4 ms
// for each byte on a busy computer, so that the host gives up; with this one 0.2 ms.
void sleep_until_interrupt() {
  asm volatile("cpsid i" ::: "memory");
  if (!sending) send_some();
  if (received.empty()) asm volatile("wfi" ::: "memory");
  asm volatile("cpsie i" ::: "memory");
}

}  // namespace

// The watchdog restarts a chip whose main loop or SysTick stands still.
[[noreturn]] void serve() {
  emulated = is_emulated();
  start_clocks();
  start_ports();
  start_link();
  if (!flash_is_intact()) refuse("flash check failed; flash again");
  start_encoder();
  start_converter();
  alignas(core::Firmware) static uint8_t memory[sizeof(core::Firmware)];
  firmware = new (memory) core::Firmware(make_board(), make_hal());
  set_rate(0);
  serve_link_by_interrupt();
  start_watchdog();
  for (uint32_t fed = ticks;;) {
    firmware->poll();
    set_enable(firmware->drive_state() != wire::DriveState::idle);
    if (fed != ticks) iwdg_kr = 0xAAAA;
    fed = ticks;
    sleep_until_interrupt();
  }
}

}  // namespace tacto::stm32f405

extern "C" {
[[noreturn]] void run() {
  tacto::stm32f405::serve();
}

void systick_handler() {
  using namespace tacto::stm32f405;
  ticks = ticks + 1;
  if (ticking) firmware->tick();
}

// A byte that came too late for the register is lost, and noticed by the check of its frame. Reading the
// data clears both flags (RM0090, 30.6.1), also that of a lost byte alone, whose interrupt would never end.
void usart1_handler() {
  using namespace tacto::stm32f405;
  for (uint32_t status = 0; ((status = usart_sr) & (kReceived | kOverrun)) != 0;) {
    const auto byte = static_cast<uint8_t>(usart_dr);
    if ((status & kReceived) != 0) received.put(byte);
  }
  if (sending) send_some();
}

// The watchdog then restarts the device.
[[noreturn]] void fault_handler() {
  tacto::stm32f405::drive_zero();
  for (;;) {
  }
}
}
