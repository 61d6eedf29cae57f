// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Baking precomputed radiance transfer (Sloan, Kautz, Snyder 2002; PRT-1, PRT-3).
#pragma once

#include <gloam/scene.h>

#include <filesystem>

namespace gloam {

enum class TransferKind {
  kUnshadowed,      ///< DU: the clamped cosine alone
  kShadowed,        ///< DS
  kInterreflected,  ///< DI: `bounces` passes on top of DS
};

/// Which meshes get glossy transfer (PRT-2): matrices beside vectors.
enum class GlossyMeshes {
  kNone,
  kShiny,  ///< those whose material mirrors 10 % or more somewhere: metals, mostly
  kAll,
};

struct BakeOptions {
  TransferKind kind = TransferKind::kInterreflected;
  int order = 5;           ///< 3 to 6
  int bounces = 2;         ///< for kInterreflected, 1 to 64
  int directions = 10000;  ///< a vertex in the first pass, 256 to 65536; rounded up to whole tiles of 16
  /// Of the same set, 64 to 65536; the even subset that is nearest in size is taken. 0: 1024, or 256 in rooms, where nearly
  /// all of them meet something (unless matrices are baked) and all light errs as little.
  int bounce_directions = 0;
  int threads = 0;                            ///< 0: all cores. The result does not depend on it
  float time_s = 0.0f;                        ///< instant at which the scene is posed
  GlossyMeshes glossy = GlossyMeshes::kNone;  ///< GU, GS or GI as `kind` is DU, DS or DI
  int glossy_order = 0;                       ///< bands of transferred radiance, 3 to 6; 0: `order`
  int glossy_light_order = 0;    ///< bands of light, 3 to the lesser of `order` and glossy_order; 0: that
  float glossy_exponent = 0.0f;  ///< bakes that Phong lobe in, 1 to 1000; 0: each material's, at run time
  /// Diffuse transfer of the texels of a lightmap, of meshes that have texture coordinates for one: within 0 to 1, and no
  /// two triangles over each other. The others keep vertices. `texels` a side, 4 to 4096, or as many as make
  /// `texels_per_metre`, then `texels` at most (0: 4096). Both 0: none.
  int texels = 0;
  float texels_per_metre = 0.0f;
  int uv_set = 1;  ///< index into Mesh::uv_sets, 0 to 7
  /// Lobes that matrices cannot show (sharper than their bands, or of meshes without matrices) are followed ray by ray on the
  /// way: mirrors and metals throw caustics. Of materials that mirror 10 % or more somewhere; kInterreflected only.
  bool caustics = true;
  /// Standard error of a point's DS, V and first bounce at which it takes no further directions, as a part of the norm of
  /// what an open point has, 1e-5 to 1. `directions` is then the most that a point takes. 0: all take all of them.
  float error = 0.0f;
  std::size_t memory_bytes = 0;  ///< most that the bake may take; 0: as much as it likes
  /// Each root node (each child of a root that stands alone without meshes) is an object of its own, blocked and lit by
  /// itself alone: objects may then move against one another. Else all rigid meshes are one object, numbered 0.
  bool apart = false;
  /// Finished work is kept here (when stopped, and every 20 s against being killed) and taken up again by the same bake of
  /// the same scene, with the same bits as without interruption. Any other file of that name is an Error: it is neither
  /// used nor overwritten. Empty: none. Removed at the end.
  std::filesystem::path checkpoint;
  /// At the end the checkpoint stays, with all of the work: for who has more to do before the result is safe in a file, and
  /// calls removeBakeCheckpoint() then.
  bool keep_checkpoint = false;
};

/// The checkpoint of a bake, with those of its objects where they are baked apart. What is not there is no error.
void removeBakeCheckpoint(const std::filesystem::path& checkpoint);

/// How the result will be written: as floats or halves (WriteOptions), and compressed or not (CompressOptions).
struct BakeFileForm {
  bool half_float = false;
  int clusters = 0, vectors = 0;  ///< 0 clusters: not compressed
};

/// What a bake will take, before it starts.
struct BakeEstimate {
  std::size_t vertices = 0, triangles = 0;
  std::size_t glossy_vertices = 0;  ///< of these, the ones with matrices
  std::size_t texels = 0;           ///< of all lightmaps, without what no triangle covers
  std::size_t rays = 0;  ///< of the first pass: half of all directions are below a vertex's horizon
  /// At most, beside what the scene and the program take already. Hits that are kept are foretold by a few rays from some
  /// vertices, and a margin.
  std::size_t memory_bytes = 0;
  std::size_t least_memory_bytes = 0;  ///< without hits kept for later bounces, which are then traced again
  std::size_t file_bytes = 0;          ///< at most
};
/// Throws Error for options out of range.
BakeEstimate estimateBake(const Scene& scene, const BakeOptions& options, const BakeFileForm& form = {});

/// What it took, without what a checkpoint brought along.
struct BakeReport {
  std::size_t vertices = 0;     ///< points baked: vertices at one place with one normal are one
  std::size_t rays = 0;         ///< of the first pass
  std::size_t bounce_rays = 0;  ///< of all bounces together
  int bounce_directions = 0;    ///< of each bounce, at most; 0 without any
  double first_pass_s = 0.0;    ///< wall clock
  double bounces_s = 0.0;
  std::vector<double> bounce_s;  ///< of each bounce
  bool resumed = false;
  double mean_directions =
      0.0;  ///< a point took in the first pass, as many as it is asked for on both sides of its horizon
  int most_directions = 0;     ///< that any point took
  std::size_t rays_saved = 0;  ///< of the first pass, by points that took fewer
  double error = 0.0;  ///< BakeOptions::error, as estimated: RMS over the points; 0 where all take all
  std::size_t above_error = 0;    ///< points that took all directions and are not known to be that good
  std::size_t glossy_points = 0;  ///< of the points, those with matrices
  std::size_t texels = 0;         ///< of the points, those of lightmaps
  Warnings warnings;              ///< meshes that keep vertices though texels were asked for; that are no manifold
  /// Relative RMS error, over these, of what prt.glossy=cheap shows: V to no more bands than the radiance has. Seen through
  /// the sharpest lobe that is shown, under light whose coefficients fall with their band as 1 / (l + 1).
  double cheap_error = 0.0;
};

/// Bakes all rigid meshes of the scene as one object in its pose: every mesh shadows and lights every other. Skinned and
/// morphed ones are left out. Instances are made unique first, since each has its own transfer. Transfer is that of the
/// side that a vertex's normal looks at; backs of surfaces block light and send none on. Same bits for any number of
/// threads. Throws Error for options out of range and for a scene without rigid triangles, Interrupted when asked to stop
/// (the checkpoint stays).
Scene bakeTransfer(const Scene& scene, const BakeOptions& options, const Progress& progress = {},
                   BakeReport* report = nullptr);

struct TessellateOptions {
  /// Split until transfer that is interpolated over a triangle differs from what it is there by less than this share of
  /// what a surface receives that nothing shadows: the root mean square over small lights from everywhere. 0.005 to 1. Where
  /// light ends at an edge no triangle is small enough: the report has what is left above, and how much of the area it is.
  float error = 0.05f;
  std::size_t max_vertices = 1000000;  ///< of the whole scene; what was not split by then stays
  /// Rays by which errors are measured, of all rounds: bounds the time, with the same mesh on any machine. What was not split
  /// by then stays.
  std::size_t max_rays = 2000000000;
  int order = 5;       ///< bands in which the difference is measured, 3 to 6
  int directions = 0;  ///< rays by which it is measured at a place, 256 to 65536; 0: by `error`
  int threads = 0;     ///< as BakeOptions
  float time_s = 0.0f;
};
struct TessellateReport {
  std::size_t vertices_before = 0, vertices_after = 0, triangles_before = 0, triangles_after = 0;
  int passes = 0;
  double error_before = 0.0, error_after = 0.0;  ///< the greatest
  /// Root mean square over the area of all rigid surfaces, the greatest of a triangle counted for all of it.
  double mean_error_before = 0.0, mean_error_after = 0.0;
  std::size_t above = 0;    ///< triangles whose error is still above the bound
  double above_area = 0.0;  ///< their share of the area
  /// Of these, the ones that are not worth splitting: an edge of light and shadow runs through them, so that their parts err as
  /// much as they do, or they are as small as they may get.
  std::size_t at_finest = 0;
  std::size_t rays = 0;
  bool out_of_rays = false;  ///< `max_rays` ended it
};
/// Splits triangles of rigid meshes where vertices are too sparse to hold shadow and once bounced light (PRT-3): at the
/// middle of the longest edge, which all triangles around it share, also those of other meshes and beyond seams of
/// texture coordinates, so that no crack opens. The shape stays what it was; all of a vertex is interpolated. Instances are
/// made unique first. Same mesh for any number of threads. Throws as bakeTransfer does.
Scene tessellateForTransfer(const Scene& scene, const TessellateOptions& options,
                            const Progress& progress = {}, TessellateReport* report = nullptr);

}  // namespace gloam
