// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// sh_write_glsl FOLDER: renews sh_product.glsl and sh_product_high.glsl in it.
#include <cstdio>
#include <fstream>

#include "math/sh_product_glsl.h"

namespace {

bool write(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.flush();
  if (!file.good()) std::fprintf(stderr, "%s: cannot be written\n", path.c_str());
  return file.good();
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: sh_write_glsl FOLDER\n", stderr);
    return 2;
  }
  const std::string folder = arguments[1];
  const bool written = write(folder + "/sh_product.glsl", gloam::sh::productGlsl(2, 4)) &&
                       write(folder + "/sh_product_high.glsl", gloam::sh::productGlsl(5, 6));
  return written ? 0 : 2;
}
