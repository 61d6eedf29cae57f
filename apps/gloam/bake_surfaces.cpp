// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_surfaces.h"

#include <fmt/core.h>

#include "output.h"

namespace gloam::cli {
namespace {

std::string splitText(const TessellateReport& report) {
  return fmt::format(
      "tessellated: {} vertices added ({} to {}), {} triangles; error of transfer between vertices {:.1f} % "
      "before, {:.1f} % after at worst, {:.1f} % before, {:.1f} % after over the area",
      countText(report.vertices_after - report.vertices_before), countText(report.vertices_before),
      countText(report.vertices_after), countText(report.triangles_after), 100.0 * report.error_before,
      100.0 * report.error_after, 100.0 * report.mean_error_before, 100.0 * report.mean_error_after);
}

const char* whyItStopped(const TessellateReport& report) {
  if (report.out_of_rays) return "--tessellate-rays allows no more";
  if (report.at_finest < report.above) return "--tessellate-max allows no more";
  return "light ends there at an edge or a facet, where no triangle is small enough";
}

}  // namespace

void addSurfaceOptions(CLI::App& app, BakeOptions& options, SurfaceChoice& choice) {
  const auto grouped = [](CLI::Option* option) { return option->group("Surfaces"); };
  grouped(addInteger(app, "--texels", options.texels, {4, 4096}, "N",
                     "diffuse transfer of the texels of a lightmap, N by N a mesh; for meshes with texture "
                     "coordinates for one"));
  grouped(addNumber(app, "--texels-per-metre", options.texels_per_metre, {0.001, 1e6}, "N",
                    "the same by density: lightmaps as large as each mesh asks for, --texels at most"));
  choice.uv_set_option = grouped(addInteger(app, "--uv-set", options.uv_set, {0, 7}, "N",
                                            "texture coordinates of lightmaps: TEXCOORD_N"))
                             ->default_str(std::to_string(options.uv_set));
  grouped(
      addNumber(app, "--tessellate", choice.tessellate, {0.005, 1.0}, "ERROR",
                "split triangles until transfer between vertices errs by less than this part of open light; "
                "edges of light are split until it does not help, and what is left is told"));
  choice.max_option = grouped(addInteger(app, "--tessellate-max", choice.tessellate_max, {3, 100000000}, "N",
                                         "vertices of the scene at most"))
                          ->default_str(std::to_string(choice.tessellate_max));
  choice.mrays_option =
      grouped(addInteger(app, "--tessellate-rays", choice.tessellate_mrays, {1, 1000000}, "MILLIONS",
                         "rays by which errors are measured, in all: what bounds the time of splitting"))
          ->default_str(std::to_string(choice.tessellate_mrays));
}

void remarkUnusedSurfaceOptions(const BakeOptions& options, const SurfaceChoice& choice, Console& console) {
  if (options.texels == 0 && options.texels_per_metre == 0.0f && choice.uv_set_option->count() > 0)
    console.remark("--uv-set has no effect without --texels or --texels-per-metre");
  for (const CLI::Option* option : {choice.max_option, choice.mrays_option}) {
    if (choice.tessellate == 0.0f && option->count() > 0)
      console.remark(fmt::format("{} has no effect without --tessellate", option->get_name()));
  }
}

Scene tessellatedAsChosen(Scene scene, const BakeOptions& options, const SurfaceChoice& choice,
                          Console& console, TessellateReport& report) {
  if (choice.tessellate == 0.0f) return scene;
  TessellateOptions how;
  how.error = choice.tessellate;
  how.max_vertices = std::size_t(choice.tessellate_max);
  how.max_rays = std::size_t(choice.tessellate_mrays) * 1000000;
  how.order = options.order;
  how.threads = options.threads;
  how.time_s = options.time_s;
  Progress progress = console.progress();
  if (progress.update) {
    progress.update = [&console, update = progress.update](double fraction, const std::string& what) {
      console.release();
      update(fraction, what);
    };
  }
  Scene split = tessellateForTransfer(scene, how, progress, &report);
  console.endProgress();
  console.remark(splitText(report));
  split.environment = std::move(scene.environment);
  return split;
}

void remarkMissedBound(const SurfaceChoice& choice, const TessellateReport& report, Console& console) {
  if (choice.tessellate == 0.0f || report.above == 0) return;
  console.remark(fmt::format(
      "--tessellate {:g} is missed on {} of {} triangles, {:.2g} % of the area, by up to {:.1f} %: {}",
      choice.tessellate, countText(report.above), countText(report.triangles_after),
      100.0 * report.above_area, 100.0 * report.error_after, whyItStopped(report)));
}

Json tessellateJson(const SurfaceChoice& choice, const TessellateReport& report) {
  if (choice.tessellate == 0.0f) return nullptr;
  return {{"vertices_before", report.vertices_before},
          {"vertices_after", report.vertices_after},
          {"triangles_before", report.triangles_before},
          {"triangles_after", report.triangles_after},
          {"error_before", report.error_before},
          {"error_after", report.error_after},
          {"mean_error_before", report.mean_error_before},
          {"mean_error_after", report.mean_error_after},
          {"bound_holds", report.above == 0},
          {"triangles_above", report.above},
          {"area_above", report.above_area},
          {"triangles_at_finest", report.at_finest},
          {"rays", report.rays},
          {"out_of_rays", report.out_of_rays}};
}

}  // namespace gloam::cli
