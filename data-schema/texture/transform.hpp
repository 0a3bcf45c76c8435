// SPDX-License-Identifier: GPL-3.0-or-later
// How a texture was made from other textures: of which, and by which operations.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tacto::schema {

/// One of the textures that a texture was made from.
struct TransformSource {
  std::string texture;  ///< file name of its sidecar
  std::string sha256;   ///< of its WAV
};

enum class TransformOperation { stretch, gain, mix, filter };

/// How a stretched texture was brought to its length: in whole periods of the texture, or with a joint where
/// the texture fits itself best.
enum class Lengthening { periods, best_fit };

/// One operation with its parameters; members of other operations are empty.
struct TransformStep {
  TransformOperation operation = TransformOperation::gain;
  std::optional<double> factor = std::nullopt;    ///< stretch: of all lengths. gain: of all values
  std::optional<bool> keep_slope = std::nullopt;  ///< stretch: values were multiplied by the factor, too
  std::optional<Lengthening> lengthening = std::nullopt;  ///< stretch
  std::optional<double> period_m =
      std::nullopt;                          ///< stretch: of its source, where it was brought to whole ones
  std::optional<int> joints = std::nullopt;  ///< stretch: how often the texture begins again, 0 or more
  /// stretch, with a joint: sqrt((dv / RMS of the values)^2 + (ds / RMS of the slopes)^2) of the jumps dv in
  /// value and ds in slope.
  std::optional<double> joint_error = std::nullopt;
  std::vector<double> weights = {};                                           ///< mix: one for each source
  std::optional<double> low_per_m = std::nullopt, high_per_m = std::nullopt;  ///< filter: its band
  /// stretch, mix: content above this frequency of the result was removed, because the grid can't hold it ...
  std::optional<double> removed_above_per_m = std::nullopt;
  std::optional<double> removed_share = std::nullopt;  ///< ... its RMS re that of the source
  std::optional<double> left_out_m =
      std::nullopt;  ///< stretch, mix: length of source that is not in the result
};

/// The numbers of a step under their names in files and reports.
struct TransformNumber {
  const char* name;
  std::optional<double> TransformStep::*member;
};
inline constexpr TransformNumber kTransformNumbers[] = {
    {"factor", &TransformStep::factor},
    {"period_m", &TransformStep::period_m},
    {"joint_error", &TransformStep::joint_error},
    {"low_per_m", &TransformStep::low_per_m},
    {"high_per_m", &TransformStep::high_per_m},
    {"removed_above_per_m", &TransformStep::removed_above_per_m},
    {"removed_share", &TransformStep::removed_share},
    {"left_out_m", &TransformStep::left_out_m},
};

struct TextureTransform {
  std::vector<TransformSource> sources;
  std::vector<TransformStep> steps;  ///< in this order
};

/// As in the JSON: "stretch", "periods" ...
const char* operation_name(TransformOperation operation);
const char* lengthening_name(Lengthening lengthening);

}  // namespace tacto::schema
