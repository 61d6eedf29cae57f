// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The room's shader code compiled as C++ (namespace gloam::glsl), so that tests can hold it against its C++ twins
// without a device. Arrays that GLSL passes out are pointers here, hence `out` and `inout` mean nothing.
#pragma once

#include <glm/glm.hpp>

#include "math/sh_constants.h"

namespace gloam::glsl {

using namespace glm;        // NOLINT: vec3, dot, mix … as in GLSL
using namespace gloam::sh;  // NOLINT: the shared constants
using glm::dot;
using std::pow;

#define out
#define inout
#include "math/brdf.glsl"
#include "math/sh_product.glsl"
#include "math/sh_product_high.glsl"
#undef out
#undef inout

}  // namespace gloam::glsl
