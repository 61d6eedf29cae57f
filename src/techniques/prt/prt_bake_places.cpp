// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Points that cannot show what they see: vertices inside other geometry, or in nooks smaller than their mesh. Left alone
// they would be interpolated as black spots into what is visible.
#include <algorithm>
#include <tuple>

#include "math/sampling.h"
#include "techniques/prt/prt_bake_kernels.h"
#include "techniques/prt/prt_bake_passes.h"

namespace gloam::prt {
namespace {

// From where on a point is taken for one inside something. A wall that reaches through a floor made of one sheet sees the
// sheet's back over half its hemisphere; inside a closed box it is all of it. Backs of double-sided sheets are seen by any
// point behind a leaf, so there only being shut in counts.
constexpr float kBuriedBySheets = 1.0f / 3.0f;
constexpr float kBuriedByAll = 0.9f;
// A point is cramped where nearly all that it sees is nearer than half the spacing of its mesh: under the rounded edge of
// a box, say. Its darkness is real, but its mesh would spread it over whole cells. A mesh that is finer than this share of
// its own diagonal shows it where it is.
constexpr float kCramped = 0.6f;
constexpr float kCrampedReach = 0.5f;
constexpr float kShowsNooks = 1.0f / 256.0f;

// A face that lies upside down in its surface shares places with it, but no points: its own look into the body, and no
// neighbour of theirs is open. Its back is what is seen. Such points get the mean of the known ones at their place that
// look the other way. Returns those that found any.
std::vector<std::uint32_t> fillFromOtherSide(const BakePoints& points, std::vector<std::uint32_t> waiting,
                                             const std::vector<std::uint8_t>& known, const PointRows& rows) {
  const std::size_t row = rows.size;
  constexpr float kOpposedCos = 0.5f;
  const auto place = [&](std::uint32_t p) {
    const glm::vec3& at = points.positions[p];
    return std::tuple(at.x, at.y, at.z);
  };
  std::ranges::sort(waiting, {}, place);
  std::vector<double> sums(waiting.size() * row, 0.0);
  std::vector<int> found(waiting.size(), 0);
  for (std::uint32_t q = 0; q < points.size(); ++q) {
    if (!known[q]) continue;
    for (const std::uint32_t& p : std::ranges::equal_range(waiting, place(q), {}, place)) {
      if (glm::dot(points.normals[p], points.normals[q]) > -kOpposedCos) continue;
      const std::size_t w = std::size_t(&p - waiting.data());
      ++found[w];
      for (std::size_t i = 0; i < row; ++i) sums[w * row + i] += double(rows.of(q)[i]);
    }
  }
  std::vector<std::uint32_t> filled;
  for (std::size_t w = 0; w < waiting.size(); ++w) {
    if (found[w] == 0) continue;
    for (std::size_t i = 0; i < row; ++i) rows.of(waiting[w])[i] = float(sums[w * row + i] / found[w]);
    filled.push_back(waiting[w]);
  }
  return filled;
}

}  // namespace

// A sheet that lies closer above a surface than large triangles lift their rays must not be jumped over: half-way to it then.
glm::vec3 BakePasses::unobstructed(const glm::vec3& from, const glm::vec3& to) const {
  const float length = glm::length(to - from);
  if (!(length > 0.0f)) return to;
  // A wall that the surface touches is met at 0, or not, as rounding has it.
  const trace::Hit hit = tracer_.closest({from, (to - from) / length, 1.0e-3f * length, length});
  return hit ? glm::mix(from, to, 0.5f * hit.distance / length) : to;
}

glm::vec3 BakePasses::startAtVertex(std::size_t point) const {
  const glm::vec3 off_surface = points_.normals[point] * surfaceOffset(points_, point);
  return unobstructed(points_.positions[point] + off_surface, rayOrigin(points_, point));
}

glm::vec3 BakePasses::startOnFace(std::size_t point, std::uint32_t face, float share) const {
  const glm::vec3 off_surface = points_.normals[point] * surfaceOffset(points_, point);
  const glm::vec3 place = glm::mix(points_.positions[point], points_.centroid(face), share);
  return unobstructed(place + off_surface, rayOriginOnFace(points_, point, face, share));
}

// Asks a quarter of the directions first: few places are in doubt after that.
Place BakePasses::placeOf(const glm::vec3& origin, const glm::vec3& normal, float reach) const {
  float total = 0.0f, near = 0.0f, backs = 0.0f, sheet_backs = 0.0f;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    for (std::size_t i = quarter; i < probes_.size(); i += 4) {
      const float cosine = glm::dot(probes_[i], normal);
      if (cosine <= 0.0f) continue;
      total += cosine;
      const trace::Hit hit = tracer_.closest({origin, probes_[i]});
      if (!hit) continue;
      if (hit.distance < reach) near += cosine;
      if (!isBack(hit.instance, hit.triangle, glm::dot(probes_[i], hit.geometric_normal))) continue;
      backs += cosine;
      if (!surfaces_[std::size_t(hit.instance)].double_sided) sheet_backs += cosine;
    }
    if (quarter > 0) continue;
    if (sheet_backs == 0.0f && backs < 0.6f * total && near < 0.4f * total) return Place::kOpen;
    if (sheet_backs > 0.9f * total) return Place::kBuried;
  }
  if (sheet_backs > kBuriedBySheets * total || backs > kBuriedByAll * total) return Place::kBuried;
  return near > kCramped * total ? Place::kCramped : Place::kOpen;
}

