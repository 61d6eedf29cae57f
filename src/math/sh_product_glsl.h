// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace gloam::sh {

/// Text of math/sh_product.glsl (orders 2 to 4) and math/sh_product_high.glsl (5 and 6), written from the exact Gamma.
/// The program sh_write_glsl renews the files; a test fails where they differ.
std::string productGlsl(int first_order, int last_order);

}  // namespace gloam::sh
