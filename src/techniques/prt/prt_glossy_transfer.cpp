// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
#include "techniques/prt/prt_glossy_transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/brdf.h"
#include "scene/transforms.h"

namespace gloam::prt {

namespace {

void checkSizes(const frame::GpuMesh& mesh) {
  const GlossyTransfer& glossy = mesh.transfer->glossy;
  const std::string place = "mesh '" + mesh.name + "'";
  if (glossy.light_order < 1 || glossy.field_order > sh::kMaxOrder ||
      glossy.light_order > glossy.field_order) {
    throw Error(
        place,
        fmt::format("glossy transfer from {} to {} bands; 1 to {}, and no fewer than the light's, are known",
                    glossy.light_order, glossy.field_order, sh::kMaxOrder));
  }
  const std::size_t vertices = mesh.vertex_count;
  const std::size_t matrices = 3 * vertices * glossy.matrixCount();
  if (glossy.visibility.size() != vertices * glossy.visibilityCount() ||
      (!glossy.indirect.empty() && glossy.indirect.size() != matrices)) {
    throw Error(
        place,
        fmt::format("glossy transfer from {} to {} bands for {} vertices needs {} values, and {} for "
                    "bounces; it has {} and {}",
                    glossy.light_order, glossy.field_order, vertices, vertices * glossy.visibilityCount(),
                    matrices, glossy.visibility.size(), glossy.indirect.size()));
  }
}

std::size_t evenColumns(const sh::PackedMatrix& shape) {
  return (std::size_t(shape.columns()) + 1) / 2 * 2;
}

}  // namespace

GlossyBuffers::GlossyBuffers(gpu::Device& device, const frame::GpuScene& scene, const GlossyOptions& options)
    : options_(options) {
  findLit(scene);
  if (!lit_.empty()) fillChunks(device, scene);
}

// Meshes of different orders meet at the least.
void GlossyBuffers::findLit(const frame::GpuScene& scene) {
  const int most = options_.order > 0 ? options_.order : sh::kMaxOrder;
  shape_ = {most, most};
  first_outputs_.assign(scene.instances().size(), kUnbaked);
  for (std::uint32_t i = 0; i < scene.instances().size(); ++i) {
    const frame::GpuMesh& mesh = scene.meshes()[scene.instances()[i].mesh];
    if (!mesh.transfer || mesh.transfer->glossy.empty() || scene.deformed(i)) continue;
    checkSizes(mesh);
    const GlossyTransfer& glossy = mesh.transfer->glossy;
    shape_.light_order = std::min(shape_.light_order, glossy.light_order);
    shape_.field_order = std::min(shape_.field_order, glossy.field_order);
    has_indirect_ = has_indirect_ || !glossy.indirect.empty();
    lit_.push_back(i);
    exponents_.push_back(glossy.exponent);
    first_outputs_[i] = static_cast<std::uint32_t>(output_vertices_);
    output_vertices_ += mesh.vertex_count;
  }
  shape_.light_order = std::min(shape_.light_order, shape_.field_order);
}

void GlossyBuffers::packVertex(const GlossyTransfer& glossy, std::uint32_t vertex, std::uint32_t* direct,
                               std::uint32_t* indirect) const {
  const bool half = options_.half_float;
  const sh::Tripling& tripling = sh::Tripling::of(shape_.light_order, shape_.field_order);
  const std::size_t known = std::size_t(tripling.visibilityOrder()) * std::size_t(tripling.visibilityOrder());
  const float* visibility = &glossy.visibility[vertex * glossy.visibilityCount()];
  if (options_.cheap) {
    packWords({visibility, std::size_t(shape_.rows())}, half, direct);
  } else {
    float packed[sh::kMaxCoefficients * (sh::kMaxCoefficients + 1) / 2];
    tripling.expand({visibility, known}, packed);
    packWords({packed, std::size_t(shape_.size())}, half, direct);
  }
  if (!has_indirect_) return;
  const std::size_t rows = std::size_t(shape_.rows()), columns = std::size_t(shape_.columns());
  const std::size_t stored = std::size_t(glossy.light_order) * std::size_t(glossy.light_order);
  std::vector<float> matrix(rows * evenColumns(shape_) * 3, 0.0f);
  for (std::size_t i = 0; i < rows && !glossy.indirect.empty(); ++i) {
    std::copy_n(&glossy.indirect[(vertex * glossy.matrixCount() + i * stored) * 3], 3 * columns,
                &matrix[i * evenColumns(shape_) * 3]);
  }
  packWords(matrix, half, indirect);
}

std::size_t GlossyBuffers::fieldWords() const {
  return std::size_t(shape_.rows()) * (has_indirect_ ? 3 : 2);
}

std::size_t GlossyBuffers::lightRowSize() const {
  const std::size_t rows = std::size_t(shape_.rows());
  return std::size_t(shape_.columns()) + rows + (options_.cheap ? rows * rows : 0);
}

void GlossyBuffers::fillChunks(gpu::Device& device, const frame::GpuScene& scene) {
  const std::size_t field_bytes = output_vertices_ * fieldWords() * 4;
  if (field_bytes > device.limits().max_storage_bytes) {
    throw Error(
        "technique prt",
        fmt::format(
            "the radiance at {} glossy vertices takes {} MiB; a buffer of this device holds {} MiB: use "
            "a lower order, or glossy=unshadowed",
            output_vertices_, field_bytes >> 20, device.limits().max_storage_bytes >> 20));
  }
  const bool half = options_.half_float;
  const std::size_t direct = std::size_t(options_.cheap ? shape_.rows() : shape_.size());
  const std::size_t indirect = std::size_t(shape_.rows()) * evenColumns(shape_) * 3;
  Packer packer(device, "prt.glossy", wordCount(direct, half), has_indirect_ ? wordCount(indirect, half) : 0,
                options_.chunk_bytes, options_.on_host);
  for (std::size_t n = 0; n < lit_.size(); ++n) {
    const std::uint32_t mesh_index = scene.instances()[lit_[n]].mesh;
    const frame::GpuMesh& mesh = scene.meshes()[mesh_index];
    const auto fill = [&](std::uint32_t v, std::uint32_t* to_direct, std::uint32_t* to_indirect) {
      packVertex(mesh.transfer->glossy, v, to_direct, to_indirect);
    };
    for (const Packer::Part& part : packer.partsOf(mesh_index, mesh.vertex_count, fill)) {
      packer.addBlocks(part, static_cast<std::uint32_t>(n * lightRowSize()), first_outputs_[lit_[n]]);
    }
  }
  chunks_ = packer.finish();
}

std::vector<glm::vec3> GlossyBuffers::lightRows(const sh::ShRgb& light, const frame::GpuScene& scene) const {
  std::vector<glm::vec3> rows;
  for (std::size_t n = 0; n < lit_.size(); ++n) {
    const glm::mat3 world_from_object =
        rotationFactor(glm::mat3(scene.instances()[lit_[n]].world_from_object));
    const sh::ShRgb turned =
        sh::truncated(sh::rotate(glm::transpose(world_from_object), light), shape_.light_order);
    rows.insert(rows.end(), turned.coefficients().begin(), turned.coefficients().end());
    for (int i = 0; i < shape_.rows(); ++i) {
      const int band = int(std::sqrt(double(i) + 0.5));
      const float exponent = std::clamp(exponents_[n], 1.0f, kSharpestLobe[shape_.field_order]);
      rows.push_back(glm::vec3(exponents_[n] > 0.0f ? brdf::phongBandFactor(band, exponent) : 1.0f));
    }
    if (!options_.cheap) continue;
    const auto matrix = sh::Tripling::of(shape_.light_order, shape_.field_order)
                            .lightMatrix(turned.coefficients(), shape_.rows());
    rows.insert(rows.end(), matrix.begin(), matrix.end());
  }
  return rows;
}

std::vector<GlossRow> GlossyBuffers::instanceRows(const frame::GpuScene& scene) const {
  std::vector<GlossRow> rows(scene.instances().size(), {glm::mat3(1.0f), kUnbaked, 0.0f});
  for (std::size_t n = 0; n < lit_.size(); ++n) {
    const std::uint32_t i = lit_[n];
    rows[i] = {glm::transpose(rotationFactor(glm::mat3(scene.instances()[i].world_from_object))),
               first_outputs_[i], exponents_[n]};
  }
  return rows;
}

}  // namespace gloam::prt
