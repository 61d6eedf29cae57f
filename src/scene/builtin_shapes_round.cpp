// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Spheres, bowls, and shapes that turn about an axis or follow a curve.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "scene/builtin_shapes.h"

namespace gloam::shapes {
namespace {

constexpr float kPi = 3.14159265f;

// A point on the unit sphere by longitude (0 at +Z, growing towards +X) and height.
glm::vec3 onSphere(float longitude_rad, float y) {
  const float r = std::sqrt(std::max(0.0f, 1.0f - y * y));
  return {r * std::sin(longitude_rad), y, r * std::cos(longitude_rad)};
}

// Icosahedron with vertices at the poles: rings at heights +-1/sqrt 5.
std::array<glm::vec3, 12> icosahedron() {
  std::array<glm::vec3, 12> v;
  v[0] = {0, 1, 0};
  v[11] = {0, -1, 0};
  const float height = 1.0f / std::sqrt(5.0f);
  for (int i = 0; i < 5; ++i) {
    v[std::size_t(1 + i)] = onSphere(2 * kPi * float(i) / 5, height);
    v[std::size_t(6 + i)] = onSphere(2 * kPi * (float(i) + 0.5f) / 5, -height);
  }
  return v;
}

std::vector<std::array<int, 3>> icosahedronFaces() {
  std::vector<std::array<int, 3>> faces;
  for (int i = 0; i < 5; ++i) {
    const int next = (i + 1) % 5;
    faces.push_back({0, 1 + i, 1 + next});
    faces.push_back({1 + i, 6 + i, 1 + next});
    faces.push_back({1 + next, 6 + i, 6 + next});
    faces.push_back({11, 6 + next, 6 + i});
  }
  return faces;
}

// Welds equal points so that the geodesic sphere is one connected mesh.
class PointSet {
 public:
  std::uint32_t add(std::vector<glm::vec3>& points, const glm::vec3& p) {
    const std::array<int, 3> key = {int(std::lround(p.x * 1e5f)), int(std::lround(p.y * 1e5f)),
                                    int(std::lround(p.z * 1e5f))};
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = known_.find({key[0] + dx, key[1] + dy, key[2] + dz});
          if (found != known_.end()) return found->second;
        }
      }
    }
    points.push_back(p);
    return known_[key] = std::uint32_t(points.size()) - 1;
  }

 private:
  std::map<std::array<int, 3>, std::uint32_t> known_;
};

// Longitude-latitude UVs break at the seam: triangles that cross it get copies of their vertices with u + 1, and each
// triangle at a pole a pole vertex of its own.
void addSphericalUvs(Mesh& mesh) {
  mesh.uv_sets.assign(1, {});
  std::vector<glm::vec2>& uvs = mesh.uv_sets[0];
  for (const glm::vec3& n : mesh.normals) {
    float u = std::atan2(n.x, n.z) / (2 * kPi);
    if (u < -1e-6f) u += 1.0f;
    uvs.emplace_back(std::max(0.0f, u), std::acos(std::clamp(n.y, -1.0f, 1.0f)) / kPi);
  }
  std::map<std::uint32_t, std::uint32_t> wrapped;
  const auto copyOf = [&](std::uint32_t i, float u) {
    mesh.positions.push_back(glm::vec3(mesh.positions[i]));
    mesh.normals.push_back(glm::vec3(mesh.normals[i]));
    uvs.emplace_back(u, uvs[i].y);
    return std::uint32_t(mesh.positions.size()) - 1;
  };
  const auto isPole = [&](std::uint32_t i) { return std::abs(mesh.normals[i].y) > 0.999999f; };
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    std::uint32_t* corner = &mesh.indices[t];
    float greatest = 0.0f;
    for (int k = 0; k < 3; ++k) {
      if (!isPole(corner[k])) greatest = std::max(greatest, uvs[corner[k]].x);
    }
    for (int k = 0; k < 3; ++k) {
      if (isPole(corner[k]) || greatest - uvs[corner[k]].x < 0.5f) continue;
      const auto found = wrapped.find(corner[k]);
      corner[k] = found != wrapped.end() ? found->second
                                         : (wrapped[corner[k]] = copyOf(corner[k], uvs[corner[k]].x + 1.0f));
    }
    for (int k = 0; k < 3; ++k) {
      if (isPole(corner[k])) {
        corner[k] = copyOf(corner[k], 0.5f * (uvs[corner[(k + 1) % 3]].x + uvs[corner[(k + 2) % 3]].x));
      }
    }
  }
  // Pole vertices that no triangle uses any more would be counted and baked for nothing.
  std::vector<std::uint32_t> place(mesh.positions.size(), ~0u);
  Mesh used;
  used.uv_sets.resize(1);
  for (std::uint32_t& i : mesh.indices) {
    if (place[i] == ~0u) {
      place[i] = std::uint32_t(used.positions.size());
      used.positions.push_back(mesh.positions[i]);
      used.normals.push_back(mesh.normals[i]);
      used.uv_sets[0].push_back(uvs[i]);
    }
    i = place[i];
  }
  used.indices = std::move(mesh.indices);
  mesh = std::move(used);
}

}  // namespace

