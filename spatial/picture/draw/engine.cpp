// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/picture/draw/engine.hpp"

#include "data-schema/base/module.hpp"

namespace tacto::spatial {
namespace {

schema::Result<const DrawingEngine*> loaded_engine() {
  const auto entry = schema::function_in_module(kPictureModule, kPictureEntry);
  TACTO_TRY(entry);
  return reinterpret_cast<PictureEntry>(*entry)();
}

}  // namespace

const schema::Result<const DrawingEngine*>& drawing_engine() {
  static const auto once = loaded_engine();
  return once;
}

std::string palette_png(const Pixels& pixels) {
  const auto& engine = drawing_engine();
  return engine ? (*engine)->palette_png(pixels) : std::string();
}

}  // namespace tacto::spatial
