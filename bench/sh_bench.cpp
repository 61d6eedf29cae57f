// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Prints what `gloam bench sh` prints, without the rest of the program.
#include "math/sh_bench.h"

#include <cstdio>

int main() {
  std::fputs(gloam::sh::benchTable(gloam::sh::bench()).c_str(), stdout);
  return 0;
}
