// SPDX-License-Identifier: GPL-3.0-or-later
// What FFTW learned about this machine's fastest transforms, kept between runs in the user's cache folder.
// Never an error: without a folder that can be read or written, nothing is kept.
#pragma once

#include <string>

namespace tacto::spatial {

/// $XDG_CACHE_HOME/tactograph/, else ~/.cache/tactograph/, and there fftwf.wisdom for Real = float,
/// fftw.wisdom for double. Empty where the environment names no folder (or, against the XDG specification, a
/// relative one).
template <class Real>
std::string wisdom_path();

/// Adds a file's wisdom to FFTW's. A file that is absent, damaged, or of another FFTW or processor is
/// ignored. Gives whether it was of use. Call it with the planner locked.
template <class Real>
bool read_wisdom(const std::string& path);

/// Joins FFTW's wisdom with the file's and writes it as a whole, making the folder if need be. Gives whether
/// it was written. Call it with the planner locked.
template <class Real>
bool write_wisdom(const std::string& path);

}  // namespace tacto::spatial
