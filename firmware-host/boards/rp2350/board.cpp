// SPDX-License-Identifier: Apache-2.0
// An RP2350 as a device. Core 1 ticks (SysTick), and handles commands between the ticks, because the firmware
// is written for one core; core 0 has the link (UART0) and the watchdog. PIO0 counts the encoder.
//
//   GP0, GP1          UART0 to and from the host, 1,000,000 baud
//   GP2, GP3          encoder A and B
//   GP6               enable input: 3.3 V through the emergency stop; 4.7 kOhm to ground (erratum E9)
//   GP7               enable output to the amplifier: high while the device is not idle
//   GP17, GP18, GP19  CS, SCK and SDI of an MCP4921, the drive: 1.65 V is 0 V at the amplifier's input
//   GP26, GP27        tangential force, normal force: 0 to 3.3 V
//   GP28              displacement of the tray: 0 to 3.3 V; GP8 to ground while its sensor is connected
#include "firmware-host/boards/rp2350/quadrature.hpp"
#include "firmware-host/boards/rp2350/registers.hpp"
#include "firmware-host/boards/shared/start.hpp"
#include "firmware-host/boards/shared/tick_timer.hpp"
#include "firmware-host/boards/shared/tray_board.hpp"
#include "firmware-host/core/firmware/firmware.hpp"
#include "firmware-host/core/kernel/shared.hpp"

extern "C" {
extern uint32_t tick_stack_top;  // memory.ld
extern const tacto::boards::Vectors<52> vectors;
[[noreturn]] void start_ticks();
extern const tacto::rp2350::Program quadrature;
}

constexpr tacto::rp2350::Program quadrature = tacto::rp2350::quadrature_program();

