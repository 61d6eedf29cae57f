// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// The host's kernel against plain sums, on every instruction set, and against the compute pass.
#include "techniques/prt/prt_relight_kernel.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>

#include "gpu/format.h"
#include "math/simd_test_targets.h"
#include "techniques/prt/prt_packer.h"
#include "techniques/prt/prt_test_frame.h"

namespace gloam::prt {
namespace {

/// Random transfer of blocks that are not all full, in the order of TransferChunk.
struct RandomChunk {
  RandomChunk(int n, bool colored, bool half_float) : coefficients(std::size_t(n)), half(half_float) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    std::uint32_t output = 3;  // what lies before and between stays as it is
    for (const std::uint32_t count : {32u, 1u, 17u, 32u}) {
      const auto number = static_cast<std::uint32_t>(blocks.size());
      // The third block is the first one's transfer in another light, as a second instance of a mesh is.
      blocks.push_back({number == 2 ? 0u : number, number * std::uint32_t(n), output, count});
      output += count + number;
    }
    lights.resize(2 * blocks.size() * coefficients);
    for (glm::vec3& light : lights) light = {value(random), value(random), 4.0f * value(random)};
    const auto fill = [&](std::vector<float>& values, std::vector<std::uint32_t>& words, std::size_t count) {
      const std::size_t word_count = wordCount(count, half);
      values.resize(blocks.size() * kBlockVertices * count);
      words.resize(blocks.size() * kBlockVertices * word_count);
      std::vector<std::uint32_t> of_vertex(word_count);
      for (std::size_t v = 0; v < blocks.size() * kBlockVertices; ++v) {
        for (std::size_t i = 0; i < count; ++i) {
          // Some are below the least normal half.
          const float x = value(random) * (i % 5 == 4 ? 1e-5f : 1.0f);
          values[v * count + i] = half ? gpu::floatFromHalf(gpu::halfFromFloat(x)) : x;
        }
        packWords({&values[v * count], count}, half, of_vertex.data());
        for (std::size_t w = 0; w < word_count; ++w)
          words[(v / kBlockVertices * word_count + w) * kBlockVertices + v % kBlockVertices] = of_vertex[w];
      }
    };
    fill(direct, direct_words, coefficients);
    if (colored) fill(indirect, indirect_words, 3 * coefficients);
    vertices = output;
  }
  ChunkInMemory memory() const {
    return {direct_words.data(), indirect.empty() ? nullptr : indirect_words.data(), blocks,
            int(coefficients), half};
  }
  /// Plain sums of vertex v of a block under the lights from `first` on.
  VertexLight plain(const VertexBlock& block, std::uint32_t v, std::uint32_t first) const {
    glm::dvec3 d(0.0), i(0.0);
    const std::size_t at = block.transfer * kBlockVertices + v;
    for (std::size_t k = 0; k < coefficients; ++k) {
      const glm::dvec3 light(lights[first + block.light + k]);
      d += double(direct[at * coefficients + k]) * light;
      if (indirect.empty()) continue;
      const float* m = &indirect[3 * (at * coefficients + k)];
      i += glm::dvec3(m[0], m[1], m[2]) * light;
    }
    return {glm::vec3(d), glm::vec3(i)};
  }

  std::size_t coefficients;
  bool half;
  std::vector<VertexBlock> blocks;
  std::vector<glm::vec3> lights;
  std::vector<float> direct, indirect;
  std::vector<std::uint32_t> direct_words, indirect_words;
  std::size_t vertices = 0;
};

void expectNear(const glm::vec3& got, const glm::vec3& want) {
  for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 3e-5f);
}

void expectPlainSums(const RandomChunk& chunk, bool in_parts) {
  const auto first_peak = static_cast<std::uint32_t>(chunk.lights.size() / 2);
  const VertexLight untouched{glm::vec3(-7.0f), glm::vec3(-8.0f)};
  std::vector<VertexLight> got(chunk.vertices, untouched), want = got;
  relight(chunk.memory(), chunk.lights, first_peak, in_parts, got);
  const glm::vec3 none(0.0f);
  for (const VertexBlock& block : chunk.blocks) {
    for (std::uint32_t v = 0; v < block.count; ++v) {
      VertexLight& light = want[block.output_ + v] = chunk.plain(block, v, 0);
      if (!in_parts) continue;
      const VertexLight peak = chunk.plain(block, v, first_peak);
      light = {glm::max(light.direct, none) + glm::max(peak.direct, none),
               glm::max(light.indirect, none) + glm::max(peak.indirect, none)};
    }
  }
  for (std::size_t v = 0; v < want.size(); ++v) {
    SCOPED_TRACE(v);
    expectNear(got[v].direct, want[v].direct);
    expectNear(got[v].indirect, want[v].indirect);
  }
}

