// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The packaged header tiny_gltf.h as this project uses it: structures and the JSON side only. Files, buffers and pictures
// are read by our own bounded code. The namespace is renamed, so that a host program may bring its own tinygltf.
#pragma once

#include <nlohmann/json.hpp>

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define tinygltf gloam_tinygltf
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpragmas"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <tiny_gltf.h>
#pragma GCC diagnostic pop
#undef tinygltf