namespace tacto::rp2350 {
namespace {

using namespace boards;

constexpr const Board& kRow = *board_named("rp2350");
constexpr uint32_t kClockHz = kRow.clock_hz, kCrystalHz = 12'000'000, kBaud = 1'000'000;
constexpr unsigned kSendPin = 0, kReceivePin = 1, kEncoderA = 2, kEncoderB = 3, kEnableInput = 6,
                   kEnableOutput = 7, kTraySensor = 8, kDacSelect = 17, kDacClock = 18, kDacData = 19,
                   kFirstAdcPin = 26;
// A sample of the encoder takes at most ten periods of the state machine: 0.53 us, 1.9 million edges a
// second.
constexpr uint32_t kPioDivider = 8;
constexpr uint32_t kWatchdogUs = 50'000;

Bytes received, to_send;
TickTimer<kClockHz> timer;     // on core 1
core::Shared<uint32_t> turns;  // of the main loop on core 1, one after each tick at most
bool has_tray_sensor = false;

void drive_zero();

// Without its crystal the chip has no rate that a host could know.
[[noreturn]] void stop() {
  for (;;) {
  }
}

void unreset(uint32_t peripherals) {
  at(kResets + kClear) = peripherals;
  await(at(kResetDone), peripherals, peripherals);
}

// crystal x feedback / (first x second); the oscillator in it has 750 to 1600 MHz (8.6.3).
void start_pll(uint32_t pll, uint32_t feedback, uint32_t first, uint32_t second) {
  at(pll) = 1;  // the crystal is not divided
  at(pll + kPllFeedback) = feedback;
  at(pll + kPllPower + kClear) = 1U << 5 | 1;
  await(at(pll), 1U << 31, 1U << 31);
  at(pll + kPllDividers) = first << 16 | second << 12;
  at(pll + kPllPower + kClear) = 1U << 3;
}

// 150 MHz for cores and peripherals, 48 MHz for the ADC, 1 MHz for the watchdog.
void start_clocks() {
  static_assert(kCrystalHz * 125ULL / 10 == kClockHz && kCrystalHz * 100ULL / 25 == 48'000'000);
  xosc_startup = kCrystalHz / 1000 / 256 + 1;  // 1 ms
  xosc_ctrl = 0xFAB << 12 | 0xAA0;             // on, 1 to 15 MHz
  if (!await(xosc_status, 1U << 31, 1U << 31)) stop();
  clk_ref_ctrl = 2;
  await(clk_ref_selected, 1U << 2, 1U << 2);
  clk_sys_ctrl = 0;
  await(clk_sys_selected, 1, 1);
  at(kResets + kSet) = kResetPllSys | kResetPllUsb;
  unreset(kResetPllSys | kResetPllUsb);
  start_pll(kPllSys, 125, 5, 2);
  start_pll(kPllUsb, 100, 5, 5);
  clk_sys_ctrl = 1;
  await(clk_sys_selected, 2, 2);
  clk_peri_ctrl = kClockOn;
  clk_adc_ctrl = kClockOn;
  ticks_watchdog_cycles = kCrystalHz / 1'000'000;
  ticks_watchdog_ctrl = 1;
}

// Writing the pad also ends its isolation (9.7).
void set_pin(unsigned pin, Function function, uint32_t pad_bits) {
  pin_function(pin) = static_cast<uint32_t>(function);
  pad(pin) = pad_bits | kSchmitt | kDrive4mA;
}

void start_ports() {
  unreset(kResetIo | kResetPads);
  sio_out_clear = 1U << kEnableOutput;
  sio_output_set = 1U << kEnableOutput;
  set_pin(kEnableOutput, Function::sio, 0);
  set_pin(kEnableInput, Function::sio, kInput | kPullDown);
  set_pin(kEncoderA, Function::pio0, kInput);
  set_pin(kEncoderB, Function::pio0, kInput);
  set_pin(kTraySensor, Function::sio, kInput | kPullUp);
  for (unsigned channel = 0; channel < 3; ++channel)
    set_pin(kFirstAdcPin + channel, Function::none, kOutputOff);
}

void start_link() {
  unreset(kResetUart0);
  uart_whole = kClockHz / (16 * kBaud);
  uart_part = kClockHz / (kBaud / 4) % 64;  // of 64
  uart_line = 3U << 5 | 1U << 4;            // 8 bits, FIFOs on
  uart_ctrl = 1U << 9 | 1U << 8 | 1;
  set_pin(kSendPin, Function::uart, 0);
  set_pin(kReceivePin, Function::uart, kInput | kPullUp);  // no bytes from an open wire
}

// MCP4921 (Microchip DS22248, 5.2): words of 16 bits, of which 0x3000 is output on, gain 1. 18.75 MHz of at
// most 20.
void start_drive() {
  unreset(kResetSpi0);
  spi_divider = 8;
  spi_ctrl0 = 15;  // 16 bits, mode 0: the select line rises after each word, which sets the output
  spi_ctrl1 = 1U << 1;
  drive_zero();
  set_pin(kDacSelect, Function::spi, 0);
  set_pin(kDacClock, Function::spi, 0);
  set_pin(kDacData, Function::spi, 0);
  drive_zero();
}

void write_dac(uint32_t code) {
  spi_data = 0x3000 | code;
}

void drive_zero() {
  sio_out_clear = 1U << kEnableOutput;
  write_dac(kDriveZero);
}

void start_encoder() {
  unreset(kResetPio0);
#pragma clang loop unroll(disable)  // the program stays in one piece, which a test reads
  for (unsigned i = 0; i < kProgramEnd; ++i) pio_memory(i) = quadrature.words[i];
  pio_divider = kPioDivider << 16;
  pio_exec = (kProgramEnd - 1) << 12 | kStore << 7;
  pio_shift =
      1U << 19 | 1U << 15 | 2;  // out to the right, in to the left, the FIFO is read in place, two pins
  pio_pins = kEncoderA << 15;
  pio_instruction = pio::set_y(0);
  pio_instruction = pio::move(pio::osr, pio::pins);
  pio_instruction = pio::jump(kStore);
  pio_ctrl = 1;
}

void start_converter() {
  unreset(kResetAdc);
  adc_cs = kAdcOn;
  await(adc_cs, kAdcReady, kAdcReady);
}

// 2 us each (12.4.3: 96 periods of 48 MHz).
bool convert(uint32_t channel, int32_t& code) {
  adc_cs = kAdcOn | channel << 12;
  adc_cs = kAdcOn | channel << 12 | kAdcStart;
  if (!await(adc_cs, kAdcReady, kAdcReady, 1000) || (adc_cs & kAdcError) != 0) return false;
  code = left_justified(adc_result);
  return true;
}

core::Hal make_hal() {
  core::Hal hal = timed_hal<timer, received, to_send>();
  hal.read_encoder = [](void*) noexcept { return static_cast<int32_t>(pio_count); };
  hal.read_channels = [](void*, int32_t* codes) noexcept {
    codes[0] = static_cast<int32_t>(pio_count);
    return convert(0, codes[1]) && convert(1, codes[2]) && (!has_tray_sensor || convert(2, codes[3]));
  };
  hal.write_drive = [](void*, float volts) noexcept { write_dac(drive_code(volts)); };
  hal.enable_closed = [](void*) noexcept { return (sio_in & 1U << kEnableInput) != 0; };
  hal.restart = [](void*) noexcept {
    drive_zero();
    watchdog_ctrl = kRestart;
  };
  return hal;
}

float profile_memory[kRow.samples];
Tray tray;
core::Firmware* firmware = nullptr;

core::Board make_board(uint32_t check) {
  has_tray_sensor = (sio_in & 1U << kTraySensor) == 0;
  core::Board board = describe(kRow, tray, profile_memory, {"adc 0", "adc 1", "adc 2"}, has_tray_sensor,
                               check, TACTO_VERSION " build ");
  const uint32_t id[2] = {at(kUniqueId + 4), at(kUniqueId)};
  put_hex(board.about.serial, id, 2);
  return board;
}

// Datasheet, 5.3: each word is echoed; after a wrong echo it begins again.
void start_core_1() {
  const uint32_t words[6] = {0,
                             0,
                             1,
                             reinterpret_cast<uint32_t>(&vectors),
                             reinterpret_cast<uint32_t>(&tick_stack_top),
                             reinterpret_cast<uint32_t>(&start_ticks)};
  for (unsigned i = 0; i < 6;) {
    if (words[i] == 0)
      while ((fifo_status & kFifoValid) != 0) static_cast<void>(fifo_read);
    asm volatile("sev");
    while ((fifo_status & kFifoReady) == 0) {
    }
    fifo_write = words[i];
    asm volatile("sev");
    while ((fifo_status & kFifoValid) == 0) asm volatile("wfe");
    i = fifo_read == words[i] ? i + 1 : 0;
  }
}

void feed_watchdog() {
  watchdog_load = kWatchdogUs;
}

void start_watchdog() {
  psm_watchdog = kAllButOscillators;
  feed_watchdog();
  watchdog_ctrl = kWatchdogOn;
}

// Answers every byte with a text, which the host shows as the first bytes of a device without the wire.
[[noreturn]] void refuse(const char* text) {
  for (;;) {
    while ((uart_flags & kReceiveEmpty) != 0) {
    }
    static_cast<void>(uart_data);
    for (const char* next = text; *next != 0; ++next) {
      while ((uart_flags & kSendFull) != 0) {
      }
      uart_data = static_cast<uint8_t>(*next);
    }
  }
}

// A byte with an error of the line is noticed by the check of its frame. 32 bytes wait in the UART, 0.3 ms.
void move_bytes() {
  while ((uart_flags & kReceiveEmpty) == 0) {
    put(received, static_cast<uint8_t>(uart_data));
    asm volatile("sev");  // core 1 wakes
  }
  uint8_t byte = 0;
  while ((uart_flags & kSendFull) == 0 && take(to_send, byte)) uart_data = byte;
}

}  // namespace

// On core 0. The flash is read before its clock is raised, and not any more afterwards.
[[noreturn]] void serve_link() {
  const uint32_t check = stored_check();
  const bool intact = flash_is_intact(check);
  start_clocks();
  start_ports();
  start_drive();
  start_link();
  if (!intact) refuse("flash check failed; flash again");
  start_encoder();
  start_converter();
  alignas(core::Firmware) static uint8_t memory[sizeof(core::Firmware)];
  firmware = new (memory) core::Firmware(make_board(check), make_hal());
  start_core_1();
  start_watchdog();
  for (uint32_t fed = turns.load();;) {
    move_bytes();
    const uint32_t now = turns.load();
    if (fed != now) feed_watchdog();
    fed = now;
  }
}

// On core 1: the watchdog restarts a chip whose main loop, SysTick or link stands still.
[[noreturn]] void serve_ticks() {
  timer.set_rate(0);
  for (uint32_t seen = timer.ticks();;) {
    firmware->poll();
    if (firmware->drive_state() != wire::DriveState::idle)
      sio_out_set = 1U << kEnableOutput;
    else
      sio_out_clear = 1U << kEnableOutput;
    if (seen != timer.ticks()) turns.store(turns.load() + 1);
    seen = timer.ticks();
    if (received.front() == nullptr)
      asm volatile("wfe" ::: "memory");  // a byte or a tick before it ends it at once
  }
}

}  // namespace tacto::rp2350

extern "C" {
[[noreturn]] void run_link() {
  tacto::rp2350::serve_link();
}

[[noreturn]] void run_ticks() {
  tacto::rp2350::serve_ticks();
}

void systick_handler() {
  using namespace tacto::rp2350;
  if (timer.interrupt()) firmware->tick();
}

// The watchdog then restarts the device.
[[noreturn]] void fault_handler() {
  tacto::rp2350::drive_zero();
  for (;;) {
  }
}
}
