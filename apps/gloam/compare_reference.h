// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Where the reference of a comparison comes from: a file that was given, the same command's last run, or the path tracer.
#pragma once

#include <gloam/reference.h>

#include <optional>
#include <string>

#include "console.h"

namespace gloam::cli {

struct ReferencePicture {
  LayeredImage layers;  ///< all that `imageOf` takes parts from
  std::filesystem::path file;
  std::string text;  ///< where it came from, for people
  std::string
      version;  ///< of what traced it: of gloam, and the tracer's revision; empty where the file does not say
  std::optional<int> samples;
  std::optional<double> noise;
  int bounces = 1, environment_order = 0, supersample = 1;
  bool background = false;  ///< drawn behind the scene
};

/// Reads a reference that was given: throws Error where it does not say what light it holds, holds values that are not
/// finite, lacks a layer, has attributes that cannot be or another size than they say.
ReferencePicture readReference(const std::filesystem::path& file);

/// What a reference is of.
struct ReferenceScene {
  const Scene& scene;
  const PosedScene& posed;
  const PosedCamera& camera;
  const Environment& environment;
};
/// Throws Error where a reference that was given is of another scene, light or camera. False where it does not say.
bool checkReference(const ReferencePicture& reference, const ReferenceScene& scene);

/// `file` where it holds what this call would trace, with as many samples at least or as little noise; else traces, and
/// writes it there. Interrupted work lies beside it and is taken up again.
ReferencePicture traceReference(const ReferenceScene& scene, const ReferenceOptions& options, int samples,
                                float noise, const std::filesystem::path& file, const Progress& progress,
                                Console& console);

/// Light alone (R G B A, direct, indirect), as halves, for one technique: `part` of what the reference holds, of paths with so many
/// bounces. Alpha, or objects where the background is drawn, and "seen" of instances that glow tell which pixels are measured
/// (surfaceMask).
LayeredImage lightForPart(const ReferencePicture& reference, const Coverage& part, int bounces,
                          const std::vector<bool>& glowing);
/// False where the file has that part only with the light of further bounces in one sum.
bool tellsBounces(const ReferencePicture& reference, const Coverage& part, int bounces);

/// The relative error ||a - b|| / ||b|| that noise alone is expected to make of a part of the light, over pixels of `mask` of that
/// part's own picture `light`. Nothing where the file does not tell: `gloam reference --parts` of this gloam does.
std::optional<double> relativeNoise(const ReferencePicture& reference, const Coverage& part, int bounces,
                                    const Image& light, const Image& mask);
/// The same of all light that the reference holds.
std::optional<double> relativeNoise(const ReferencePicture& reference, const std::vector<bool>& glowing);

/// "gloam 1.2.3, tracer 4": as ReferencePicture::version has it.
std::string tracerVersion();

}  // namespace gloam::cli
