// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces as JSON. Internal to this folder.
#pragma once

#include "data-schema/json/json_document.hpp"
#include "data-schema/scene/piece.hpp"
#include "data-schema/scene/scene.hpp"

namespace tacto::schema {

/// Precondition: the body fits the schema's definition `piece`.
Piece piece_from(const Json& body);

Json piece_body(const Piece& piece);

PieceContact contact_from(const Json& scene_body);

}  // namespace tacto::schema
