// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gloam::sh {

/// Text of math/sh_product.glsl, written from the exact Gamma. `ninja sh_write_glsl && sh_write_glsl FILE` renews the
/// file; a test fails where it differs.
std::string productGlsl();

}  // namespace gloam::sh
