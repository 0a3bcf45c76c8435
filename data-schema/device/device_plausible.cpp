// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "data-schema/base/plausible_range.hpp"
#include "data-schema/device/device.hpp"

namespace tacto::schema {
namespace {

template <class Owner>
struct DeviceNumber {
  const char* name;
  double Owner::*member;
  PlausibleRange range;
};

// Anchors: Minsky 1990 (joystick of two axes, 1.17 N s/m, 100 Hz to 1 kHz); Massie 1996 (PHANToM: 10 N peak,
// 1.5 N continuous, 1 kHz); catalogues of linear motors and of haptic arms (0.02 to 3 kg, 0.1 to 1 um
// interferometers, 30 um arms, up to 200 N). Each range goes at least an order of magnitude beyond.
constexpr DeviceNumber<DeviceAxis> kAxisNumbers[] = {
    // 1 g, less than any handle, to 100 kg
    {"mass_kg", &DeviceAxis::mass_kg, {1e-3, 100}},
    // air bearings have none; a thick oil damper
    {"viscous_n_s_per_m", &DeviceAxis::viscous_n_s_per_m, {1e-4, 1e4, true}},
    // air bearings have none; more than a hand pushes
    {"coulomb_n", &DeviceAxis::coulomb_n, {1e-6, 1e3, true}},
    // 10 pm of an interferometer to 1 cm of a coarse potentiometer
    {"encoder_step_m", &DeviceAxis::encoder_step_m, {1e-11, 1e-2}},
    {"peak_force_n", &DeviceAxis::peak_force_n, {1e-3, 1e4}},
    {"continuous_force_n", &DeviceAxis::continuous_force_n, {1e-3, 1e4}},
};

constexpr DeviceNumber<Device> kVectorNumbers[] = {
    {"peak_force_n", &Device::peak_force_n, {1e-3, 1e4}},
    {"continuous_force_n", &Device::continuous_force_n, {1e-3, 1e4}},
    // 1 N in a second to 10 kN in a microsecond
    {"slew_n_per_s", &Device::slew_n_per_s, {1, 1e10}},
    // a microsecond to a network across the world
    {"delay_s", &Device::delay_s, {1e-9, 1, true}},
};

constexpr PlausibleRange kTravelM{-10, 10};  // a room
constexpr PlausibleRange kRateHz{1, 1e6};    // one per second to one per microsecond

template <class Owner, std::size_t kCount>
Result<void> check_device_numbers(const Owner& owner, const DeviceNumber<Owner> (&numbers)[kCount],
                                  const std::string& where) {
  for (const auto& [name, member, range] : numbers) TACTO_TRY(check_range(range, owner.*member, name, where));
  return {};
}

Result<void> check_continuous(double continuous_n, double peak_n, const std::string& where) {
  if (continuous_n <= peak_n) return {};
  return fail(ErrorKind::unsuitable,
              fmt::format("continuous_force_n is {:g}, above the peak_force_n of {:g}", continuous_n, peak_n),
              place_of_member(where, "continuous_force_n"), "at most the peak");
}

Result<void> check_travel(const DeviceAxis& axis, const std::string& where) {
  TACTO_TRY(check_range(kTravelM, axis.travel_from_m, "travel_m/0", where));
  TACTO_TRY(check_range(kTravelM, axis.travel_to_m, "travel_m/1", where));
  if (axis.travel_to_m - axis.travel_from_m > axis.encoder_step_m) return {};
  return fail(
      ErrorKind::unsuitable,
      fmt::format("travel_m is from {:g} to {:g} m: it has to increase, by more than an encoder step of {:g}",
                  axis.travel_from_m, axis.travel_to_m, axis.encoder_step_m),
      place_of_member(where, "travel_m"), "give the lower end first");
}

Result<void> check_axis(const DeviceAxis& axis, const std::string& where) {
  TACTO_TRY(check_device_numbers(axis, kAxisNumbers, where));
  TACTO_TRY(check_travel(axis, where));
  return check_continuous(axis.continuous_force_n, axis.peak_force_n, where);
}

Result<void> check_axis_names(const Device& device, const std::string& where) {
  for (std::size_t i = 0; i < device.axes.size(); ++i)
    for (std::size_t before = 0; before < i; ++before)
      if (device.axes[before].name == device.axes[i].name)
        return fail(ErrorKind::unsuitable, fmt::format("two axes are named '{}'", device.axes[i].name),
                    fmt::format("{}#/axes/{}/name", where, i), "name them x, y, z");
  return {};
}

Result<void> check_rates(const Device& device, const std::string& where) {
  for (std::size_t i = 0; i < device.rates_hz.size(); ++i) {
    const std::string member = fmt::format("rates_hz/{}", i);
    TACTO_TRY(check_range(kRateHz, device.rates_hz[i], member, where));
    if (i > 0 && !(device.rates_hz[i] > device.rates_hz[i - 1]))
      return fail(ErrorKind::unsuitable,
                  fmt::format("{} is {:g}, after {:g}: rates have to increase", member, device.rates_hz[i],
                              device.rates_hz[i - 1]),
                  place_of_member(where, member), "sort them");
  }
  return {};
}

}  // namespace

Result<void> check_device(const Device& device, const std::string& where) {
  for (std::size_t i = 0; i < device.axes.size(); ++i)
    TACTO_TRY(check_axis(device.axes[i], fmt::format("{}#/axes/{}", where, i)));
  TACTO_TRY(check_axis_names(device, where));
  TACTO_TRY(check_device_numbers(device, kVectorNumbers, where));
  TACTO_TRY(check_continuous(device.continuous_force_n, device.peak_force_n, where));
  return check_rates(device, where);
}

}  // namespace tacto::schema
