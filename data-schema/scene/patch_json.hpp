// SPDX-License-Identifier: GPL-3.0-or-later
// Patches and their layers as JSON. Internal to this folder.
#pragma once

#include "data-schema/json/json_document.hpp"
#include "data-schema/scene/patch.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::schema {

/// What becomes of a member that is not known: refused in a scene of this version, kept in a newer one.
enum class UnknownMembers { refused, kept };

/// Precondition: the body fits the schema's definition `patch`. `where` is FILE#/patches/I. Errors:
/// malformed, at the object with an unknown member, with the nearest known one; unsuitable, at the `type` of
/// an unknown layer, with the nearest known one.
Result<Patch> patch_from(const Json& body, UnknownMembers unknown, const std::string& where);

Json patch_body(const Patch& patch);

}  // namespace tacto::schema
