// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a reference picture says of itself: names of its layers and attributes (docs/images.md), and how they are put
// together and taken apart again.
#pragma once

#include <string>

#include "reference/path_tracer_state.h"

namespace gloam::reference {

inline constexpr int kMaxBounces = 1000;
/// Attribute: variances and covariances of parts, which varianceOf() reads.
inline constexpr const char* kPartVariance = "gloam.part_variance";
/// The same of all light together.
inline constexpr const char* kVariance = "gloam.variance";

/// "environment_direct", …, "seen": layers, and words of the attributes gloam.light and gloam.sources.
/// Indirect light of more bounces than one has their number: "environment_indirect_2".
std::string nameOf(LightPath path);
bool isDirect(LightPath path);  ///< also what is seen
/// kSeen always.
bool covers(const Coverage& light, LightPath path);
/// "environment_direct local_direct", or "none".
std::string coverageText(const Coverage& light);
/// True where `part` holds nothing that `whole` does not.
bool isPartOf(const Coverage& part, const Coverage& whole);

/// The picture so far, of that part of the light. Throws Error where the tracer does not follow it.
LayeredImage pictureOf(const TracerState& state, const Coverage& part, bool variance, bool parts);

}  // namespace gloam::reference
