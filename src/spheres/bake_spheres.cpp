// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sphere sets of a scene, object by object (Wang et al. 2006, "Variational Sphere Set Approximation for Solid Objects": spheres
// that bound O with the least sum of V(S_i \ O)).
#include <fmt/core.h>
#include <gloam/spheres.h>

#include <algorithm>
#include <set>

#include "scene/threads.h"
#include "scene/transforms.h"
#include "spheres/objects.h"
#include "spheres/search.h"

namespace gloam {
namespace {

using spheres::Object;

void checkOptions(const SphereOptions& options) {
  const auto check = [](const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most)) {
      throw Error(std::string("spheres: ") + name, fmt::format("{}: expected {} to {}", value, least, most));
    }
  };
  check("count", options.count, 0, 4096);
  check("samples", options.samples, 500, 50000);
  check("effort", double(options.effort), double(0.01f), 100);
  check("threads", options.threads, 0, 1024);
}

Progress part(const Progress& whole, double from, double to, const std::string& what) {
  Progress inner;
  inner.should_stop = whole.should_stop;
  if (whole.update) {
    inner.update = [&whole, from, to, what](double fraction, const std::string&) {
      whole.update(from + (to - from) * fraction, what);
    };
  }
  return inner;
}

void fit(Object& object, const SphereOptions& options, const Scene& scene, const Progress& progress) {
  const spheres::Solid& solid = object.solid;
  const spheres::Motion motion = motionOf(object, scene);
  const std::vector<spheres::Ball> balls =
      findBalls(solid,
                {object.round() ? 1 : object.count, options.seed, options.samples, options.effort,
                 motion.moved.empty() ? nullptr : &motion},
                progress);
  const spheres::Measured measured = measureBalls(solid, balls, options.seed, progress);
  SphereSet& set = object.set;
  const double unit3 = double(solid.scale) * double(solid.scale) * double(solid.scale);
  set.figures = {measured.volume * unit3, measured.outside_sum * unit3, measured.outside_union * unit3,
                 measured.coverage};
  for (const spheres::Ball& ball : balls) {
    // Rounding on the way back must not uncover what sets the radius.
    set.spheres.push_back(
        {solid.origin + solid.scale * ball.center, solid.scale * ball.radius * (1.0f + 1e-6f)});
  }
  if (set.deforms) spheres::addAnchors(set, scene);
}

std::string spheresText(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "sphere" : "spheres");
}

/// Among others, an object that its few spheres misrepresent casts nothing.
void judge(SphereSet& set) {
  if (set.figures.relativeSum() <= spheres::kTooLoose) return;
  set.receive_only =
      fmt::format("thin: {} would hold {:.0f} times its volume of air; a larger count may serve",
                  spheresText(set.spheres.size()), set.figures.relativeSum());
  set.spheres.clear(), set.anchors.clear(), set.first_anchor.clear();
}

/// Instants at which an animation asks for another scale along one axis than along others; the first few.
std::vector<PosedScene> posesOfStretch(const Scene& scene) {
  constexpr std::size_t kMost = 16;
  std::set<float> times_s;
  for (const Animation& animation : scene.animations) {
    for (const AnimationChannel& channel : animation.channels) {
      if (channel.path != AnimationChannel::Path::kScale) continue;
      const bool cubic = channel.interpolation == AnimationChannel::Interpolation::kCubicSpline;
      for (std::size_t k = 0; k < channel.times_s.size(); ++k) {
        const float* scale = &channel.values[3 * (cubic ? 3 * k + 1 : k)];
        const auto [least, greatest] = std::minmax({scale[0], scale[1], scale[2]});
        if (greatest - least > 0.02f * std::abs(greatest)) times_s.insert(channel.times_s[k]);
      }
    }
  }
  std::vector<PosedScene> poses;
  for (const float time_s : times_s) {
    if (poses.size() < kMost) poses.push_back(pose(scene, time_s));
  }
  return poses;
}

/// Spheres that only follow a matrix stay round: told where it stretches them.
void remarkStretch(const SphereSet& set, const std::vector<PosedScene>& poses, Warnings& warnings) {
  float most = 1.0f;
  for (const PosedScene& posed : poses) {
    for (const Instance& instance : posed.instances) {
      if (std::ranges::find(set.nodes, instance.node) == set.nodes.end()) continue;
      const glm::vec3 scale = glm::abs(
          decomposeLinear(glm::mat3(instance.world_from_object) * glm::inverse(set.shape_from_object)).scale);
      const auto [least, greatest] = std::minmax({scale.x, scale.y, scale.z});
      most = std::max(most, greatest / std::max(least, 1e-3f * greatest));
    }
  }
  if (most < 1.05f || set.deforms || !set.receive_only.empty()) return;
  warnings.push_back(fmt::format(
      "{}: an animation stretches it {:.3g} times as far one way as another; its spheres stay round, "
      "as large as the greatest stretch",
      set.name, most));
}

void remark(const Object& object, Warnings& warnings) {
  const auto say = [&](const std::string& what) { warnings.push_back(object.set.name + ": " + what); };
  if (!object.casts()) {
    say(fmt::format("only receives ({})", object.set.receive_only));
    return;
  }
  if (object.solid.shell) {
    say("encloses nothing: taken as a sheet of some thickness");
  } else if (!object.solid.closed) {
    say("is not closed: its inside follows from winding numbers");
  } else if (object.solid.inverted) {
    say("faces inward: turned");
  }
  const std::size_t got = object.set.spheres.size();
  if (int(got) < object.count) {
    say(fmt::format("{} of {} serve, the search found no use for more", spheresText(got), object.count));
  }
}

}  // namespace

int SceneSpheres::count() const {
  std::size_t sum = 0;
  for (const SphereSet& set : sets) sum += set.spheres.size();
  return int(sum);
}

SceneSpheres bakeSpheres(const Scene& scene, const SphereOptions& options, const Progress& progress) {
  checkOptions(options);
  SceneSpheres result;
  withThreads(options.threads, [&] {
    const PosedScene posed = pose(scene, 0.0f);
    std::vector<Object> objects =
        spheres::listObjects(scene, posed, part(progress, 0.0, 0.1, "spheres: shapes"));
    if (objects.empty()) throw Error(scene.name, "holds no triangles: nothing to put spheres in");
    markReceivers(objects, posed);
    spreadCount(objects, options.count);
    const std::vector<PosedScene> stretched = posesOfStretch(scene);
    double work = 0.0, done = 0.0;
    for (const Object& object : objects) work += double(object.count);
    for (Object& object : objects) {
      if (object.casts()) {
        fit(object, options, scene,
            part(progress, 0.1 + 0.9 * done / work, 0.1 + 0.9 * (done + double(object.count)) / work,
                 "spheres: " + object.set.name));
        done += double(object.count);
        if (objects.size() > 1) judge(object.set);
      }
      remark(object, result.warnings);
      remarkStretch(object.set, stretched, result.warnings);
      result.sets.push_back(std::move(object.set));
    }
    progress.report(1.0, "spheres");
  });
  return result;
}

}  // namespace gloam
