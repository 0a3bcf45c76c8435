// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/cli/ends_option.hpp"

#include "data-schema/base/playback_defaults.hpp"
#include "data-schema/base/quantity.hpp"

namespace tacto::playback {

void declare_ends(CLI::App& app, std::optional<schema::TextureEnds>& ends, const std::string& of_what) {
  app.add_option_function<std::string>(
         "--ends",
         [&ends](const std::string& word) {
           ends = static_cast<schema::TextureEnds>(cli::choose("--ends", word, {"stop", "mirror", "loop"}));
         },
         of_what +
             "Beyond the ends of a texture: nothing (stop), its mirror image, or the texture again (loop: if "
             "the end does not meet the beginning, the last " +
             schema::length_for_people(schema::kSeamM) + " fades into the first)")
      ->type_name("stop|mirror|loop");
}

}  // namespace tacto::playback
