// SPDX-License-Identifier: GPL-3.0-or-later
// What was prepared, into a device whose firmware closes the loop.
#pragma once

#include "firmware-host/link/client.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// Errors: unsuitable: not a rate at which the device ticks.
schema::Result<void> check_rate(const firmware_host::Client& client, double rate_hz);

/// Whether a device can play it by itself. Errors: unsuitable, for more samples than it holds, a touch that
/// it cannot feel, or ticks outside its rates; device, for firmware that does not know what is asked of it;
/// each with what to do.
schema::Result<void> check_upload(const firmware_host::Client& client, const Prepared& prepared);

/// Sends limits, levels, taps, following, energy, gain and, where the setup is gated, which of the device's
/// channels holds the normal force; the device is idle. Then `arm` with source profile at prepared.rate_hz
/// runs the same kernel as core::TickKernel with prepared.setup(), to the bit.
/// Errors: as check_upload() and Client::command().
schema::Result<void> upload(firmware_host::Client& client, const Prepared& prepared);

/// Sends another texture to a device that is armed with one by upload(), and has it cross-fade over fade_s (0
/// to 10): levels, samples, full detail. All else stays as it is; so does the device's gain (m/N, not 0),
/// which is one number for both: samples go out times prepared.gain_m_per_n / device_gain_m_per_n.
/// Precondition: check_texture_change(). Errors: unsuitable, for a device's gain of 0; device, as of
/// Client::command(); the texture that plays then plays on.
schema::Result<void> upload_change(firmware_host::Client& client, const Prepared& prepared,
                                   double device_gain_m_per_n, double fade_s);

}  // namespace tacto::playback
