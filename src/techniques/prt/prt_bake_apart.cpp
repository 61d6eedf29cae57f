// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Sloan, Kautz, Snyder 2002: transfer belongs to an object, which then moves rigidly through light that is sampled near it
// every frame. Here several objects of one scene are baked, each blocked by itself alone.
#include "techniques/prt/prt_bake_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam::prt {
namespace {

std::vector<int> objectRoots(const Scene& scene) {
  std::vector<int> roots = scene.roots;
  while (roots.size() == 1) {
    const Node& root = scene.nodes[std::size_t(roots[0])];
    if (!root.meshes.empty() || root.children.empty()) break;
    roots = root.children;
  }
  return roots;
}

/// The same nodes, of which only those of one object hold meshes; vertices of the others are left out.
Scene partOf(const Scene& scene, const std::vector<int>& object_of_node, int object) {
  Scene part;
  part.name = scene.name;
  part.textures = scene.textures;
  part.materials = scene.materials;
  part.nodes = scene.nodes;
  part.roots = scene.roots;
  part.skins = scene.skins;
  part.animations = scene.animations;
  part.meshes.resize(scene.meshes.size());
  for (std::size_t n = 0; n < part.nodes.size(); ++n) {
    if (object_of_node[n] != object) part.nodes[n].meshes.clear();
    for (const int mesh : part.nodes[n].meshes)
      part.meshes[std::size_t(mesh)] = scene.meshes[std::size_t(mesh)];
  }
  part.cameras = scene.cameras;
  part.lights = scene.lights;
  return part;
}

/// Baked meshes stand in the order of their places, under the same nodes.
void takeTransfer(const Scene& baked, int object, Scene& scene) {
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const std::vector<int>& from = baked.nodes[n].meshes;
    for (std::size_t k = 0; k < from.size(); ++k) {
      const auto& transfer = baked.meshes[std::size_t(from[k])].transfer;
      if (!transfer) continue;
      std::const_pointer_cast<Transfer>(transfer)->object =
          object;  // ours alone: the bake made it for this scene
      scene.meshes[std::size_t(scene.nodes[n].meshes[k])].transfer = transfer;
    }
  }
}

void addReport(const BakeReport& one, BakeReport& sum) {
  const double weight = double(one.glossy_points);
  if (sum.glossy_points + one.glossy_points > 0)
    sum.cheap_error = std::sqrt((sum.cheap_error * sum.cheap_error * double(sum.glossy_points) +
                                 one.cheap_error * one.cheap_error * weight) /
                                double(sum.glossy_points + one.glossy_points));
  const double before = double(sum.vertices), here = double(one.vertices), all = std::max(1.0, before + here);
  sum.mean_directions = (sum.mean_directions * before + one.mean_directions * here) / all;
  sum.error = std::sqrt((sum.error * sum.error * before + one.error * one.error * here) / all);
  sum.most_directions = std::max(sum.most_directions, one.most_directions);
  sum.rays_saved += one.rays_saved;
  sum.above_error += one.above_error;
  sum.bounce_s.resize(std::max(sum.bounce_s.size(), one.bounce_s.size()));
  for (std::size_t b = 0; b < one.bounce_s.size(); ++b) sum.bounce_s[b] += one.bounce_s[b];
  sum.vertices += one.vertices;
  sum.rays += one.rays;
  sum.bounce_rays += one.bounce_rays;
  sum.first_pass_s += one.first_pass_s;
  sum.bounces_s += one.bounces_s;
  sum.resumed = sum.resumed || one.resumed;
  sum.glossy_points += one.glossy_points;
  sum.texels += one.texels;
  sum.warnings.insert(sum.warnings.end(), one.warnings.begin(), one.warnings.end());
}

/// Objects are baked one after the other: where the file of one is missing, so are those of all after it.
std::filesystem::path checkpointOf(const std::filesystem::path& checkpoint, int object) {
  if (checkpoint.empty()) return {};
  return checkpoint.string() + (object == 0 ? "" : fmt::format(".{}", object));
}

}  // namespace

std::vector<int> objectsOfNodes(const Scene& scene, const PosedScene& posed) {
  std::vector<int> root_of_node(scene.nodes.size(), kNone);
  const std::vector<int> roots = objectRoots(scene);
  for (std::size_t r = 0; r < roots.size(); ++r) {
    std::vector<int> open = {roots[r]};
    while (!open.empty()) {
      const std::size_t node = std::size_t(open.back());
      open.pop_back();
      if (root_of_node[node] != kNone) continue;
      root_of_node[node] = int(r);
      open.insert(open.end(), scene.nodes[node].children.begin(), scene.nodes[node].children.end());
    }
  }
  std::vector<int> number_of_root(roots.size(), kNone);
  for (const Instance& instance : posed.instances) {
    const int root = root_of_node[std::size_t(instance.node)];
    if (root != kNone && !instance.deformed() && !scene.meshes[std::size_t(instance.mesh)].indices.empty())
      number_of_root[std::size_t(root)] = 0;
  }
  int count = 0;
  for (int& number : number_of_root) {
    if (number != kNone) number = count++;
  }
  std::vector<int> object(scene.nodes.size(), kNone);
  for (std::size_t n = 0; n < object.size(); ++n) {
    if (root_of_node[n] != kNone) object[n] = number_of_root[std::size_t(root_of_node[n])];
  }
  return object;
}

Scene bakeApart(Scene scene, const BakeOptions& options, const Progress& progress, BakeReport& report,
                const BakeOne& bake) {
  const PosedScene posed = pose(scene, options.time_s);
  const std::vector<int> object_of_node = objectsOfNodes(scene, posed);
  const int objects = 1 + *std::max_element(object_of_node.begin(), object_of_node.end());
  std::vector<double> vertices(std::size_t(objects), 0.0);
  for (const Instance& instance : posed.instances) {
    const int object = object_of_node[std::size_t(instance.node)];
    if (object != kNone)
      vertices[std::size_t(object)] += double(scene.meshes[std::size_t(instance.mesh)].vertexCount());
  }
  double all = 0.0, done = 0.0;
  for (const double v : vertices) all += v;
  for (int object = 0; object < objects; ++object) {
    const double from = done / all, share = vertices[std::size_t(object)] / all;
    Progress part{{}, progress.should_stop};
    if (progress.update) {
      part.update = [&, from, share](double fraction, const std::string& what) {
        progress.update(from + share * fraction,
                        fmt::format("object {} of {}: {}", object + 1, objects, what));
      };
    }
    BakeOptions one = options;
    one.checkpoint = checkpointOf(options.checkpoint, object);
    BakeReport of_one;
    takeTransfer(bake(partOf(scene, object_of_node, object), one, part, of_one), object, scene);
    addReport(of_one, report);
    done += vertices[std::size_t(object)];
  }
  if (!options.checkpoint.empty() && !options.keep_checkpoint) removeBakeCheckpoint(options.checkpoint);
  return scene;
}

}  // namespace gloam::prt

namespace gloam {

void removeBakeCheckpoint(const std::filesystem::path& checkpoint) {
  std::error_code ignored;
  if (checkpoint.empty()) return;
  std::filesystem::remove(checkpoint, ignored);
  for (int object = 1; std::filesystem::remove(prt::checkpointOf(checkpoint, object), ignored);) ++object;
}

}  // namespace gloam
