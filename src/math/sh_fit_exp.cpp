// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// sh_fit_exp FILE: renews sh_exp_tables.h.
#include <cstdio>
#include <fstream>

#include "math/sh_exp_fit.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: sh_fit_exp FILE\n", stderr);
    return 2;
  }
  const std::string text = gloam::sh::expTablesText();
  std::ofstream file(arguments[1], std::ios::binary);
  file << text;
  file.flush();
  if (!file.good()) std::fprintf(stderr, "%s: cannot be written\n", arguments[1]);
  return file.good() ? 0 : 2;
}