TEST(PrtRelight, IsThePlainSumOnEveryInstructionSet) {
  onEveryTarget([](const char* target) {
    SCOPED_TRACE(target);
    for (const int n : {1, 9, 16, 25, 36})
      for (const bool colored : {false, true})
        for (const bool half_float : {false, true})
          for (const bool in_parts : {false, true}) {
            SCOPED_TRACE(testing::Message() << n << " coefficients, colored " << colored << ", halves "
                                            << half_float << ", in parts " << in_parts);
            expectPlainSums(RandomChunk(n, colored, half_float), in_parts);
          }
  });
}

// Points that fill no tile, thrown light and none, in two parts as a device with small buffers has it.
TEST(PrtRelight, GridsAreThePlainSumOnEveryInstructionSet) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  onEveryTarget([&](const char* target) {
    SCOPED_TRACE(target);
    for (const auto& [a, b, points, has_thrown] : {std::tuple(5, 5, 70, true), std::tuple(3, 5, 8, true),
                                                   std::tuple(6, 6, 33, true), std::tuple(4, 4, 40, false)}) {
      const std::size_t columns = std::size_t(a * a), rows = std::size_t(b * b), n = std::size_t(points);
      const std::size_t kept = std::size_t((a + b - 1) * (a + b - 1)), pairs = (columns + 1) / 2,
                        words = has_thrown ? 3 : 2;
      std::vector<float> visibility(kept * n);
      for (float& v : visibility) v = value(random);
      std::vector<glm::vec3> lights(columns + rows * kept);
      for (glm::vec3& light : lights) light = {value(random), value(random), value(random)};
      std::vector<std::uint32_t> thrown(has_thrown ? rows * pairs * 3 * n : 0);
      const auto halfOf = [&](std::size_t i, std::size_t j, std::size_t c, std::size_t p) {
        const std::size_t number = 3 * (j % 2) + c;
        return std::pair((((i * pairs + j / 2) * 3) + number / 2) * n + p, number % 2 * 16);
      };
      for (std::size_t i = 0; has_thrown && i < rows; ++i)
        for (std::size_t j = 0; j < columns; ++j)
          for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t p = 0; p < n; ++p) {
              const auto [word, shift] = halfOf(i, j, c, p);
              thrown[word] |= std::uint32_t(gpu::halfFromFloat(value(random))) << shift;
            }
      std::vector<std::uint32_t> fields(n * rows * words, 0xffffffffu);
      GridInMemory grid{.visibility = visibility.data(),
                        .points = std::uint32_t(points),
                        .light_order = a,
                        .field_order = b};
      for (const std::size_t first : {std::size_t(0), rows / 3}) {
        grid.first_row = std::uint32_t(first);
        grid.row_count = std::uint32_t(first == 0 ? rows / 3 : rows - first);
        if (has_thrown) grid.thrown = thrown.data() + first * pairs * 3 * n;
        multiplyGrid(grid, lights, fields.data());
      }
      for (std::size_t p = 0; p < n; ++p)
        for (std::size_t i = 0; i < rows; ++i) {
          double want[6] = {};
          for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < kept; ++k)
              want[c] += double(visibility[k * n + p]) * lights[columns + i * kept + k][int(c)];
            for (std::size_t j = 0; has_thrown && j < columns; ++j) {
              const auto [word, shift] = halfOf(i, j, c, p);
              want[3 + c] +=
                  double(gpu::floatFromHalf(std::uint16_t(thrown[word] >> shift))) * lights[j][int(c)];
            }
          }
          for (std::size_t h = 0; h < 2 * words; ++h) {
            const float got =
                gpu::floatFromHalf(std::uint16_t(fields[(p * rows + i) * words + h / 2] >> (h % 2 * 16)));
            ASSERT_NEAR(got, want[h], 1e-3 * std::abs(want[h]) + 1e-4)
                << a << " " << b << " point " << p << " row " << i;
          }
        }
    }
  });
}

