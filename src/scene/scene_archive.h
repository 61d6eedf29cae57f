// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A Scene as one run of bytes, for the way from one process to the next of the same build: no file format. Holds what
// importers make (no transfer, no environment).
#pragma once

#include <gloam/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gloam {

std::vector<std::uint8_t> packScene(Scene& scene);  // left as it is
/// The reverse. The bytes may come from a process that went wrong: sizes are checked, indices are not (checkScene does
/// that). Throws Error.
Scene unpackScene(std::span<const std::uint8_t> bytes);

}  // namespace gloam