// How near a point must see things to be in a nook that its mesh cannot show.
float BakePasses::nookReach(std::size_t point) const {
  const float spacing = meshSpacing(points_, point);
  const std::uint32_t triangle =
      points_.onFace(point) ? points_.facePoint(point).triangle : points_.facesOf(point).front();
  const auto next = std::ranges::upper_bound(points_.first_triangle, triangle);
  const float diagonal = diagonals_[std::size_t(next - points_.first_triangle.begin()) - 1];
  return spacing > kShowsNooks * diagonal ? kCrampedReach * spacing : 0.0f;
}

// Looks for an open place on the faces around a point that is not, the nearest first; where even the far ends of the faces
// are hidden nothing nearer is tried. Returns whether the site was moved.
bool BakePasses::findBetterPlace(std::size_t point, RaySite& site) const {
  const glm::vec3& normal = points_.normals[point];
  const float reach = nookReach(point);
  site.place = placeOf(site.origin, normal, reach);
  if (site.place == Place::kOpen || points_.onFace(point)) return false;
  auto faces = points_.facesOf(point);
  faces = faces.first(std::min<std::size_t>(faces.size(), 8));
  const auto findAt = [&](float share) {
    for (const std::uint32_t face : faces) {
      const glm::vec3 origin = startOnFace(point, face, share);
      if (placeOf(origin, normal, reach) != Place::kOpen) continue;
      site = {.origin = origin, .place = Place::kOpen};
      return true;
    }
    return false;
  };
  constexpr float kFarthest = 0.8f;
  const RaySite hidden = site;
  if (!findAt(kFarthest)) return false;
  const RaySite far = site;
  site = hidden;
  for (const float share : {0.05f, 0.2f, 0.5f}) {
    if (findAt(share)) return true;
  }
  site = far;
  return true;
}

// A point that is inside something, or in a nook too small for its mesh, gets another place to look from.
std::size_t BakePasses::digOut(std::size_t point, RaySite& site, std::size_t first, std::uint16_t* blocked,
                               float* sums) const {
  // Such points have much of the hemisphere blocked; the others are spared the question.
  if (site.blocked_cosine <= kBuriedBySheets * sampling::kPi || !findBetterPlace(point, site)) return 0;
  const DirectionBatch& batch = tables_.batches[0];
  const glm::mat3 turn = turnOf(point);
  const std::size_t rays = traceBlocked(tracer_, tables_, batch, site.origin, points_.normals[point] * turn,
                                        turn, blocked + (point - first) * std::size_t(tables_.tiles));
  projectPoints(batch, {&point, 1}, first, blocked, sums);
  return rays;
}

// Mean of the neighbours whose value was known before this ring; false where there are none.
bool BakePasses::fillFromNeighbours(std::uint32_t point, const std::vector<std::uint8_t>& known,
                                    const PointRows& rows) const {
  std::vector<double> sum(rows.size, 0.0);
  int neighbours = 0;
  const auto add = [&](std::uint32_t q) {
    if (!known[q] || q == point) return;
    ++neighbours;
    for (std::size_t i = 0; i < rows.size; ++i) sum[i] += double(rows.of(q)[i]);
  };
  if (points_.onFace(point)) {
    forTexelsAround(points_, point, add);
  } else {
    for (const std::uint32_t face : points_.facesOf(point)) {
      for (int k = 0; k < 3; ++k) add(points_.triangles[face][k]);
    }
  }
  for (std::size_t i = 0; i < rows.size && neighbours > 0; ++i)
    rows.of(point)[i] = float(sum[i] / neighbours);
  return neighbours > 0;
}

// Ring by ring from the open. After the first ring what is cramped keeps its own: it lies in a gap that its mesh shows.
// Meshes that are buried as a whole keep what they have, unless they lie upside down in the surface of another.
void BakePasses::fillHidden(const BakeState& state, const PointRows& rows) const {
  std::vector<std::uint8_t> known(state.points);
  std::vector<std::uint32_t> waiting, filled;
  for (std::size_t p = 0; p < state.points; ++p) {
    if (!rows.has(p)) continue;
    known[p] = state.sites[p].place == Place::kOpen;
    if (!known[p]) waiting.push_back(std::uint32_t(p));
  }
  for (bool first_ring = true; !waiting.empty(); first_ring = false) {
    std::vector<std::uint32_t> later;
    filled.clear();
    for (const std::uint32_t p : waiting) {
      const bool done = fillFromNeighbours(p, known, rows);
      const bool stays = first_ring && state.sites[p].place == Place::kCramped;
      (done || stays ? filled : later).push_back(p);
    }
    waiting.swap(later);
    if (filled.empty()) {
      filled = fillFromOtherSide(points_, waiting, known, rows);
      if (filled.empty()) return;
    }
    for (const std::uint32_t p : filled) known[p] = 1;
    std::erase_if(waiting, [&](std::uint32_t p) { return known[p] != 0; });
  }
}

}  // namespace gloam::prt
