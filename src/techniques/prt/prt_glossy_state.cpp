// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Glossy transfer (PRT-2) between passes and at the end of a bake: Sloan, Kautz, Snyder 2002, section 4.2. GS comes from V to
// a + b - 1 bands (math/sh_high_order.h): the same numbers as those of quadrature over y_i y_j.
#include "techniques/prt/prt_glossy_state.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "math/brdf.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_shared.h"

namespace gloam::prt {
namespace {

constexpr std::size_t kMaxPacked = sh::kMaxCoefficients * (sh::kMaxCoefficients + 1) / 2;

int bandOf(int i) {
  return int(std::sqrt(double(i) + 0.5));
}

// Packed GS to a matrix of colour, the same thrice.
void spread(const GlossyLayout& layout, const sh::PackedMatrix& shape, const float* packed, float* matrix) {
  std::fill_n(matrix, layout.matrixSize(), 0.0f);
  for (int i = 0; i < layout.fieldCount(); ++i) {
    float* row = matrix + std::size_t(i) * layout.columnStride();
    for (int j = 0; j < layout.lightCount(); ++j) row[j] = packed[shape.at(i, j)];
  }
  std::copy_n(matrix, layout.colorSize(), matrix + layout.colorSize());
  std::copy_n(matrix, layout.colorSize(), matrix + 2 * layout.colorSize());
}

float greatestInMap(const Scene& scene, const TextureSlot& slot, int channel) {
  if (!slot) return 1.0f;
  const std::vector<std::uint8_t>& rgba = scene.textures[std::size_t(slot.texture)].rgba;
  std::uint8_t greatest = 0;
  for (std::size_t i = std::size_t(channel); i < rgba.size(); i += 4) greatest = std::max(greatest, rgba[i]);
  return float(greatest) / 255.0f;
}

}  // namespace

float greatestSpecular(const Scene& scene, const Material& material) {
  const float metal = material.metallic * greatestInMap(scene, material.metallic_roughness_map, 2);
  const glm::vec3 base(material.base_color);
  return glm::mix(0.04f * material.specular, std::max({base.r, base.g, base.b}), metal);
}

float shownExponent(int field_order, float exponent) {
  return std::clamp(exponent, 1.0f, kSharpestLobe[field_order]);
}

std::vector<std::uint8_t> glossyInstances(const Scene& scene, const PosedScene& posed, GlossyMeshes which) {
  std::vector<std::uint8_t> glossy(posed.instances.size(), 0);
  for (std::size_t i = 0; i < glossy.size(); ++i) {
    const Instance& instance = posed.instances[i];
    const Mesh& mesh = scene.meshes[std::size_t(instance.mesh)];
    if (which == GlossyMeshes::kNone || instance.deformed() || mesh.indices.empty()) continue;
    glossy[i] = which == GlossyMeshes::kAll ||
                greatestSpecular(scene, scene.materials[std::size_t(mesh.material)]) >= kShinySpecular;
  }
  return glossy;
}

GlossyLayout glossyLayout(const BakeOptions& options) {
  if (options.glossy == GlossyMeshes::kNone) return {};
  const int field = options.glossy_order > 0 ? options.glossy_order : options.order;
  const int light =
      options.glossy_light_order > 0 ? options.glossy_light_order : std::min(options.order, field);
  return {light, field};
}

GlossyState makeGlossyState(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                            const BakeOptions& options) {
  const std::vector<std::uint8_t> glossy = glossyInstances(scene, posed, options.glossy);
  std::vector<std::uint8_t> has_row(points.size(), 0);
  for (std::size_t i = 0; i < glossy.size(); ++i) {
    if (!glossy[i]) continue;
    const std::size_t first = points.first_vertex[i];
    const std::size_t count = scene.meshes[std::size_t(posed.instances[i].mesh)].vertexCount();
    for (std::size_t v = first; v < first + count; ++v) {
      if (points.point_of_vertex[v] != BakePoints::kNoPoint) has_row[points.point_of_vertex[v]] = 1;
    }
  }
  GlossyState state;
  if (std::ranges::find(has_row, 1) == has_row.end()) return state;
  state.layout = glossyLayout(options);
  state.first_row.resize(points.size() + 1, 0);
  for (std::size_t p = 0; p < points.size(); ++p) state.first_row[p + 1] = state.first_row[p] + has_row[p];
  state.visibility.resize(state.rows() * state.layout.visibilityCount());
  if (options.kind != TransferKind::kInterreflected) return state;
  for (std::vector<float>* matrices : {&state.previous, &state.next, &state.sum})
    matrices->resize(state.rows() * state.layout.matrixSize() + kRowPadding);
  return state;
}

std::size_t glossyStateBytes(const GlossyLayout& layout, bool bounces) {
  return (layout.visibilityCount() + (bounces ? 3 * layout.matrixSize() : 0)) * sizeof(float);
}

void GlossyState::finishPass(int pass) {
  if (empty() || previous.empty()) return;
  if (pass > 0) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += next[i];
    previous.swap(next);
    return;
  }
  const sh::Tripling& tripling = sh::Tripling::of(layout.light_order, layout.field_order);
  tbb::parallel_for(std::size_t(0), rows(), [&](std::size_t r) {
    float packed[kMaxPacked];
    tripling.expand({&visibility[r * layout.visibilityCount()], layout.visibilityCount()}, packed);
    spread(layout, tripling.shape(), packed, &previous[r * layout.matrixSize()]);
  });
}

