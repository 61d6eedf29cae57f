// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "gpu/binder.h"
#include "gpu/reflection.h"

namespace gloam::gpu {

/// "a storage buffer", "an image with a sampler" …
const char* kindName(VkDescriptorType type);

/// Checks what was given for one binding of a shader: kind, use, size, dimension, format. Throws Error that begins with
/// `place`.
void checkBinding(const Device& device, const std::string& place, const Binding& binding,
                  const BoundResource& given);

}  // namespace gloam::gpu
