// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The one unit that compiles tinygltf's implementation.
#include <fstream>

#define TINYGLTF_IMPLEMENTATION
#include "scene/tinygltf_unit.h"
