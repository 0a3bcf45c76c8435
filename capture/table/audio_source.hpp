// SPDX-License-Identifier: GPL-3.0-or-later
// Sound files as columns of numbers.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "capture/table/source.hpp"
#include "data-schema/base/error.hpp"

namespace tacto::capture {

/// Columns "ch1", "ch2" ..., the header's rate, the width of integer codes. Errors: malformed, if libsndfile
/// does not support the file; as WavReader::open().
schema::Result<Source> open_audio(const std::string& file);

/// Reads block by block: integer samples as codes of their own width, others unchanged. Errors: those of
/// `take`; malformed, with the sample, for NaN and Inf, or a file without samples.
schema::Result<void> read_audio(const Source& source, std::span<const std::size_t> columns,
                                const RowHandler& take, const std::function<void(double)>& progress);

}  // namespace tacto::capture
