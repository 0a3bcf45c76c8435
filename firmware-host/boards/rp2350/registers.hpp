// SPDX-License-Identifier: Apache-2.0
// The registers of an RP2350 that the board uses, by its datasheet (section in brackets).
#pragma once

#include "firmware-host/boards/shared/cortex_m.hpp"

namespace tacto::rp2350 {

using boards::at;

// Each register has a second and third address at which ones are set and cleared (2.1.3).
inline constexpr uint32_t kSet = 0x2000, kClear = 0x3000;

// Resets of peripherals (7.5).
inline constexpr uint32_t kResets = 0x40020000, kResetDone = kResets + 8;
inline constexpr uint32_t kResetAdc = 1U << 0, kResetIo = 1U << 6, kResetPads = 1U << 9,
                          kResetPio0 = 1U << 11, kResetPllSys = 1U << 14, kResetPllUsb = 1U << 15,
                          kResetSpi0 = 1U << 18, kResetUart0 = 1U << 26;

// Clocks (8.1.7), crystal oscillator (8.2.8), PLLs (8.6.5), and the microseconds of the watchdog (8.5.2).
inline volatile uint32_t &clk_ref_ctrl = at(0x40010030), &clk_ref_selected = at(0x40010038),
                         &clk_sys_ctrl = at(0x4001003C), &clk_sys_selected = at(0x40010044),
                         &clk_peri_ctrl = at(0x40010048), &clk_adc_ctrl = at(0x4001006C);
inline constexpr uint32_t kClockOn = 1U << 11;
inline volatile uint32_t &xosc_ctrl = at(0x40048000), &xosc_status = at(0x40048004),
                         &xosc_startup = at(0x4004800C);
inline constexpr uint32_t kPllSys = 0x40050000, kPllUsb = 0x40058000;
inline constexpr uint32_t kPllPower = 4, kPllFeedback = 8, kPllDividers = 12;  // from its base, the status
inline volatile uint32_t &ticks_watchdog_ctrl = at(0x40108030), &ticks_watchdog_cycles = at(0x40108034);

// Pins: function (9.11.1) and pad (9.11.3).
inline volatile uint32_t& pin_function(unsigned pin) {
  return at(0x40028004 + 8 * pin);
}
inline volatile uint32_t& pad(unsigned pin) {
  return at(0x40038004 + 4 * pin);
}
enum class Function : uint32_t { spi = 1, uart = 2, sio = 5, pio0 = 6, none = 31 };
inline constexpr uint32_t kSchmitt = 1U << 1, kPullDown = 1U << 2, kPullUp = 1U << 3, kDrive4mA = 1U << 4,
                          kInput = 1U << 6, kOutputOff = 1U << 7;

// Inputs and outputs, and the mailbox between the cores (3.1.11).
inline volatile uint32_t &sio_in = at(0xD0000004), &sio_out_set = at(0xD0000018),
                         &sio_out_clear = at(0xD0000020), &sio_output_set = at(0xD0000038),
                         &fifo_status = at(0xD0000050), &fifo_write = at(0xD0000054),
                         &fifo_read = at(0xD0000058);
inline constexpr uint32_t kFifoValid = 1, kFifoReady = 2;

// UART0 (12.1.8), SPI0 (12.3.5), ADC (12.4.7).
inline volatile uint32_t &uart_data = at(0x40070000), &uart_flags = at(0x40070018),
                         &uart_whole = at(0x40070024), &uart_part = at(0x40070028),
                         &uart_line = at(0x4007002C), &uart_ctrl = at(0x40070030);
inline constexpr uint32_t kReceiveEmpty = 1U << 4, kSendFull = 1U << 5;
inline volatile uint32_t &spi_ctrl0 = at(0x40080000), &spi_ctrl1 = at(0x40080004), &spi_data = at(0x40080008),
                         &spi_divider = at(0x40080010);
inline volatile uint32_t &adc_cs = at(0x400A0000), &adc_result = at(0x400A0004);
inline constexpr uint32_t kAdcOn = 1, kAdcStart = 1U << 2, kAdcReady = 1U << 8, kAdcError = 1U << 9;

// PIO0 and its state machine 0 (11.7).
inline constexpr uint32_t kPio = 0x50200000;
inline volatile uint32_t &pio_ctrl = at(kPio), &pio_divider = at(kPio + 0xC8), &pio_exec = at(kPio + 0xCC),
                         &pio_shift = at(kPio + 0xD0), &pio_instruction = at(kPio + 0xD8),
                         &pio_pins = at(kPio + 0xDC), &pio_count = at(kPio + 0x128);
inline volatile uint32_t& pio_memory(unsigned place) {
  return at(kPio + 0x48 + 4 * place);
}

// Watchdog (12.9.6), and what it resets (7.4): all but the oscillators.
inline volatile uint32_t &watchdog_ctrl = at(0x400D8000), &watchdog_load = at(0x400D8004),
                         &psm_watchdog = at(0x40018008);
inline constexpr uint32_t kWatchdogOn = 1U << 30, kRestart = 1U << 31, kAllButOscillators = 0x01FFFFF3;

/// 64 bits, unique to the chip: rows 0 to 3 of the one-time memory, 16 bits each (13.10, CHIPID0).
inline constexpr uint32_t kUniqueId = 0x40130000;

}  // namespace tacto::rp2350
