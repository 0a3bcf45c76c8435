// SPDX-License-Identifier: GPL-3.0-or-later
// Loads modules: parts of the program in files of their own, which are loaded at their first use.
#pragma once

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The address of a function in a module. `module` is a file name such as "tactograph-netcdf.so"; it is
/// searched for in the folders of the program's RUNPATH (lib/tactograph of the installation). A module stays
/// loaded. Errors: internal: with the loader's message; or, with the file, that the module is of another
/// build (cmake/module_build.cpp.in), naming both. Thread-safe; not safe in the tick.
Result<void*> function_in_module(const char* module, const char* function);

}  // namespace tacto::schema
