// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "techniques/splatting/splatting_host.h"
#include "techniques/splatting/splatting_levels.h"

namespace gloam::splatting {

/// Pass "splatting.host" in place of those from ranges to upsampling, irradiance a pixel. `plan` without its view.
gpu::ImageRef recordOnHost(gpu::FrameGraph& graph, const frame::FrameInputs& inputs, const LightSets& lights,
                           HostSplatting& host, const HostPlan& plan);

}  // namespace gloam::splatting
