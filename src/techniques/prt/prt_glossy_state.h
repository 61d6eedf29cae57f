// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// What a bake keeps of glossy transfer (PRT-2), and the tables that its passes share.
#pragma once

#include <gloam/bake.h>
#include <hwy/aligned_allocator.h>

#include <cstdint>
#include <vector>

#include "math/sh_high_order.h"
#include "techniques/prt/prt_bake_directions.h"
#include "techniques/prt/prt_bake_points.h"

namespace gloam::prt {

/// Sizes of a point's numbers. A matrix of colour stands as [red, green, blue][row i][column j rounded up to 4].
struct GlossyLayout {
  int light_order = 0, field_order = 0;  ///< a columns' bands, b rows' bands
  int lightCount() const { return light_order * light_order; }
  int fieldCount() const { return field_order * field_order; }
  int visibilityOrder() const { return light_order > 0 ? light_order + field_order - 1 : 0; }
  std::size_t visibilityCount() const { return std::size_t(visibilityOrder() * visibilityOrder()); }
  std::size_t columnStride() const { return std::size_t((lightCount() + 3) / 4 * 4); }
  std::size_t colorSize() const { return std::size_t(fieldCount()) * columnStride(); }
  std::size_t matrixSize() const { return 3 * colorSize(); }
};

/// Rows of the points that have matrices; all empty where no mesh has any.
struct GlossyState {
  GlossyLayout layout;
  std::vector<std::uint32_t> first_row;  ///< [point + 1]: a point has a row where the next one's differs
  std::vector<float> visibility;         ///< [row][coefficient]: V, 0 below the tangent plane
  std::vector<float> previous, next;     ///< [row] matrices of colour: M^{b-1} and M^b; empty without bounces
  std::vector<float> sum;                ///< [row]: of finished M^b

  bool empty() const { return first_row.empty(); }
  std::size_t rows() const { return first_row.empty() ? 0 : first_row.back(); }
  bool has(std::size_t point) const { return !empty() && first_row[point + 1] > first_row[point]; }
  /// As BakeState::finishPass: M^0 is GS.
  void finishPass(int pass);
};

/// The exponent with which so many bands show a lobe: at most kSharpestLobe (prt_shared.h).
float shownExponent(int field_order, float exponent);

/// From what share of mirrored light on a mesh gets matrices of its own accord, and is followed as a mirror.
inline constexpr float kShinySpecular = 0.1f;

/// By instance, whether its mesh gets matrices.
std::vector<std::uint8_t> glossyInstances(const Scene& scene, const PosedScene& posed, GlossyMeshes which);
/// The greatest share of light that a material mirrors anywhere (k_s), by its factors and maps.
float greatestSpecular(const Scene& scene, const Material& material);

/// Orders as the options give them; a and b are 0 where there is nothing glossy.
GlossyLayout glossyLayout(const BakeOptions& options);
GlossyState makeGlossyState(const Scene& scene, const PosedScene& posed, const BakePoints& points,
                            const BakeOptions& options);
/// Bytes a point with matrices takes, without what is in BakeState.
std::size_t glossyStateBytes(const GlossyLayout& layout, bool bounces);

/// Basis functions of a + b - 1 bands at all directions, coefficients of one direction side by side, and their sums over
/// tiles: what is found wholly blocked is one addition a coefficient for 16 directions.
struct GlossyTables {
  GlossyTables(const GlossyLayout& layout, const DirectionTables& tables);
  /// Coefficients rounded up to 16.
  std::size_t stride = 0;
  int field_order = 0;
  GlossyLayout layout;
  hwy::AlignedFreeUniquePtr<float[]> basis,
      tile_sums;                        ///< [tile * 16 + lane][coefficient], [tile][coefficient]
  std::vector<std::uint8_t> instances;  ///< glossyInstances
  float exponent = 0.0f;  ///< of every lobe on the way, where one is baked in; 0: the materials'
  const float* basisOf(std::size_t direction) const { return basis.get() + direction * stride; }
  static std::size_t memoryBytes(const GlossyLayout& layout, int tiles);
};

/// Attaches GU, GS and GI of the vertices of an instance to its transfer, in the object's axes.
void writeGlossy(const GlossyState& state, const BakePoints& points, std::size_t first_vertex,
                 std::size_t vertex_count, const sh::HighRotation& object_from_world, float exponent,
                 GlossyTransfer& transfer);

/// BakeReport::cheap_error.
double cheapError(const GlossyState& state);

}  // namespace gloam::prt
