// SPDX-License-Identifier: GPL-3.0-or-later
// The default name of a session.
#pragma once

#include <string>

namespace tacto::playback {

/// `before` and the time in UTC, as in oak-20261122T201500Z.session; with -2 and so on if that exists.
std::string dated_session(const std::string& before);

/// The same for a texture or scene, as the user named it: by stem or file, with or without a folder. For a.b,
/// a.b.texture.json and /lab/a.b.scene it is a.b-20261122T201500Z.session.
std::string session_named_after(const std::string& played);

}  // namespace tacto::playback
