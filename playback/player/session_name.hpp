// SPDX-License-Identifier: GPL-3.0-or-later
// What a session is called where nobody names it.
#pragma once

#include <string>

namespace tacto::playback {

/// `before` and the time in UTC, as in oak-20261122T201500Z.session; with -2 and so on where that is there.
std::string dated_session(const std::string& before);

/// The same after a texture or scene, as somebody named it: by stem or file, with a folder or without.
/// Of a.b, a.b.texture.json and /lab/a.b.scene it is a.b-20261122T201500Z.session.
std::string session_named_after(const std::string& played);

}  // namespace tacto::playback
