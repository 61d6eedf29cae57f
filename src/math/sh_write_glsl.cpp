// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// sh_write_glsl FILE: renews src/math/sh_product.glsl.
#include <cstdio>
#include <fstream>

#include "math/sh_product_glsl.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: sh_write_glsl FILE\n", stderr);
    return 2;
  }
  std::ofstream file(arguments[1], std::ios::binary);
  file << gloam::sh::productGlsl();
  file.flush();
  if (file.good()) return 0;
  std::fprintf(stderr, "%s: cannot be written\n", arguments[1]);
  return 2;
}
