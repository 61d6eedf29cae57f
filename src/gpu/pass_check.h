// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a pass touches, and whether it may. Only files of this room include this.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "gpu/pass.h"

namespace gloam::gpu {

/// One part of a resource in one pass. Host passes have no Access: they run when the device is idle.
struct Touch {
  std::string binding;  ///< under which name, for messages
  ImageRef image;
  BufferRef buffer;
  Access access;
  bool reads = false, writes = false;
};

/// A clear, copy or the like.
struct TransferPass {
  std::string name;
  std::vector<Touch> touches;
  std::function<void(VkCommandBuffer)> commands;
};

using Pass = std::variant<ComputePass, RasterPass, HostPass, TransferPass>;
const std::string& nameOf(const Pass& pass);

/// Checks a pass against its program and gathers what it touches, each part once. Throws Error that names the pass and
/// the binding.
std::vector<Touch> checkPass(const Device& device, const Pass& pass);

/// Whether all that is touched holds data from elsewhere or from this frame.
bool isWritten(const Touch& touch, std::uint64_t frame);
void markWritten(const Touch& touch, std::uint64_t frame);

/// The layout in which a shader sees an image.
VkImageLayout layoutFor(VkDescriptorType type, const Image& image);
/// What stands behind a name: the draw's own, else the pass's; null if neither has it.
const BoundResource* lookUp(const std::string& name, const Bindings* draw, const Bindings& pass);
/// Values by constant id. Throws Error where the program has no constant of a name.
Specialization specializationOf(const std::string& place, const Interface& interface, const Bindings& pass,
                                const Bindings* draw);
/// Groups of a compute pass after rounding up; throws Error where they are more than the device takes.
std::array<std::uint32_t, 3> groupsOf(const Device& device, const ComputePass& pass);

}  // namespace gloam::gpu
