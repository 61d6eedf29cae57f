// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include <gloam/renderer.h>

#include <algorithm>

#include "gpu/device.h"

namespace gloam {

std::vector<DeviceInfo> devices() {
  std::vector<DeviceInfo> result;
  std::string unusable;
  for (const gpu::DeviceInfo& info : gpu::Device::list()) {
    if (info.missing.empty()) {
      result.push_back({info.index, info.name, info.driver, info.software});
    } else {
      unusable += "; " + info.name + " lacks " + info.missing;
    }
  }
  if (result.empty())
    throw Error("gpu",
                "no usable Vulkan 1.3 device; Debian's package mesa-vulkan-drivers brings a software driver" +
                    unusable);
  std::stable_sort(result.begin(), result.end(),
                   [](const DeviceInfo& a, const DeviceInfo& b) { return !a.software && b.software; });
  return result;
}

}  // namespace gloam
