// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// How long work gets its number of threads.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

namespace gloam {

/// Runs `work` with that many threads for what TBB spreads in it; 0: all cores. More than there are cores are given if asked
/// for: that a result does not depend on them has to be testable.
template <class Work>
void withThreads(int threads, const Work& work) {
  const int count = threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()));
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, std::size_t(count));
  tbb::task_arena(count).execute(work);
}

}  // namespace gloam
