// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Work on a picture in bands of rows: parallel, with progress, the same numbers whatever the number of threads.
#pragma once

#include <gloam/error.h>

#include <functional>

namespace gloam {

/// A part of longer work: where in the whole it lies, and what it is called.
struct WorkStage {
  const Progress& progress;
  double begin, end;
  const char* what;
};

/// Calls work(first, last) for bands of `rows` rows that cover [0, height), several at a time. Throws Interrupted where
/// the listener asks to stop.
void forEachBand(int height, int rows, const WorkStage& stage,
                 const std::function<void(int first, int last)>& work);

}  // namespace gloam
