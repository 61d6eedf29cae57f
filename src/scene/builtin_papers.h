// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Scenes in the kind of those of Nichols, Wyman 2009: with as many triangles, made by code.
#pragma once

#include "scene/scene_builder.h"

namespace gloam {

Scene makeTeapot(const Detail& detail, NamedValues& values);
Scene makeStatue(const Detail& detail, NamedValues& values);
Scene makeSerpent(const Detail& detail, NamedValues& values);
Scene makeFlyingHares(const Detail& detail, NamedValues& values);
Scene makeClutter(const Detail& detail, NamedValues& values);

}  // namespace gloam
