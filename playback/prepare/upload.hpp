// SPDX-License-Identifier: GPL-3.0-or-later
// Uploads what was prepared to a device whose firmware closes the loop.
#pragma once

#include "firmware-host/link/client.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// The device's channel of normal force, N; null: it has none.
const wire::Channel* force_channel(const firmware_host::Client& client);

/// Errors: unsuitable: the device cannot tick at this rate.
schema::Result<void> check_rate(const firmware_host::Client& client, double rate_hz);

/// Checks whether the device can play this. Errors: unsuitable, for more samples than it has memory, contact
/// that it cannot measure, or a rate that it does not have; device, for firmware without a feature that is
/// needed; each with what to do.
schema::Result<void> check_upload(const firmware_host::Client& client, const Prepared& prepared);

/// Sends limits, levels, taps, tracking, energy, gain and, if there is a contact gate, the device's channel
/// of normal force; the device is idle. Then `arm` with source profile at prepared.rate_hz runs the same
/// kernel as core::TickKernel with prepared.setup(), to the bit. Errors: as check_upload() and
/// Client::command().
schema::Result<void> upload(firmware_host::Client& client, const Prepared& prepared);

/// Sends another texture to a device that is armed with one by upload(): levels, samples, full detail; it
/// waits there for a change to it. Everything else is unchanged, also the device's gain (m/N, not
/// 0), which is common to both: samples are sent times prepared.gain_m_per_n / device_gain_m_per_n.
/// Precondition: check_texture_change(). Errors: unsuitable, for a device's gain of 0; device, as of
/// Client::command(); then the current texture continues.
schema::Result<void> upload_next(firmware_host::Client& client, const Prepared& prepared,
                                 double device_gain_m_per_n);

/// The same, and starts a cross-fade over fade_s (0 to 10).
schema::Result<void> upload_change(firmware_host::Client& client, const Prepared& prepared,
                                   double device_gain_m_per_n, double fade_s);

}  // namespace tacto::playback
