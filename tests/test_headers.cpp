// SPDX-License-Identifier: GPL-3.0-or-later
// Nothing of its own: CMake precompiles the tests' common headers with it.
