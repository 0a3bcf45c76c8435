// SPDX-License-Identifier: GPL-3.0-or-later
// FFTW's wisdom (its measured plans for this machine), kept between runs in the user's cache folder. There
// are no errors: without a folder that can be read or written, nothing is kept.
#pragma once

#include <string>

namespace tacto::spatial {

/// The file fftwf.wisdom for Real = float, fftw.wisdom for double, in $XDG_CACHE_HOME/tactograph/, else in
/// ~/.cache/tactograph/. Empty if the environment names no folder (or, against the XDG specification, a
/// relative one).
template <class Real>
std::string wisdom_path();

/// Adds a file's wisdom to FFTW's. A file that is absent, damaged, or of another FFTW or processor is
/// ignored. Returns whether it was used. Precondition: the planner is locked.
template <class Real>
bool read_wisdom(const std::string& path);

/// Merges FFTW's wisdom with the file's and writes the file as a whole; makes the folder if necessary.
/// Returns whether it was written. Precondition: the planner is locked.
template <class Real>
bool write_wisdom(const std::string& path);

}  // namespace tacto::spatial
