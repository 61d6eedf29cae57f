// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// SH-6 in shaders: writes orders 2 to 4 out, pair by pair, and orders 5 and 6 as one table of triples, of which order 5
// takes the first part. A triple's weight is Gamma times the share of its six permutations that differ, so that the
// shader can add all six without asking whether indices are the same.
#include "math/sh_product_glsl.h"

#include <fmt/format.h>

#include <vector>

#include "math/sh_tables.h"

namespace gloam::sh {
namespace {

constexpr std::size_t kLineLength = 110;

/// Puts words into lines, with an end to each line.
std::string flowed(const std::vector<std::string>& words, const std::string& indent,
                   const std::string& line_end) {
  std::string text, line = indent;
  for (const std::string& word : words) {
    if (line.size() + word.size() + line_end.size() > kLineLength) {
      text += line + line_end + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + word;
  }
  return text + line + "\n";
}

std::string unrolledProduct(int order) {
  const tables::ProductPlan& plan = tables::productPlan(order);
  std::vector<std::string> words;
  std::size_t entry = 0;
  for (const tables::ProductPair& pair : plan.pairs) {
    std::string word = pair.j == pair.k ? fmt::format("GLOAM_SQUARE({})", pair.k)
                                        : fmt::format("GLOAM_PAIR({}, {})", pair.j, pair.k);
    for (int i = 0; i < pair.count; ++i, ++entry)
      word += fmt::format(" GLOAM_ADD({}, {:#.9g}f)", plan.entries[entry].i, plan.entries[entry].gamma);
    words.push_back(word);
  }
  const int size = coefficientCount(order);
  return fmt::format(
      "void shProduct{0}(const float f[{1}], const float g[{1}], out float h[{1}]) {{\n"
      "  float s;\n"
      "  for (int i = 0; i < {1}; ++i) h[i] = 0.0f;\n{2}}}\n\n",
      order, size, flowed(words, "  ", ""));
}

std::string tripleTable() {
  const auto triples = tables::gammaTriples(kMaxOrder);
  std::vector<std::string> indices, weights;
  for (const tables::GammaTriple& t : triples) {
    const int same = t.i == t.j && t.j == t.k ? 6 : t.i == t.j || t.j == t.k ? 2 : 1;
    indices.push_back(fmt::format("{}u,", t.i | t.j << 6 | t.k << 12));
    weights.push_back(fmt::format("{:#.9g}f,", t.value / static_cast<float>(same)));
  }
  indices.back().pop_back();
  weights.back().pop_back();
  return fmt::format(
      "// i | j << 6 | k << 12, and Gamma_ijk over the number of permutations that leave (i, j, k) as it "
      "is.\n"
      "const uint kShTriples[{0}] = {{\n{1}}};\nconst float kShTripleWeights[{0}] = {{\n{2}}};\n\n",
      triples.size(), flowed(indices, "  ", ""), flowed(weights, "  ", ""));
}

std::string tableProduct(int order) {
  return fmt::format(
      "void shProduct{0}(const float f[{1}], const float g[{1}], out float h[{1}]) {{\n"
      "  for (int i = 0; i < {1}; ++i) h[i] = 0.0f;\n"
      "  for (int t = 0; t < {2}; ++t) {{ GLOAM_ADD_TRIPLE(kShTriples[t], kShTripleWeights[t]) }}\n}}\n\n",
      order, coefficientCount(order), tables::gammaTriples(order).size());
}

}  // namespace

std::string productGlsl() {
  std::string text =
      "// gloam - real-time soft global illumination\n"
      "// SPDX-License-Identifier: MIT\n"
      "//\n"
      "// SH-6: h = f * g, h_i = sum of Gamma_ijk f_j g_k. Written by sh_write_glsl from exact integrals; do "
      "not edit.\n"
      "#ifndef GLOAM_MATH_SH_PRODUCT_GLSL\n"
      "#define GLOAM_MATH_SH_PRODUCT_GLSL\n\n"
      "#define GLOAM_PAIR(j, k) s = f[j] * g[k] + f[k] * g[j];\n"
      "#define GLOAM_SQUARE(k) s = f[k] * g[k];\n"
      "#define GLOAM_ADD(i, gamma) h[i] += gamma * s;\n"
      "#define GLOAM_ADD_TRIPLE(packed, weight) \\\n"
      "  uint i = packed & 63u, j = (packed >> 6) & 63u, k = packed >> 12; \\\n"
      "  float w = weight; \\\n"
      "  h[i] += w * (f[j] * g[k] + f[k] * g[j]); \\\n"
      "  h[j] += w * (f[i] * g[k] + f[k] * g[i]); \\\n"
      "  h[k] += w * (f[i] * g[j] + f[j] * g[i]);\n\n";
  for (int order = 2; order <= 4; ++order) text += unrolledProduct(order);
  text += tripleTable();
  for (int order = 5; order <= kMaxOrder; ++order) text += tableProduct(order);
  return text + "#endif\n";
}

}  // namespace gloam::sh
