// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Passes as commands. Only files of this room include this.
#pragma once

#include <vector>

#include "gpu/pass_check.h"

namespace gloam::gpu {

/// Descriptor sets of one frame: allocated one by one, gone all at once.
class DescriptorSets {
 public:
  explicit DescriptorSets(Device& device) : device_(device) {}
  ~DescriptorSets();
  DescriptorSets(const DescriptorSets&) = delete;
  DescriptorSets& operator=(const DescriptorSets&) = delete;

  VkDescriptorSet allocate(VkDescriptorSetLayout layout);
  void reset();

 private:
  Device& device_;
  std::vector<VkDescriptorPool> pools_;
  std::size_t current_ = 0;
};

void recordCompute(Device& device, DescriptorSets& sets, VkCommandBuffer commands, const ComputePass& pass);
/// `load[i]` tells whether colour target i keeps what it holds (else, without a clear value, it starts at zero).
void recordRaster(Device& device, DescriptorSets& sets, VkCommandBuffer commands, const RasterPass& pass,
                  const std::vector<bool>& load);

}  // namespace gloam::gpu