Mesh icosphere(float radius, int frequency) {
  Mesh mesh;
  PointSet points;
  const std::array<glm::vec3, 12> corners = icosahedron();
  for (const std::array<int, 3>& face : icosahedronFaces()) {
    const glm::vec3 a = corners[std::size_t(face[0])], b = corners[std::size_t(face[1])],
                    c = corners[std::size_t(face[2])];
    const auto vertex = [&](int i, int j) {
      const float n = float(frequency);
      const glm::vec3 p = a * ((n - float(i)) / n) + b * (float(i - j) / n) + c * (float(j) / n);
      return points.add(mesh.normals, glm::normalize(p));
    };
    for (int i = 0; i < frequency; ++i) {
      for (int j = 0; j <= i; ++j) {
        mesh.indices.insert(mesh.indices.end(), {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
        if (j < i)
          mesh.indices.insert(mesh.indices.end(), {vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
    }
  }
  for (const glm::vec3& n : mesh.normals) mesh.positions.push_back(radius * n);
  addSphericalUvs(mesh);
  makeTangents(mesh);
  return mesh;
}

Mesh uvSphere(float radius, int segments, int rings) {
  return surface(segments, rings, [&](float u, float v) {
    const glm::vec3 n = onSphere(2 * kPi * u, std::cos(kPi * v));
    return SurfacePoint{radius * n, n, onSphere(2 * kPi * u + 0.5f * kPi, 0.0f)};
  });
}

Mesh revolve(const std::vector<std::vector<ProfilePoint>>& profiles, int segments) {
  Mesh mesh;
  mesh.uv_sets.resize(1);
  for (const std::vector<ProfilePoint>& run : profiles) {
    const int last = int(run.size()) - 1;
    append(mesh, surface(segments, last, [&](float u, float v) {
             const int i = std::clamp(int(std::lround(v * float(last))), 0, last);
             const ProfilePoint &before = run[std::size_t(std::max(i - 1, 0))], &here = run[std::size_t(i)],
                                &after = run[std::size_t(std::min(i + 1, last))];
             glm::vec2 along(after.radius - before.radius, after.height - before.height);
             // On the axis the profile continues mirrored: the surface is level there.
             if (here.radius < 1e-7f) along = {along.x < 0.0f ? -1.0f : 1.0f, 0.0f};
             const glm::vec2 out(-along.y, along.x);  // a run that descends faces away from the axis
             const float longitude = 2 * kPi * u;
             const glm::vec3 radial = onSphere(longitude, 0.0f);
             return SurfacePoint{radial * here.radius + glm::vec3(0, here.height, 0),
                                 radial * out.x + glm::vec3(0, out.y, 0),
                                 onSphere(longitude + 0.5f * kPi, 0.0f)};
           }));
  }
  return mesh;
}

std::vector<ProfilePoint> line(ProfilePoint a, ProfilePoint b, int n) {
  std::vector<ProfilePoint> run;
  for (int i = 0; i <= n; ++i) {
    const float t = float(i) / float(n);
    run.push_back({a.radius + t * (b.radius - a.radius), a.height + t * (b.height - a.height)});
  }
  return run;
}

std::vector<ProfilePoint> arc(ProfilePoint centre, float radius, float from_rad, float to_rad, int n) {
  std::vector<ProfilePoint> run;
  for (int i = 0; i <= n; ++i) {
    const float angle = from_rad + (to_rad - from_rad) * float(i) / float(n);
    run.push_back(
        {std::max(0.0f, centre.radius + radius * std::cos(angle)), centre.height + radius * std::sin(angle)});
    if (run.back().radius < 1e-6f) run.back().radius = 0.0f;
  }
  return run;
}

std::vector<ProfilePoint> joined(const std::vector<std::vector<ProfilePoint>>& runs) {
  std::vector<ProfilePoint> all = runs.front();
  for (std::size_t i = 1; i < runs.size(); ++i) all.insert(all.end(), runs[i].begin() + 1, runs[i].end());
  return all;
}

Mesh cylinder(float radius, float height, float bevel_radius, int segments, int rings) {
  const float b = bevel_radius, inner = radius - b;
  const int cap = std::max(2, int(float(segments) * inner / radius / 6.0f));
  return revolve(
      {joined({line({0, height}, {inner, height}, cap), arc({inner, height - b}, b, 0.5f * kPi, 0.0f, 3),
               line({radius, height - b}, {radius, b}, rings), arc({inner, b}, b, 0.0f, -0.5f * kPi, 3),
               line({inner, 0}, {0, 0}, cap)})},
      segments);
}

Mesh torus(float major, float minor, int segments, int sides) {
  return surface(segments, sides, [&](float u, float v) {
    const float longitude = 2 * kPi * u, around = -2 * kPi * v;
    const glm::vec3 radial = onSphere(longitude, 0.0f);
    const glm::vec3 normal = radial * std::cos(around) + glm::vec3(0, std::sin(around), 0);
    return SurfacePoint{radial * major + minor * normal, normal, onSphere(longitude + 0.5f * kPi, 0.0f)};
  });
}

Mesh tube(const std::function<glm::vec3(float t)>& curve, float radius, int segments, int sides) {
  // Frames are carried from segment to segment by the smallest rotation; what is missing to close the loop is shared out.
  const float h = 0.25f / float(segments);
  std::vector<glm::vec3> tangents, normals;
  for (int i = 0; i <= segments; ++i) {
    const float t = float(i) / float(segments);
    tangents.push_back(glm::normalize(curve(t + h) - curve(t - h)));
  }
  const glm::vec3 any = std::abs(tangents[0].y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
  normals.push_back(glm::normalize(glm::cross(tangents[0], any)));
  for (std::size_t i = 1; i < tangents.size(); ++i) {
    const glm::vec3 n = normals.back() - tangents[i] * glm::dot(tangents[i], normals.back());
    normals.push_back(glm::normalize(n));
  }
  const glm::vec3 first_binormal = glm::cross(tangents[0], normals[0]);
  const float twist =
      std::atan2(glm::dot(normals.back(), first_binormal), glm::dot(normals.back(), normals[0]));
  return surface(segments, sides, [&](float u, float v) {
    const std::size_t i = std::size_t(std::lround(u * float(segments)));
    const bool closing = int(i) == segments;  // the last ring repeats the first one exactly
    const glm::vec3 n = closing ? normals[0] : normals[i];
    const glm::vec3 along = closing ? tangents[0] : tangents[i];
    const float angle = 2 * kPi * v - (closing ? 0.0f : twist * u);
    const glm::vec3 out = n * std::cos(angle) + glm::cross(along, n) * std::sin(angle);
    return SurfacePoint{curve(closing ? 0.0f : u) + radius * out, out, along};
  });
}

Mesh torusKnot(int p, int q, float major, float minor, float tube_radius, int segments, int sides) {
  return tube(
      [=](float t) {
        const float round_axis = 2 * kPi * float(p) * t, round_torus = 2 * kPi * float(q) * t;
        return onSphere(round_axis, 0.0f) * (major + minor * std::cos(round_torus)) +
               glm::vec3(0, minor * std::sin(round_torus), 0);
      },
      tube_radius, segments, sides);
}

Mesh bowl(float radius, float coverage, int frequency) {
  // Rings of nearly equal spacing; a run that rises is seen from inside.
  const float end =
      std::acos(std::clamp(1.0f - 2.0f * coverage, -1.0f, 1.0f));  // angle from the lowest point
  const int rings = std::max(2, int(std::lround(end / (0.5f * kPi) * float(frequency))));
  Mesh mesh = revolve({arc({0, 0}, radius, -0.5f * kPi, -0.5f * kPi + end, rings)}, 4 * frequency);
  // On a sphere the normal is known exactly, also at the rim.
  for (std::size_t i = 0; i < mesh.vertexCount(); ++i) mesh.normals[i] = -glm::normalize(mesh.positions[i]);
  return mesh;
}

}  // namespace gloam::shapes
