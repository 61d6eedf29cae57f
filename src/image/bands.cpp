// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "image/bands.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>

namespace gloam {

void forEachBand(int height, int rows, const WorkStage& stage,
                 const std::function<void(int first, int last)>& work) {
  const int bands = (height + rows - 1) / rows;
  std::mutex listener;
  int finished = 0;
  bool stopped = false;
  tbb::parallel_for(0, bands, [&](int band) {
    {
      const std::lock_guard lock(listener);
      stopped = stopped || stage.progress.stopRequested();
      if (stopped) return;
    }
    work(band * rows, std::min(height, (band + 1) * rows));
    const std::lock_guard lock(listener);
    const double part = double(++finished) / double(bands);
    stage.progress.report(stage.begin + part * (stage.end - stage.begin), stage.what);
  });
  if (stopped) throw Interrupted(std::string(stage.what) + ": interrupted");
}

}  // namespace gloam
