// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A reference that was traced before, and what asks for something else (gloam compare --reference).
#pragma once

#include "compare_reference.h"
#include "compare_stage.h"

namespace gloam::cli {

/// Reads choice.reference, and has pictures drawn as it is: their size and supersampling are changed in `choice`. Throws
/// Error where that contradicts what was asked for, or the file is no reference.
ReferencePicture takeReference(CompareChoice& choice);

/// Throws Error where it is of another scene, light or camera, or does not hold what a contender covers. What cannot be
/// checked, and what else a reader should know of it, becomes a remark.
void checkGivenReference(const ReferencePicture& given, const CompareChoice& choice,
                         const CompareStage& stage, const std::vector<Contender>& contenders,
                         Console& console);

}  // namespace gloam::cli
