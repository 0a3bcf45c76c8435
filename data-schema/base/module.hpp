// SPDX-License-Identifier: GPL-3.0-or-later
// Modules: parts of the program in files of their own, which are loaded at their first use.
#pragma once

#include <dlfcn.h>

#include "data-schema/base/error.hpp"

namespace tacto::schema {

/// The address of a function in a module. `module` is a file name such as "tactograph-netcdf.so"; it is
/// searched for in the folders of the program's RUNPATH (lib/tactograph of the installation). A module stays
/// loaded. Errors: internal, with the loader's message. Thread-safe; not safe in the tick.
inline Result<void*> function_in_module(const char* module, const char* function) {
  void* const handle = dlopen(module, RTLD_LAZY | RTLD_LOCAL);
  void* const address = handle == nullptr ? nullptr : dlsym(handle, function);
  if (address != nullptr) return address;
  const char* const why = dlerror();
  return fail(ErrorKind::internal, why == nullptr ? "cannot be loaded" : why, module,
              "the installation is incomplete; install tactograph again");
}

}  // namespace tacto::schema
