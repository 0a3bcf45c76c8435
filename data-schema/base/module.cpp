// SPDX-License-Identifier: GPL-3.0-or-later
#include "data-schema/base/module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <string>
#include <string_view>

/// The build of this program; a module has its own under the same name (cmake/module_build.cpp.in).
extern "C" const char tacto_module_build[];

namespace tacto::schema {
namespace {

std::string path_of_module(void* handle, const char* module) {
  link_map* map = nullptr;
  return dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 ? map->l_name : module;
}

// Its functions and types may differ from those that this program was compiled for.
Result<void> check_build(void* handle, const char* module) {
  const auto* const build = static_cast<const char*>(dlsym(handle, "tacto_module_build"));
  const std::string_view found = build == nullptr ? "unknown" : build;
  if (found == tacto_module_build) return {};
  return fail(ErrorKind::internal,
              fmt::format("is a module of build {}, this program is of build {}", found, tacto_module_build),
              path_of_module(handle, module),
              "program and module were installed from two builds; install tactograph again");
}

}  // namespace

Result<void*> function_in_module(const char* module, const char* function) {
  void* const handle = dlopen(module, RTLD_LAZY | RTLD_LOCAL);
  if (handle != nullptr) TACTO_TRY(check_build(handle, module));
  void* const address = handle == nullptr ? nullptr : dlsym(handle, function);
  if (address != nullptr) return address;
  const char* const why = dlerror();
  return fail(ErrorKind::internal, why == nullptr ? "cannot be loaded" : why, module,
              "the installation is incomplete; install tactograph again");
}

}  // namespace tacto::schema
