// SPDX-License-Identifier: Apache-2.0
// An STM32F405 as a device: USART1 as the link, SysTick as the tick, TIM2 as the encoder's counter, ADC and
// DAC.
//
//   PA9, PA10   USART1 to and from the host, 1,000,000 baud
//   PA0, PA1    encoder A and B
//   PB0, PB1    tangential force, normal force: 0 to 3.3 V
//   PA6         displacement of the tray: 0 to 3.3 V; PB14 to ground while its sensor is connected
//   PA4         drive: 1.65 V is 0 V at the amplifier's input, 0 and 3.3 V are -5 and +5 V
//   PB12        enable input: 3.3 V through the emergency stop; an open wire reads as open
//   PB13        enable output to the amplifier: high while the device is not idle
#include "firmware-host/boards/shared/tick_timer.hpp"
#include "firmware-host/boards/shared/tray_board.hpp"
#include "firmware-host/boards/stm32f405/emulated_tray.hpp"
#include "firmware-host/boards/stm32f405/registers.hpp"
#include "firmware-host/core/firmware/firmware.hpp"

namespace tacto::stm32f405 {
namespace {

using namespace boards;

constexpr const Board& kRow = *board_named("stm32f405");
constexpr uint32_t kClockHz = kRow.clock_hz, kCrystalHz = 8'000'000, kBaud = 1'000'000;

Bytes received, to_send;
volatile bool sending = false;  // the interrupt of the empty sender is on
TickTimer<kClockHz> timer;
bool emulated = false;  // QEMU: clocks, ports and converters are not there
EmulatedTray emulated_tray;
bool has_tray_sensor = false;

// QEMU has no reset and clock control: it reads as 0, but on the chip the internal oscillator always runs
// here.
bool is_emulated() {
  return rcc_cr == 0;
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
  dac_value = kDriveZero;
  kPortB.set_reset() = 1U << (13 + 16);
}

void start_ports() {
  rcc_ahb1enr |= 3;                      // ports A and B
  rcc_apb1enr |= (1U << 29) | 1;         // DAC, TIM2
  rcc_apb2enr |= (1U << 8) | (1U << 4);  // ADC1, USART1
  dac_value = kDriveZero;                // before its pin is connected
  dac_cr = 3;                            // on, without its output buffer, which ends 0.2 V from the rails
  set_mode(kPortA, 4, Mode::analog);
  kPortB.set_reset() = 1U << (13 + 16);
  set_mode(kPortB, 13, Mode::output);
  pull(kPortB, 12, Pull::down);
  pull(kPortB, 14, Pull::up);
  set_mode(kPortB, 0, Mode::analog);
  set_mode(kPortB, 1, Mode::analog);
  set_mode(kPortA, 6, Mode::analog);
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
  adc_smpr2 = (1U << 18) | (1U << 24) | (1U << 27);
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
    if (!take(to_send, byte)) return set_sending(false);
    usart_dr = byte;
  }
  set_sending(true);
}

// Of ADC1.
bool convert(uint32_t channel, int32_t& code) {
  adc_sqr3 = channel;
  adc_sr = 0;
  adc_cr2 = (1U << 30) | 1;
  for (uint32_t i = 0; (adc_sr & 2) == 0; ++i)
    if (i > 1000) return false;
  code = left_justified(adc_dr);
  return true;
}

// In QEMU a finger moves back and forth over 30,000 counts, 20 counts per tick, and the codes of the forces
// contain the tick.
int32_t emulated_count() {
  const uint32_t at = timer.ticks() * 20 % 60'000;
  return static_cast<int32_t>(at < 30'000 ? at : 60'000 - at);
}

bool emulated_channels(int32_t* codes) {
  codes[0] = emulated_count();
  codes[1] = static_cast<int32_t>(timer.ticks() << 12);
  codes[2] = static_cast<int32_t>(~timer.ticks() << 12);
  codes[3] = emulated_tray.code();
  return true;
}

bool read_channels(int32_t* codes) {
  if (emulated) return emulated_channels(codes);
  codes[0] = static_cast<int32_t>(tim2_cnt);
  return convert(8, codes[1]) && convert(9, codes[2]) && (!has_tray_sensor || convert(6, codes[3]));
}

core::Hal make_hal() {
  core::Hal hal = timed_hal<timer, received, to_send>();
  hal.read_encoder = [](void*) noexcept {
    return emulated ? emulated_count() : static_cast<int32_t>(tim2_cnt);
  };
  hal.read_channels = [](void*, int32_t* codes) noexcept { return read_channels(codes); };
  hal.write_drive = [](void*, float volts) noexcept {
    const uint32_t code = drive_code(volts);
    dac_value = code;
    if (emulated) emulated_tray.hold(code, timer.period_s());
  };
  hal.enable_closed = [](void*) noexcept { return emulated || (kPortB.input() & (1U << 12)) != 0; };
  hal.restart = [](void*) noexcept {
    drive_zero();
    scb_aircr = 0x05FA0004;
  };
  return hal;
}

float profile_memory[kRow.samples];
Tray tray;

core::Board make_board() {
  has_tray_sensor = (kPortB.input() & (1U << 14)) == 0;  // also in QEMU, where a port reads as 0
  core::Board board = describe(kRow, tray, profile_memory, {"adc 8", "adc 9", "adc 6"}, has_tray_sensor,
                               stored_check(), TACTO_VERSION " build ");
  if (!emulated) {
    const uint32_t id[3] = {at(kUniqueId), at(kUniqueId + 4), at(kUniqueId + 8)};  // QEMU has none
    put_hex(board.about.serial, id, 3);
    return board;
  }
  put(board.about.serial, "qemu");
  board.about.features |= wire::kFeatureSimulated;
  board.note_count = 2;
  tray.notes[1] = note(1, wire::NoteKind::simulated_by, "QEMU: encoder, converters and tray are simulated");
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
  if (received.front() == nullptr) asm volatile("wfi" ::: "memory");
  asm volatile("cpsie i" ::: "memory");
}

}  // namespace

// The watchdog restarts a chip whose main loop or SysTick stands still.
[[noreturn]] void serve() {
  emulated = is_emulated();
  start_clocks();
  start_ports();
  start_link();
  if (!flash_is_intact(stored_check())) refuse("flash check failed; flash again");
  start_encoder();
  start_converter();
  alignas(core::Firmware) static uint8_t memory[sizeof(core::Firmware)];
  firmware = new (memory) core::Firmware(make_board(), make_hal());
  timer.set_rate(0);
  serve_link_by_interrupt();
  start_watchdog();
  for (uint32_t fed = timer.ticks();;) {
    firmware->poll();
    set_enable(firmware->drive_state() != wire::DriveState::idle);
    if (fed != timer.ticks()) iwdg_kr = 0xAAAA;
    fed = timer.ticks();
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
  if (timer.interrupt()) firmware->tick();
}

// A byte that came too late for the register is lost, and noticed by the check of its frame. Reading the
// data clears both flags (RM0090, 30.6.1), also that of a lost byte alone, whose interrupt would never end.
void usart1_handler() {
  using namespace tacto::stm32f405;
  for (uint32_t status = 0; ((status = usart_sr) & (kReceived | kOverrun)) != 0;) {
    const auto byte = static_cast<uint8_t>(usart_dr);
    if ((status & kReceived) != 0) put(received, byte);
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
