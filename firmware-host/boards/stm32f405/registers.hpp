// SPDX-License-Identifier: Apache-2.0
// The registers of an STM32F405 that the board uses, by ST's reference manual RM0090 (section in brackets).
#pragma once

#include "firmware-host/boards/shared/cortex_m.hpp"

namespace tacto::stm32f405 {

using boards::at;

// Reset and clock control (7.3).
inline volatile uint32_t &rcc_cr = at(0x40023800), &rcc_pllcfgr = at(0x40023804), &rcc_cfgr = at(0x40023808),
                         &rcc_ahb1enr = at(0x40023830), &rcc_apb1enr = at(0x40023840),
                         &rcc_apb2enr = at(0x40023844);
// Flash interface (3.9).
inline volatile uint32_t& flash_acr = at(0x40023C00);

// General-purpose ports A and B (8.4).
struct Port {
  uint32_t base;
  volatile uint32_t& mode() const { return at(base); }
  volatile uint32_t& pull_up_down() const { return at(base + 0x0C); }
  volatile uint32_t& input() const { return at(base + 0x10); }
  volatile uint32_t& set_reset() const { return at(base + 0x18); }
  volatile uint32_t& function(unsigned pin) const { return at(base + 0x20 + 4 * (pin / 8)); }
};
inline constexpr Port kPortA{0x40020000}, kPortB{0x40020400};
enum class Mode : uint32_t { input, output, alternate, analog };
inline void set_mode(const Port& port, unsigned pin, Mode mode) {
  port.mode() = (port.mode() & ~(3U << (2 * pin))) | (static_cast<uint32_t>(mode) << (2 * pin));
}
inline void set_function(const Port& port, unsigned pin, uint32_t function) {
  const unsigned shift = 4 * (pin % 8);
  port.function(pin) = (port.function(pin) & ~(15U << shift)) | (function << shift);
  set_mode(port, pin, Mode::alternate);
}
enum class Pull : uint32_t { none, up, down };
inline void pull(const Port& port, unsigned pin, Pull pull) {
  port.pull_up_down() =
      (port.pull_up_down() & ~(3U << (2 * pin))) | (static_cast<uint32_t>(pull) << (2 * pin));
}

// USART1 (30.6).
inline volatile uint32_t &usart_sr = at(0x40011000), &usart_dr = at(0x40011004), &usart_brr = at(0x40011008),
                         &usart_cr1 = at(0x4001100C);
inline constexpr uint32_t kOverrun = 1U << 3, kReceived = 1U << 5, kSendEmpty = 1U << 7;
inline constexpr uint32_t kUsartOn = 1U << 13, kSendEmptyInterrupt = 1U << 7, kReceivedInterrupt = 1U << 5,
                          kSender = 1U << 3, kReceiver = 1U << 2;

// TIM2, a counter of 32 bits (18.4).
inline volatile uint32_t &tim2_cr1 = at(0x40000000), &tim2_smcr = at(0x40000008),
                         &tim2_ccmr1 = at(0x40000018), &tim2_cnt = at(0x40000024), &tim2_arr = at(0x4000002C);

// ADC1 (13.13) and the DAC (14.5).
inline volatile uint32_t &adc_sr = at(0x40012000), &adc_cr2 = at(0x40012008), &adc_smpr2 = at(0x40012010),
                         &adc_sqr3 = at(0x40012034), &adc_dr = at(0x4001204C), &adc_ccr = at(0x40012304);
inline volatile uint32_t &dac_cr = at(0x40007400), &dac_value = at(0x40007408);

// Independent watchdog (21.4).
inline volatile uint32_t &iwdg_kr = at(0x40003000), &iwdg_pr = at(0x40003004), &iwdg_rlr = at(0x40003008);

inline constexpr unsigned kUsart1Interrupt = 37;

/// 96 bits, unique to the chip (39.1).
inline constexpr uint32_t kUniqueId = 0x1FFF7A10;

}  // namespace tacto::stm32f405
