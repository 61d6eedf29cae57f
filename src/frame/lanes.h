// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/device.h"

namespace gloam::frame {

/// Whether rows of buffers are read by eight lanes together (lanes.glsl): where the device is the host, which pays for each lane's load.
inline bool readsByLanes(const gpu::Device& device) {
  return device.info().software && device.limits().subgroup_size >= 8;
}

}  // namespace gloam::frame