/// A number of [number][vertex], as floats or halves in pairs.
float numberOf(const std::vector<std::uint32_t>& words, std::size_t words_of_vertex, bool half,
               std::size_t block, std::size_t vertex, std::size_t number) {
  const std::size_t word = half ? number / 2 : number;
  const std::uint32_t bits = words[(block * words_of_vertex + word) * kBlockVertices + vertex];
  return half ? gpu::floatFromHalf(std::uint16_t(bits >> (number % 2 * 16))) : std::bit_cast<float>(bits);
}

// Matrices from fewer bands and as many, of GS alone and with GI, V alone, with lobes that are baked in and not.
TEST(PrtRelight, GlossIsThePlainSumOnEveryInstructionSet) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  const auto wordsOf = [&](std::size_t blocks, std::size_t numbers, bool half) {
    std::vector<std::uint32_t> words(blocks * kBlockVertices * wordCount(numbers, half));
    for (std::uint32_t& word : words)
      word = half ? gpu::halfFromFloat(value(random)) | std::uint32_t(gpu::halfFromFloat(value(random))) << 16
                  : std::bit_cast<std::uint32_t>(value(random));
    return words;
  };
  onEveryTarget([&](const char* target) {
    SCOPED_TRACE(target);
    for (const auto& [a, b, has_indirect, cheap, half] :
         {std::tuple(5, 5, true, false, false), std::tuple(3, 5, true, false, true),
          std::tuple(4, 4, false, false, true), std::tuple(3, 4, false, true, false),
          std::tuple(5, 5, true, true, true), std::tuple(6, 6, true, false, false)}) {
      const std::size_t columns = std::size_t(a * a), rows = std::size_t(b * b),
                        triangle = columns * (columns + 1) / 2;
      const std::size_t kept = cheap ? rows : triangle + (rows - columns) * columns,
                        pairs = (columns + 1) / 2;
      const std::size_t per_light = columns + rows + (cheap ? rows * rows : 0), words = has_indirect ? 3 : 2;
      std::vector<VertexBlock> blocks = {
          {0, 0, 2, 32}, {1, std::uint32_t(per_light), 34, 9}, {0, std::uint32_t(per_light), 43, 1}};
      std::vector<glm::vec3> lights(2 * per_light);
      for (glm::vec3& light : lights) light = {value(random), value(random), value(random)};
      const auto direct = wordsOf(2, kept, half), indirect = wordsOf(2, rows * pairs * 6, half);
      std::vector<std::uint32_t> fields(46 * rows * words, 0xffffffffu);
      relightGloss({.direct = direct.data(),
                    .indirect = has_indirect ? indirect.data() : nullptr,
                    .blocks = blocks,
                    .light_order = a,
                    .field_order = b,
                    .cheap = cheap,
                    .half_float = half},
                   lights, fields.data());
      const auto got = [&](std::size_t v, std::size_t i, std::size_t h) {
        return gpu::floatFromHalf(std::uint16_t(fields[(v * rows + i) * words + h / 2] >> (h % 2 * 16)));
      };
      for (const VertexBlock& block : blocks) {
        const glm::vec3* light = &lights[block.light];
        for (std::size_t v = 0; v < block.count; ++v)
          for (std::size_t i = 0; i < rows; ++i) {
            glm::dvec3 first(0.0), further(0.0);
            const auto of = [&](std::size_t n) {
              return double(numberOf(direct, wordCount(kept, half), half, block.transfer, v, n));
            };
            for (std::size_t j = 0; cheap && j < rows; ++j)
              first += of(j) * glm::dvec3(light[columns + (1 + i) * rows + j]);
            for (std::size_t j = 0; !cheap && j < columns; ++j) {
              const std::size_t place = i >= columns
                                            ? triangle + (i - columns) * columns + j
                                            : std::max(i, j) * (std::max(i, j) + 1) / 2 + std::min(i, j);
              first += of(place) * glm::dvec3(light[j]);
            }
            for (std::size_t j = 0; has_indirect && j < columns; ++j)
              for (int c = 0; c < 3; ++c)
                further[c] += double(numberOf(indirect, wordCount(rows * pairs * 6, half), half,
                                              block.transfer, v, 3 * (2 * i * pairs + j) + std::size_t(c))) *
                              double(light[j][c]);
            first *= double(light[columns + i].x);
            for (int c = 0; c < 3; ++c) {
              ASSERT_NEAR(got(block.output_ + v, i, std::size_t(c)), first[c],
                          1e-3 * std::abs(first[c]) + 1e-4)
                  << a << b << i;
              if (has_indirect) {
                ASSERT_NEAR(got(block.output_ + v, i, std::size_t(3 + c)), further[c],
                            1e-3 * std::abs(further[c]) + 1e-4)
                    << a << b << i;
              }
            }
          }
      }
      for (const std::size_t untouched : {std::size_t(0), std::size_t(44)})
        EXPECT_EQ(fields[untouched * rows * words], 0xffffffffu);
    }
  });
}

