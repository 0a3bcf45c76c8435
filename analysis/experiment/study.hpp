// SPDX-License-Identifier: GPL-3.0-or-later
// The files of an experiment: protocol, key, and stimuli under their codes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "data-schema/experiment/protocol.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::analysis {

/// STEM.protocol.json, STEM.key.json and the textures STEM/K1 ...; runs are STEM-P01.
struct Study {
  std::string stem;
  schema::Protocol protocol;
  schema::ProtocolKey key;

  std::string name() const;                               ///< the stem without its folder
  std::string stimulus(const std::string& code) const;    ///< stem of its texture
  std::string run(const std::string& participant) const;  ///< STEM-P01
};

/// Experiment 2 of Wiertlewski, Lozada and Hayward 2011: a sinusoid of 1.76 mm and 12.8 um; its period and
/// amplitude stretched by +-10, 30, 50 and 70 %, ten times each; which one has the smaller period. With
/// another method than constant 60 trials, at stretches of 5, 10 ... 70 %, of QUEST+ to both sides.
schema::Protocol stretch_protocol(const std::string& seed,
                                  schema::LevelMethod method = schema::LevelMethod::constant);

/// Textures by their names.
using NamedTextures = std::map<std::string, schema::Texture>;

/// Experiment 1 of the same paper: which of five textures is one of three of them, `comparisons`, as a real
/// sample in one block of trials and played in the other one. The path is that of the shortest texture
/// without its ends, the gain 1 mm/N or what the largest force permits. Errors: usage: fewer than two
/// textures, or more than there are keys, or a comparison that is none of them; unsuitable: a texture that is
/// not of force.
schema::Result<schema::Protocol> identification_protocol(const std::string& seed,
                                                         const NamedTextures& textures,
                                                         const std::vector<std::string>& comparisons);

/// The task of Fiene and Kuchenbecker 2007: one texture, 60 times, each at a gain between 0 and 2 times that
/// of the real sample, which is rated from -3 to 3 against it. Path and gain as of an identification, for
/// twice the force. Errors: usage, if there is not one texture; as identification_protocol.
schema::Result<schema::Protocol> amplitude_protocol(const std::string& seed, const NamedTextures& textures);

/// After Minsky et al. 1990: the textures are explored freely and put in order of roughness, three times.
/// `intended`: the parameter by which they were made, by their names; empty: unknown. Path and gain as of an
/// identification. Errors: as identification_protocol; usage: a texture without its number.
schema::Result<schema::Protocol> ordering_protocol(const std::string& seed, const NamedTextures& textures,
                                                   const std::map<std::string, double>& intended);

/// After the same paper: the gain of `adjusted` is changed until the goal is reached, five times from below
/// and five times from above, in steps of 1 dB between 0.05 and 4 times the protocol's gain. `textures` holds
/// it and, to match it, the other one as its reference; without another one it is its own. Path and gain as
/// of an identification, for four times the force. Errors: as identification_protocol; usage: more textures
/// than the goal has.
schema::Result<schema::Protocol> adjustment_protocol(const std::string& seed, const NamedTextures& textures,
                                                     const std::string& adjusted, schema::Goal goal);

/// The comparison bench of Wiertlewski 2011: each texture is played beside the real sample of each, in blocks
/// of one sample; the same or different. About ten trials of each texture beside its own sample, and as many
/// beside the others. Path and gain as of an identification. Errors: as identification_protocol.
schema::Result<schema::Protocol> fidelity_protocol(const std::string& seed, const NamedTextures& textures);

/// Adds the pacing cue to a protocol, and says so in its texts in kUsualLanguage.
void add_pacing_cue(schema::Protocol& protocol);

/// Adds a range of normal force to a protocol, with its texts in kUsualLanguage.
void add_normal_force(schema::Protocol& protocol, const schema::ForceRange& range);

/// Makes the stimuli (spatial/transform; or of `textures`, without what names their surface) and writes all
/// files. Errors: usage, if there is one of them and it is to be kept, or a folder of another kind;
/// cannot_write, also if the study has runs; those of stretching.
schema::Result<Study> write_study(const std::string& stem, const schema::Protocol& protocol,
                                  const NamedTextures& textures, schema::Existing existing);

/// Reads protocol and key, and checks that the key has the protocol's stretches or names, and that each
/// texture is the one of the key. `name`: STEM or STEM.protocol.json. Errors: of read_protocol,
/// read_protocol_key and read_texture; malformed: another key; unsuitable: a texture that was changed or
/// swapped, or is shorter than the path.
schema::Result<Study> read_study(const std::string& name);

/// The code and the SHA-256 of the standard. Precondition: a study of two intervals that was read.
const schema::CodedStimulus& standard_of(const schema::ProtocolKey& key);
/// Of an adjustment that matches: the texture that is played first.
const schema::CodedStimulus& reference_of(const Study& study);
const schema::CodedStimulus& stimulus_of(const schema::ProtocolKey& key, const std::string& code);

/// The stimuli that lose more than a tenth of their power at the slowest or fastest accepted speed, in words,
/// without their codes.
schema::Result<std::vector<std::string>> lost_band(const Study& study);

}  // namespace tacto::analysis
