// SPDX-License-Identifier: GPL-3.0-or-later
// How a texture is read, how the transducer is inverted and how the drive is limited: the same members in a
// scene, in the daemon's configuration and in a `load`.
#pragma once

#include <optional>
#include <string>

namespace tacto::schema {

/// Words and ranges are those of the schemas' definition `playback`. A request has priority over the scene,
/// the scene over the configuration.
struct PlaybackChoices {
  std::optional<std::string> interpolation;   ///< nearest, linear, hermite, sinc
  std::optional<std::string> inverse;         ///< full, magnitude, gain, none
  std::optional<std::string> reconstruction;  ///< none, butterworth3: the filter behind the converter
  std::optional<double> cutoff_hz;            ///< of butterworth3
  std::optional<std::string> hold;            ///< none, zero-order
  std::optional<double> energy_rms_v;         ///< largest RMS of the drive, V; 0: no limit
  std::optional<double> energy_window_s;      ///< time window of that RMS
  std::optional<double> contact_on_n;         ///< normal force from which there is a drive, N; 0: always
  std::optional<double> contact_off_n;        ///< normal force below which the drive ends
  std::string extra_json;                     ///< members of a newer version

  /// These choices, and those of `base` for the unset ones. A contact_on_n here discards base's
  /// contact_off_n.
  PlaybackChoices over(const PlaybackChoices& base) const;
  bool operator==(const PlaybackChoices&) const = default;
};

/// The members by their names in files.
struct ChosenWord {
  const char* name;
  std::optional<std::string> PlaybackChoices::*member;
};
inline constexpr ChosenWord kChosenWords[] = {{"interpolation", &PlaybackChoices::interpolation},
                                              {"inverse", &PlaybackChoices::inverse},
                                              {"reconstruction", &PlaybackChoices::reconstruction},
                                              {"hold", &PlaybackChoices::hold}};

struct ChosenNumber {
  const char* name;
  std::optional<double> PlaybackChoices::*member;
};
inline constexpr ChosenNumber kChosenNumbers[] = {{"cutoff_hz", &PlaybackChoices::cutoff_hz},
                                                  {"energy_rms_v", &PlaybackChoices::energy_rms_v},
                                                  {"energy_window_s", &PlaybackChoices::energy_window_s},
                                                  {"contact_on_n", &PlaybackChoices::contact_on_n},
                                                  {"contact_off_n", &PlaybackChoices::contact_off_n}};

}  // namespace tacto::schema