GlossyTables::GlossyTables(const GlossyLayout& layout, const DirectionTables& tables)
    : stride((layout.visibilityCount() + 15) / 16 * 16), field_order(layout.field_order), layout(layout) {
  const std::size_t tiles = std::size_t(tables.tiles), count = layout.visibilityCount();
  basis = hwy::AllocateAligned<float>(tiles * kTileSize * stride);
  tile_sums = hwy::AllocateAligned<float>(tiles * stride);
  if (!basis || !tile_sums) throw std::bad_alloc();
  tbb::parallel_for(std::size_t(0), tiles, [&](std::size_t t) {
    double values[sh::kMaxHighCoefficients], sums[sh::kMaxHighCoefficients] = {};
    for (int k = 0; k < kTileSize; ++k) {
      float* row = basis.get() + (t * kTileSize + std::size_t(k)) * stride;
      std::fill_n(row, stride, 0.0f);
      const glm::dvec3 direction = glm::normalize(glm::dvec3(tables.direction(int(t), k)));
      sh::evaluateHigh(layout.visibilityOrder(), direction, values);
      for (std::size_t i = 0; i < count; ++i) row[i] = float(values[i]), sums[i] += values[i];
    }
    float* sum = tile_sums.get() + t * stride;
    std::fill_n(sum, stride, 0.0f);
    for (std::size_t i = 0; i < count; ++i) sum[i] = float(sums[i]);
  });
}

std::size_t GlossyTables::memoryBytes(const GlossyLayout& layout, int tiles) {
  return std::size_t(tiles) * (kTileSize + 1) * ((layout.visibilityCount() + 15) / 16 * 16) * sizeof(float);
}

void writeGlossy(const GlossyState& state, const BakePoints& points, std::size_t first_vertex,
                 std::size_t vertex_count, const sh::HighRotation& object_from_world, float exponent,
                 GlossyTransfer& transfer) {
  const GlossyLayout& layout = state.layout;
  const std::size_t fields = std::size_t(layout.fieldCount()), lights = std::size_t(layout.lightCount());
  transfer.light_order = layout.light_order;
  transfer.field_order = layout.field_order;
  transfer.exponent = exponent;
  transfer.visibility.resize(vertex_count * layout.visibilityCount());
  if (!state.sum.empty()) transfer.indirect.resize(vertex_count * fields * lights * 3);
  std::vector<float> factors(fields, 1.0f);
  for (std::size_t i = 0; i < fields && exponent > 0.0f; ++i) {
    factors[i] = brdf::phongBandFactor(bandOf(int(i)), shownExponent(layout.field_order, exponent));
  }
  tbb::parallel_for(std::size_t(0), vertex_count, [&](std::size_t v) {
    const std::uint32_t point = points.point_of_vertex[first_vertex + v];
    if (point == BakePoints::kNoPoint) return;
    const std::size_t row = state.first_row[point];
    object_from_world.apply(layout.visibilityOrder(), &state.visibility[row * layout.visibilityCount()], 1,
                            &transfer.visibility[v * layout.visibilityCount()], 1);
    if (state.sum.empty()) return;
    float turned[sh::kMaxCoefficients];
    std::vector<float> half(fields * lights);
    for (std::size_t c = 0; c < 3; ++c) {
      const float* matrix = &state.sum[row * layout.matrixSize() + c * layout.colorSize()];
      for (std::size_t j = 0; j < lights; ++j)
        object_from_world.apply(layout.field_order, matrix + j, layout.columnStride(), &half[j], lights);
      for (std::size_t i = 0; i < fields; ++i) {
        object_from_world.apply(layout.light_order, &half[i * lights], 1, turned, 1);
        for (std::size_t j = 0; j < lights; ++j)
          transfer.indirect[((v * fields + i) * lights + j) * 3 + c] = factors[i] * turned[j];
      }
    }
  });
}

double cheapError(const GlossyState& state) {
  if (state.rows() == 0) return 0.0;
  const GlossyLayout& layout = state.layout;
  const sh::Tripling& tripling = sh::Tripling::of(layout.light_order, layout.field_order);
  std::vector<double> weights(std::size_t(tripling.shape().size()), 0.0);
  for (int i = 0; i < layout.fieldCount(); ++i) {
    const double lobe = double(brdf::phongBandFactor(bandOf(i), kSharpestLobe[layout.field_order]));
    for (int j = 0; j < layout.lightCount(); ++j)
      weights[std::size_t(tripling.shape().at(i, j))] += std::pow(lobe / (bandOf(j) + 1), 2.0);
  }
  std::vector<glm::dvec2> squares(state.rows());  // of the difference, of the whole
  tbb::parallel_for(std::size_t(0), state.rows(), [&](std::size_t r) {
    float whole[kMaxPacked], cheap[kMaxPacked];
    const float* visibility = &state.visibility[r * layout.visibilityCount()];
    tripling.expand({visibility, layout.visibilityCount()}, whole);
    tripling.expand({visibility, std::size_t(layout.fieldCount())}, cheap);
    for (std::size_t e = 0; e < weights.size(); ++e) {
      const double difference = double(cheap[e]) - double(whole[e]);
      squares[r] += weights[e] * glm::dvec2(difference * difference, double(whole[e]) * double(whole[e]));
    }
  });
  glm::dvec2 sum(0.0);
  for (const glm::dvec2& square : squares) sum += square;
  return sum.y > 0.0 ? std::sqrt(sum.x / sum.y) : 0.0;
}

}  // namespace gloam::prt