TEST(PrtRelight, GridsTurnAsTheirBandsDo) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  onEveryTarget([&](const char* target) {
    SCOPED_TRACE(target);
    for (const auto& [order, words] :
         {std::tuple(1, 3u), std::tuple(5, 3u), std::tuple(5, 2u), std::tuple(6, 3u)}) {
      constexpr std::uint32_t kPoints = 37;
      const std::size_t rows = std::size_t(order * order), per_point = rows * words;
      std::vector<float> rotation;
      for (int l = 0; l < order; ++l)
        for (int k = 0; k < (2 * l + 1) * (2 * l + 1); ++k) rotation.push_back(value(random));
      std::vector<std::uint32_t> fields(kPoints * per_point), radiance(fields.size() + 1, 0xffffffffu);
      for (std::uint32_t& word : fields)
        word = gpu::halfFromFloat(value(random)) | std::uint32_t(gpu::halfFromFloat(value(random))) << 16;
      turnGrid({.fields = fields.data(),
                .rotation = rotation.data(),
                .radiance = radiance.data(),
                .points = kPoints,
                .words_of_row = words,
                .field_order = order});
      const auto at = [&](const std::vector<std::uint32_t>& numbers, std::size_t p, std::size_t row,
                          std::size_t h) {
        return gpu::floatFromHalf(
            std::uint16_t(numbers[p * per_point + row * words + h / 2] >> (h % 2 * 16)));
      };
      EXPECT_EQ(radiance.back(), 0xffffffffu);
      for (std::size_t p = 0; p < kPoints; ++p) {
        const float* r = rotation.data();
        for (std::size_t l = 0; l < std::size_t(order); ++l)
          for (std::size_t row = 0; row < 2 * l + 1; ++row, r += 2 * l + 1)
            for (std::size_t h = 0; h < 2 * words; ++h) {
              double want = 0.0;
              for (std::size_t b = 0; b < 2 * l + 1; ++b) want += double(r[b]) * at(fields, p, l * l + b, h);
              ASSERT_NEAR(at(radiance, p, l * l + row, h), want, 1e-3 * std::abs(want) + 1e-4)
                  << p << " " << l;
            }
      }
    }
  });
}

// Both ways draw the same picture; light that rings is taken in parts.
TEST(PrtRelight, HostAndDeviceAgree) {
  Scene scene = loadScene("builtin:furnace");
  scene.environment = loadEnvironment("sky:preetham?elevation=25");
  for (Mesh& mesh : scene.meshes) {
    auto transfer = std::make_shared<Transfer>();
    transfer->order = 5;
    for (const glm::vec3& n : mesh.normals) {
      const sh::Sh narrow = sh::evaluate(5, n);
      for (const float value : narrow.coefficients()) {
        transfer->direct.push_back(value);
        transfer->indirect.insert(transfer->indirect.end(), {value / 3, value / 2, value});
      }
    }
    mesh.transfer = transfer;
  }
  const PosedCamera camera = pose(scene, 0.0f).cameras.at(0);
  for (const char* half : {"off", "on"}) {
    for (const char* window : {"none", "auto"}) {
      const auto with = [&](const char* who) {
        return draw(scene, 64, camera, settings({{"half_float", half}, {"window", window}, {"relight", who}}),
                    half[1] == 'n' ? 0 : 100000);
      };
      const Picture host = with("host"), device = with("device");
      for (std::size_t i = 0; i < host.direct.size(); ++i) {
        ASSERT_NEAR(host.direct[i], device.direct[i], 1e-3f * std::abs(device.direct[i]) + 1e-4f);
        ASSERT_NEAR(host.indirect[i], device.indirect[i], 1e-3f * std::abs(device.indirect[i]) + 1e-4f);
      }
    }
  }
}

}  // namespace
}  // namespace gloam::prt
