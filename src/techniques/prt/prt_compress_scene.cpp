// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Compresses the meshes of a scene and says what that costs in truth.
#include <fmt/core.h>
#include <gloam/compress.h>
#include <gloam/lights.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "scene/half_float.h"
#include "techniques/prt/prt_compress.h"

namespace gloam {
namespace {

// A cluster's mean and vectors are to take less room than the weights of its points.
constexpr std::size_t kPointsANumber = 2;
// The direct numbers light all three colours.
const float kDirectScale = std::sqrt(3.0f);

constexpr std::array<const char*, 6> kTestLights = {
    "sky:mild",
    "sky:noon",
    "sky:sunset?azimuth=30",
    "sky:studio?rotation=120",
    "disc?azimuth=200&elevation=20&radius=10",
    "disc?azimuth=80&elevation=70&radius=3&green=0.6&blue=0.3"};

void checkOptions(const CompressOptions& options) {
  const auto check = [](const char* name, int value, int low, int high) {
    if (value < low || value > high)
      throw Error(fmt::format("compression {}", name),
                  fmt::format("{} is not from {} to {}", value, low, high));
  };
  check("clusters", options.clusters, 1, 4096);
  check("vectors", options.vectors, 1, 144);
  check("iterations", options.iterations, 1, 1000);
}

/// Meshes whose points have as many numbers: they share their clusters.
struct Group {
  std::size_t width = 0, direct = 0;
  std::vector<Mesh*> meshes;
};

std::vector<Group> groupsOf(Scene& scene) {
  std::vector<Group> groups;
  for (Mesh& mesh : scene.meshes) {
    if (!mesh.transfer) continue;
    const std::size_t width = numbersOfPoint(*mesh.transfer),
                      direct = std::size_t(mesh.transfer->order * mesh.transfer->order);
    auto found =
        std::ranges::find_if(groups, [&](const Group& g) { return g.width == width && g.direct == direct; });
    if (found == groups.end()) found = groups.insert(found, Group{width, direct, {}});
    found->meshes.push_back(&mesh);
  }
  return groups;
}

std::vector<float> gathered(const Group& group) {
  const std::size_t direct = group.direct, indirect = group.width - direct;
  std::size_t all = 0;
  for (const Mesh* mesh : group.meshes) all += mesh->transfer->direct.size() / direct;
  std::vector<float> values(all * group.width);
  float* row = values.data();
  for (const Mesh* mesh : group.meshes) {
    const Transfer& transfer = *mesh->transfer;
    for (std::size_t p = 0; p < transfer.direct.size() / direct; ++p, row += group.width) {
      for (std::size_t i = 0; i < direct; ++i) row[i] = kDirectScale * transfer.direct[p * direct + i];
      if (indirect > 0) std::copy_n(&transfer.indirect[p * indirect], indirect, row + direct);
    }
  }
  return values;
}

void roundToHalves(std::vector<float>& values) {
  for (float& value : values) value = floatFromHalf(halfFromFloat(value));
}

prt::ClusteredPca compressed(const Group& group, const CompressOptions& options, const Progress& progress) {
  const std::vector<float> values = gathered(group);
  const std::size_t width = group.width, points = values.size() / width;
  const auto clusters =
      int(std::clamp<std::size_t>(points / (kPointsANumber * width), 1, std::size_t(options.clusters)));
  const auto vectors = int(std::min<std::size_t>(std::size_t(options.vectors), width));
  prt::ClusteredPca pca = prt::clusteredPca(values, width, clusters, vectors, options.iterations, progress);
  const auto unscale = [&](std::vector<float>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (i % width < group.direct) rows[i] /= kDirectScale;
  };
  unscale(pca.means);
  unscale(pca.basis);
  if (options.half_float) {
    roundToHalves(pca.means);
    roundToHalves(pca.basis);
    roundToHalves(pca.weights);
  }
  return pca;
}

/// Hands each mesh its points of the whole.
void deal(prt::ClusteredPca pca, Group& group) {
  auto of = std::make_shared<TransferClusters>();
  of->clusters = int(pca.means.size() / group.width);
  of->vectors = int(pca.basis.size() / pca.means.size());
  of->means = std::move(pca.means);
  of->basis = std::move(pca.basis);
  const auto vectors = std::ptrdiff_t(of->vectors);
  auto weight = pca.weights.cbegin();
  auto cluster = pca.cluster.cbegin();
  for (Mesh* mesh : group.meshes) {
    const auto points = std::ptrdiff_t(mesh->transfer->direct.size() / group.direct);
    auto small = std::make_shared<CompressedTransfer>();
    small->of = of;
    small->weights.assign(weight, weight + points * vectors);
    small->cluster.assign(cluster, cluster + points);
    weight += points * vectors;
    cluster += points;
    auto transfer = std::make_shared<Transfer>(*mesh->transfer);
    expandTransfer(*small, *transfer);
    transfer->compressed = std::move(small);
    mesh->transfer = std::move(transfer);
  }
}

struct Sums {
  double error = 0.0, size = 0.0;
  void add(double was, double is) {
    error += (is - was) * (is - was);
    size += was * was;
  }
  double relative() const { return size > 0.0 ? std::sqrt(error / size) : 0.0; }
};

/// Of every vertex, in each colour, under each light.
void addIrradiance(const Transfer& before, const Transfer& after, const sh::ShRgb& light, Sums& sums) {
  const auto n = std::size_t(before.order * before.order);
  for (std::size_t p = 0; p < before.direct.size() / n; ++p) {
    glm::dvec3 was(0.0), is(0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const glm::dvec3 l(light[int(i)]);
      was += l * double(before.direct[p * n + i]);
      is += l * double(after.direct[p * n + i]);
      if (before.indirect.empty()) continue;
      for (int c = 0; c < 3; ++c) {
        was[c] += l[c] * double(before.indirect[3 * (p * n + i) + std::size_t(c)]);
        is[c] += l[c] * double(after.indirect[3 * (p * n + i) + std::size_t(c)]);
      }
    }
    for (int c = 0; c < 3; ++c) sums.add(was[c], is[c]);
  }
}

void addNumbers(const std::vector<float>& before, const std::vector<float>& after, double weight,
                Sums& sums) {
  Sums mine;
  for (std::size_t i = 0; i < before.size(); ++i) mine.add(double(before[i]), double(after[i]));
  sums.error += weight * mine.error;
  sums.size += weight * mine.size;
}

CompressReport reportOn(const Scene& before, const Scene& after, bool half_float) {
  CompressReport report;
  Sums numbers;
  std::array<Sums, kTestLights.size()> lit;
  std::vector<std::string> texts(kTestLights.begin(), kTestLights.end());
  std::set<const TransferClusters*> counted;
  for (std::size_t m = 0; m < before.meshes.size(); ++m) {
    const Transfer* was = before.meshes[m].transfer.get();
    const Transfer* is = after.meshes[m].transfer.get();
    if (was == nullptr) continue;
    report.points += is->compressed->cluster.size();
    report.bytes_before += (was->direct.size() + was->indirect.size()) * (half_float ? 2 : 4);
    const CompressedTransfer& compressed = *is->compressed;
    report.bytes += compressed.bytes(half_float);
    if (counted.insert(compressed.of.get()).second) report.bytes += compressed.of->bytes(half_float);
    addNumbers(was->direct, is->direct, 3.0, numbers);
    addNumbers(was->indirect, is->indirect, 1.0, numbers);
    tbb::parallel_for(std::size_t(0), kTestLights.size(), [&](std::size_t i) {
      const AnimatedLights lights = AnimatedLights::parse(std::span(texts).subspan(i, 1));
      addIrradiance(*was, *is, projectLights(lights.at(0.0f), was->order), lit[i]);
    });
  }
  report.transfer_error = numbers.relative();
  for (std::size_t i = 0; i < lit.size(); ++i) {
    report.light_error += lit[i].relative() / double(lit.size());
    if (lit[i].relative() < report.worst_light_error) continue;
    report.worst_light_error = lit[i].relative();
    report.worst_light = texts[i];
  }
  return report;
}

}  // namespace

std::span<const char* const> compressionTestLights() {
  return kTestLights;
}

Scene compressTransfer(const Scene& scene, const CompressOptions& options, const Progress& progress,
                       CompressReport* report) {
  checkOptions(options);
  Scene result = scene;
  std::vector<Group> groups = groupsOf(result);
  if (groups.empty()) throw Error("compression", "no mesh of this scene carries transfer");
  for (Group& group : groups) deal(compressed(group, options, progress), group);
  if (report != nullptr) *report = reportOn(scene, result, options.half_float);
  return result;
}

}  // namespace gloam
