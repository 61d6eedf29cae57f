// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Shapes made by code, tessellated finely enough for per-vertex light. All have unit normals, tangents, one UV set (u to
// the right, v down, seen from outside) and counter-clockwise triangles of non-zero area. Lengths in metres. Where a
// shape has seams, vertices stand there twice with equal positions.
#pragma once

#include <gloam/scene.h>

#include <functional>
#include <vector>

namespace gloam::shapes {

/// A point of a parametric surface. `tangent` points along increasing u; it need not be unit or perpendicular.
struct SurfacePoint {
  glm::vec3 position{0.0f}, normal{0.0f}, tangent{0.0f};
};
/// (nu + 1) x (nv + 1) vertices over the unit square. Triangles without area (at poles) are left out.
Mesh surface(int nu, int nv, const std::function<SurfacePoint(float u, float v)>& point);

/// Sphere about the origin: an icosahedron whose edges are divided into `frequency`; 10 f^2 + 2 places.
Mesh icosphere(float radius, int frequency);
/// Sphere with poles on the Y axis.
Mesh uvSphere(float radius, int segments, int rings);

/// A flat rectangle: vertices at origin + u edge_u + v edge_v for all pairs of the given parameters; faces
/// cross(edge_v, edge_u) since v runs down. UVs are u and v.
Mesh patch(const glm::vec3& origin, const glm::vec3& edge_u, const glm::vec3& edge_v,
           const std::vector<float>& us, const std::vector<float>& vs);
/// Parameters 0 to 1 in n equal steps.
std::vector<float> steps(int n);
/// Distances from 0 to length in steps of about `cell`. Where the surface overlaps its neighbour at a corner it runs on by
/// that much, so that no crack shows, and a line of vertices stands 3 mm short of the corner, since those beyond it are
/// buried and dark.
std::vector<float> spaced(float length, float cell, float overlap_start = 0.0f, float overlap_end = 0.0f);
/// Ground that faces +Y, size_x by size_z about the origin, nx by nz cells.
Mesh ground(float size_x, float size_z, int nx, int nz);

/// Axis-aligned box with cells of about the given size on all faces.
Mesh box(const glm::vec3& low, const glm::vec3& high, float cell);
/// Box about the origin whose edges are rounded; each half must be at least the radius. `bevel` cells across an edge's
/// half. Faces carry UVs of their own.
Mesh roundedBox(const glm::vec3& half, float radius, float cell, int bevel = 3);
/// A plinth: the top (y = 0) and sides of a rounded box, without its underside.
Mesh slab(float half_x, float half_z, float thickness, float radius, float cell);

/// A moulding along +X: at each of the given places the same profile of (z, y), one smooth run. Where it runs towards +Z it
/// faces up. UVs are x and the length of the profile, in metres.
Mesh extrude(const std::vector<glm::vec2>& profile, const std::vector<float>& xs);

/// A point of a profile: distance from the axis and height.
struct ProfilePoint {
  float radius, height;
};
/// Turns profiles about the Y axis. Each profile is one smooth run of points from top to bottom as seen from outside
/// (from bottom to top for a surface seen from inside); between runs there is an edge.
Mesh revolve(const std::vector<std::vector<ProfilePoint>>& profiles, int segments);
/// Straight run from a to b in n cells, both ends included.
std::vector<ProfilePoint> line(ProfilePoint a, ProfilePoint b, int n);
/// Circular arc about a centre from one angle to another (radians, 0 along +radius, counter-clockwise towards +height).
std::vector<ProfilePoint> arc(ProfilePoint centre, float radius, float from_rad, float to_rad, int n);
/// Joins runs whose ends touch into one smooth run.
std::vector<ProfilePoint> joined(const std::vector<std::vector<ProfilePoint>>& runs);
/// Closed cylinder about the Y axis from y = 0 to height, edges rounded by `bevel_radius`.
Mesh cylinder(float radius, float height, float bevel_radius, int segments, int rings);

/// Torus about the Y axis.
Mesh torus(float major, float minor, int segments, int sides);
/// A tube along a closed curve over 0..1, its frame carried along without twist.
Mesh tube(const std::function<glm::vec3(float t)>& curve, float radius, int segments, int sides);
/// Torus knot about the Y axis: winds p times round the axis and q times round the torus; 2, 3 is the trefoil.
Mesh torusKnot(int p, int q, float major, float minor, float tube_radius, int segments, int sides);

/// The inside of a spherical bowl about the origin, open at the top, a single sheet that faces inward: the part of the
/// sphere below height radius * (2 coverage - 1), which is the share `coverage` of its area.
Mesh bowl(float radius, float coverage, int frequency);

// ---- Putting shapes together
Mesh transformed(Mesh mesh, const glm::mat4& matrix);
Mesh moved(Mesh mesh, const glm::vec3& by);
void append(Mesh& mesh, const Mesh& other);
/// Multiplies UVs.
Mesh withUvScale(Mesh mesh, const glm::vec2& scale);
/// Smooth tangents perpendicular to the normals for shapes that have no natural direction.
void makeTangents(Mesh& mesh);

}  // namespace gloam::shapes
