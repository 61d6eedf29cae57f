// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "bake_choice.h"

#include <fmt/core.h>
#include <image/atomic_file.h>
#include <techniques/prt/prt_bake_edges.h>
#include <techniques/prt/prt_glossy_state.h>

#include <algorithm>

#include "output.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;

void checkOutput(const BakeChoice& choice) {
  if (fs::path(choice.output).extension() != ".glb") {
    throw Error(choice.output, "expected a name that ends in .glb");
  }
  refuseOverwriting(choice.output, choice.scene.name);
  AtomicFile probe(choice.output);
}

void checkGloss(const BakeOptions& options) {
  if (options.glossy == GlossyMeshes::kNone || options.glossy_light_order == 0) return;
  const int bands = options.glossy_order > 0 ? options.glossy_order : options.order;
  if (options.glossy_light_order > bands)
    throw Error(
        "--glossy-light-order",
        fmt::format("{} bands of light are more than the {} of {}: matrices take as many bands as they "
                    "give, or fewer",
                    options.glossy_light_order, bands,
                    options.glossy_order > 0 ? "--glossy-order" : "--order"));
  if (options.glossy_light_order > options.order)
    throw Error("--glossy-light-order", fmt::format("{} bands of light are more than the {} of --order",
                                                    options.glossy_light_order, options.order));
}

void checkError(const BakeOptions& options) {
  if (options.error > 0.0f && options.kind != TransferKind::kUnshadowed &&
      options.directions < prt::kLeastDirectionsOfError)
    throw Error("--error",
                fmt::format("with --directions {}: errors are told by two steps or more of directions; "
                            "expected --directions {} or more",
                            options.directions, prt::kLeastDirectionsOfError));
}

bool isGiven(const CLI::Option* option) {
  return option->count() > 0;
}

}  // namespace

void checkBakeChoice(const BakeChoice& choice) {
  const BakeOptions& options = choice.options;
  checkGloss(options);
  checkError(options);
  if (choice.surfaces.tessellate > 0.0f && options.kind == TransferKind::kUnshadowed)
    throw Error("--tessellate", "--kind du has no shadows to split triangles for");
  if (!choice.estimate_only) checkOutput(choice);
}

std::optional<Error> manifoldFault(const BakeChoice& choice, const Scene& scene) {
  if (choice.non_manifold) return std::nullopt;
  const std::string text = prt::crowdedEdgesText(scene, pose(scene, choice.options.time_s));
  if (text.empty()) return std::nullopt;
  return Error(choice.scene.name,
               text + "; expected two at most, as surfaces have; --non-manifold bakes it as it stands");
}

void remarkUnusedOptions(const BakeChoice& choice, const Scene& scene, Console& console) {
  const BakeOptions& options = choice.options;
  const bool grids = !choice.neighbourhood.objects.empty();
  const auto remark = [&](const CLI::Option* option, const std::string& why) {
    if (isGiven(option)) console.remark(fmt::format("{} has no effect {}", option->get_name(), why));
  };
  const std::string of_kind = "on --kind " + choice.kind;
  if (options.kind != TransferKind::kInterreflected) remark(choice.bounces_option, of_kind);
  const bool thrown =
      grids && options.kind == TransferKind::kShadowed;  // light that grids throw takes them, too
  if (options.kind != TransferKind::kInterreflected && !thrown)
    remark(choice.bounce_directions_option, of_kind);
  if (options.kind == TransferKind::kUnshadowed && !grids) remark(choice.directions_option, of_kind);
  if (options.kind == TransferKind::kInterreflected) {
    if (options.error > 0.0f && !grids) {
      remark(choice.bounce_directions_option, "with --error: each vertex takes as many as it needs");
    } else if (options.bounce_directions > options.directions && isGiven(choice.bounce_directions_option)) {
      console.remark(
          fmt::format("--bounce-directions are of the same set: {} of them, not more than --directions",
                      options.directions));
    }
  }
  const PosedScene posed = pose(scene, options.time_s);
  const auto glossy = prt::glossyInstances(scene, posed, options.glossy);
  for (const CLI::Option* option : choice.of_gloss) {
    if (options.glossy == GlossyMeshes::kNone) {
      remark(option, "with --glossy off");
    } else if (std::ranges::find(glossy, 1) == glossy.end()) {
      remark(option, "here: no mesh mirrors 10 % of light or more; --glossy on gives all of them matrices");
    }
  }
  if (isGiven(choice.non_manifold_option) && prt::crowdedEdgesText(scene, posed).empty())
    remark(choice.non_manifold_option, "here: no edge has more than two triangles");
  if (scene.animations.empty()) remark(choice.time_option, "here: the scene has no animation");
}

}  // namespace gloam::cli
