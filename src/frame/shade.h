// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The last steps, which all techniques share: light becomes colour.
#pragma once

#include "frame/frame_inputs.h"

namespace gloam::frame {

/// Radiance that leaves towards the eye, at the rendering's size; halves.
struct Shaded {
  gpu::ImageRef direct;    ///< with emission, lamps, gloss and background; A is coverage
  gpu::ImageRef indirect;  ///< A is 0
};

/// Radiance of the lamps through both lobes and their shadow maps: "frame.local_light". Empty without lamps.
gpu::ImageRef recordLocalLight(gpu::FrameGraph& graph, const FrameInputs& inputs);

/// Makes of the terms of one path a single irradiance at full size: upsamples what is coarser
/// ("frame.upsample") and sums ("frame.add"). Empty where there is no term.
gpu::ImageRef gatherIrradiance(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                               Path path);

/// The same of gloss.
gpu::ImageRef gatherGloss(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                          Path path);

/// Puts emission, lamps, k_d / pi times irradiance, k_s times gloss and the background together:
/// "frame.shade".
Shaded recordShade(gpu::FrameGraph& graph, const FrameInputs& inputs, const Lighting& lighting,
                   gpu::ImageRef local_light, bool background);

/// Pictures of the size that was asked for.
struct FrameImages {
  gpu::ImageRef color;             ///< RGBA, linear radiance: direct + indirect
  gpu::ImageRef direct, indirect;  ///< RGB
  gpu::ImageRef normal;            ///< XYZ; these four are empty unless layers are asked for
  gpu::ImageRef depth, albedo, object;
};

/// Averages supersample x supersample pixels in linear radiance: "frame.resolve"; with `layers` also
/// "frame.layers": mean normal (unit) and albedo of the covered ones, depth and object of the one in the
/// middle.
FrameImages recordResolve(gpu::FrameGraph& graph, const FrameInputs& inputs, const Shaded& shaded,
                          bool layers);

}  // namespace gloam::frame
