// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Prints what `gloam bench sh` prints, without the rest of the program.
#include "math/sh_bench.h"

#include <cstdio>

#include "math/sh_exp_errors.h"

int main() {
  std::fputs(gloam::sh::benchTable(gloam::sh::bench()).c_str(), stdout);
  std::fputs(gloam::sh::expErrorTable(gloam::sh::expErrors()).c_str(), stdout);
  return 0;
}
