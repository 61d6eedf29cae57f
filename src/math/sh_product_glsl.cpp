// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-6 in shaders, written out pair by pair: Mesa's software driver compiles order 6 so in 0.6 s, and a loop over a
// table of triples in 24 s. It also unrolls loops of up to 32 rounds only; what is left of a longer loop over a local
// array takes it a minute, hence the nested loop.
#include "math/sh_product_glsl.h"

#include <fmt/format.h>

#include "math/sh_tables.h"

namespace gloam::sh {
namespace {

constexpr std::size_t kLineLength = 110;

/// Appends a word to the last line, or to a new one.
void appendWord(std::string& text, const std::string& word) {
  const std::size_t line = text.size() - (text.rfind('\n') + 1);
  text += line == 0 ? "  " : line + word.size() + 1 > kLineLength ? "\n  " : " ";
  text += word;
}

std::string productFunction(int order) {
  const tables::ProductPlan& plan = tables::productPlan(order);
  std::string body;
  std::size_t entry = 0;
  for (const tables::ProductPair& pair : plan.pairs) {
    std::string word =
        pair.j == pair.k ? fmt::format("SQUARE({})", pair.k) : fmt::format("PAIR({}, {})", pair.j, pair.k);
    for (int i = 0; i < pair.count; ++i, ++entry)
      word += fmt::format(" ADD({}, {:#.9g}f)", plan.entries[entry].i, plan.entries[entry].gamma);
    appendWord(body, word);
  }
  return fmt::format(
      "void shProduct{0}(const float f[{1}], const float g[{1}], out float h[{1}]) {{\n"
      "  float s;\n"
      "  for (int a = 0; a < {0}; ++a) {{\n"
      "    for (int b = 0; b < {0}; ++b) h[{0} * a + b] = 0.0f;\n"
      "  }}\n{2}\n}}\n\n",
      order, coefficientCount(order), body);
}

}  // namespace

std::string productGlsl(int first_order, int last_order) {
  const std::string guard = fmt::format("GLOAM_MATH_SH_PRODUCT_{}_TO_{}_GLSL", first_order, last_order);
  std::string text = fmt::format(
      "// gloam - real-time soft global illumination\n"
      "// SPDX-License-Identifier: MIT\n"
      "//\n"
      "// SH-6: h = f * g, h_i = sum of Gamma_ijk f_j g_k. Written by sh_write_glsl from exact integrals; do "
      "not edit.\n"
      "#ifndef {0}\n#define {0}\n\n"
      "#define PAIR(j, k) s = f[j] * g[k] + f[k] * g[j];\n"
      "#define SQUARE(k) s = f[k] * g[k];\n"
      "#define ADD(i, gamma) h[i] += gamma * s;\n\n",
      guard);
  for (int order = first_order; order <= last_order; ++order) text += productFunction(order);
  return text + "#undef PAIR\n#undef SQUARE\n#undef ADD\n#endif\n";
}

}  // namespace gloam::sh
