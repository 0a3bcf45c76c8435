// SPDX-License-Identifier: GPL-3.0-or-later
// Keys and values of a report in words, for texts and pages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "data-schema/report/report_entries.hpp"

namespace tacto::cli {

/// The keys without the endings of their units: "force_rms_n" is "force rms". Keys that would be equal get
/// the quantity, too: "from_s" and "from_m" are "from (time)" and "from (length)".
std::vector<std::string> labels_of(const std::vector<std::string>& keys);

/// "resonance (Hz)" of "resonance_hz".
std::string label_with_unit(std::string_view key);

/// The value with its unit and four digits. Empty for a list of reports.
std::string cell_text(const std::string& key, const ReportPrinter::Value& value);

/// Columns on a terminal: one for each letter of UTF-8.
std::size_t width_of(std::string_view text);

/// Padded with spaces up to the width.
std::string padded(const std::string& text, std::size_t width);

}  // namespace tacto::cli
