// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// A scene as a file holds it: meshes, materials, nodes, cameras, lights, animation. Plain data, no behaviour beyond
// reading, writing and posing. World: right-handed, +Y up, metres. Light: linear Rec. 709 radiance.
#pragma once

#include <gloam/error.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gloam {

inline constexpr int kNone = -1;  ///< an index that points nowhere

/// An 8-bit RGBA picture; rows from the top, as glTF has them. Whether it is sRGB or linear follows from its use.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4
};

enum class Wrap : std::uint8_t { kRepeat, kClampToEdge, kMirroredRepeat };

/// Where a material takes a texture from.
struct TextureSlot {
  int texture = kNone;  ///< index into Scene::textures
  int uv_set = 0;       ///< index into Mesh::uv_sets
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;             ///< magnification filter
  glm::mat3 texture_from_uv{1.0f};  ///< KHR_texture_transform, applied to (u, v, 1)
  explicit operator bool() const { return texture != kNone; }
};

/// glTF's metallic-roughness material. It is shaded as a Lambert and a Phong lobe (math/brdf.h):
/// k_d = base (1 - metallic), k_s = mix(0.04 specular, base, metallic), exponent n = max(1, 2 / roughness^4 - 2).
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};
  float metallic = 1.0f;
  float roughness = 1.0f;
  float specular =
      1.0f;  ///< KHR_materials_specular's specularFactor, 0 to 1: 0 makes a purely diffuse non-metal
  glm::vec3 emission{0.0f};  ///< radiance: emissiveFactor times KHR_materials_emissive_strength
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;  ///< read and kept; not used in lighting, which computes its own occlusion
  bool alpha_mask = false;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  TextureSlot base_color_map;          ///< sRGB; alpha is used with alpha_mask
  TextureSlot metallic_roughness_map;  ///< linear; G roughness, B metallic
  TextureSlot normal_map;              ///< linear
  TextureSlot occlusion_map;           ///< linear; R
  TextureSlot emission_map;            ///< sRGB
};

/// Displacements of one morph target; each array is empty or as long as Mesh::positions.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals, tangents;
};

/// Glossy transfer of a mesh's vertices (PRT-2), without the receiver's own BRDF: from the light's coefficients to those of
/// the radiance that arrives, a bands of light to b bands of radiance, i < b^2, j < a^2, a <= b. GS_ij, the integral of
/// V y_i y_j with V = 0 below the tangent plane, is the sum over k of Gamma_ijk V_k: exact with V to a + b - 1 bands, so that
/// these hold the matrix in a quarter of its size (math/sh_high_order.h).
struct GlossyTransfer {
  int light_order = 0, field_order = 0;  ///< a and b, 1 to 6; 0: there is none
  /// 0: any lobe may be chosen at run time. Else one Phong lobe of that exponent is baked in: rows i of `indirect` are
  /// multiplied by its band factors, those of GS are to be.
  float exponent = 0.0f;
  std::vector<float> visibility;  ///< V: [vertex][coefficient], size vertices * (a + b - 1)^2
  std::vector<float> indirect;    ///< GI - GS: [vertex][i][j][rgb]; empty without bounces
  bool empty() const { return light_order == 0; }
  /// Values a vertex of `visibility`, and of `indirect` for each colour.
  std::size_t visibilityCount() const {
    const int bands = empty() ? 0 : light_order + field_order - 1;
    return static_cast<std::size_t>(bands * bands);
  }
  std::size_t matrixCount() const {
    return static_cast<std::size_t>(light_order * light_order * field_order * field_order);
  }
};

struct CompressedTransfer;  // gloam/compress.h

/// Precomputed radiance transfer of a mesh's points (PRT-1), without the receiver's own albedo / pi. In the mesh's own
/// axes: coefficients belong to directions in object space (scale taken out). DS and DI - DS stand apart. Points are the
/// mesh's vertices, or the texels of a lightmap: texel (x, y), x first, is point y * texel_width + x; its middle lies at
/// u = (x + 1/2) / texel_width, v = (y + 1/2) / texel_height of `uv_set`. Texels that no triangle covers hold what is
/// nearest, so that bilinear filtering never meets an empty one.
struct Transfer {
  int order = 0;              ///< n bands, n^2 coefficients a point
  int bounces = 0;            ///< interreflection passes contained in `indirect`
  int directions = 0;         ///< directions a point in the first pass; the most that any took
  int object = 0;  ///< meshes of one number were baked together and stay together; others may move against them
  std::vector<float> direct;  ///< DS: [point][coefficient], size points * order^2
  std::vector<float>
      indirect;  ///< DI - DS: [point][coefficient][rgb], size points * order^2 * 3; empty without bounces
  GlossyTransfer glossy;                  ///< always of vertices
  int texel_width = 0, texel_height = 0;  ///< 0: points are vertices
  int uv_set = 0;                         ///< index into Mesh::uv_sets; texels only
  /// Clustered PCA of `direct` and `indirect`, which are what it expands to; files keep it in their place. Null: none.
  std::shared_ptr<const CompressedTransfer> compressed;
  bool ofTexels() const { return texel_width > 0; }
};

struct NeighbourhoodTransfer;  // gloam/neighbourhood.h
struct Volume;                 // gloam/volume.h

/// Triangles that share a material: a glTF primitive. All vertex arrays have the length of `positions` or are empty
/// (normals and tangents are never empty after reading a file: missing ones are computed).
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec4> tangents;  ///< xyz and the sign of the bitangent
  std::vector<std::vector<glm::vec2>> uv_sets;
  std::vector<glm::vec4> colors;
  int influences = 0;                 ///< joints a vertex: 0, 4, 8 …
  std::vector<std::uint16_t> joints;  ///< [vertex][influence], indices into Skin::joints
  std::vector<float> weights;         ///< [vertex][influence], sums to 1
  std::vector<MorphTarget> morph_targets;
  std::vector<std::uint32_t> indices;        ///< three a triangle, counter-clockwise seen from outside
  int material = 0;                          ///< index into Scene::materials; always valid
  std::shared_ptr<const Transfer> transfer;  ///< null unless baked

  std::size_t vertexCount() const { return positions.size(); }
  std::size_t triangleCount() const { return indices.size() / 3; }
};

struct Camera {
  std::string name;
  bool perspective = true;
  float vertical_fov_rad = 0.8f;
  float aspect = 0.0f;       ///< width / height; 0: that of the picture
  float half_height = 1.0f;  ///< orthographic
  float z_near = 0.05f;
  float z_far = std::numeric_limits<float>::infinity();
};

/// Punctual light (KHR_lights_punctual). Shines along -Z of its node. Colour times intensity is stored as one value:
/// candela for point and spot, lux for directional, in linear Rec. 709.
struct Light {
  enum class Type : std::uint8_t { kDirectional, kPoint, kSpot };
  std::string name;
  Type type = Type::kPoint;
  glm::vec3 intensity{1.0f};
  float range = 0.0f;  ///< 0: unlimited
  float inner_cone_rad = 0.0f;
  float outer_cone_rad = 0.785398163f;
};

/// Which light is computed: by what sends it, and by whether the first surface that it meets is the one that is seen
/// (direct) or it came there by way of others (indirect). Local light is that of lamps; emitters are surfaces with
/// emission, whose own glow is always seen.
struct Coverage {
  bool environment_direct = false, environment_indirect = false;
  bool local_direct = false, local_indirect = false;
  bool emitter_direct = false, emitter_indirect = false;
  bool operator==(const Coverage&) const = default;
};
inline constexpr Coverage kAllLight{true, true, true, true, true, true};

struct Skin {
  std::vector<int> joints;                 ///< node indices
  std::vector<glm::mat4> joint_from_mesh;  ///< inverse bind matrices, one a joint
};

struct Node {
  std::string name;
  int parent = kNone;
  std::vector<int> children;
  glm::vec3 translation{0.0f};
  glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< w, x, y, z
  glm::vec3 scale{1.0f};
  std::optional<glm::mat4> matrix;  ///< instead of translation, rotation, scale where the file gives one
  std::vector<int> meshes;          ///< indices into Scene::meshes: the primitives of a glTF mesh
  int skin = kNone, camera = kNone, light = kNone;
  std::vector<float> morph_weights;
  std::vector<glm::mat4>
      instances;  ///< EXT_mesh_gpu_instancing: node_from_instance; empty: one, the identity
  std::shared_ptr<const NeighbourhoodTransfer>
      neighbourhood;                     ///< what stands here throws on others; null unless baked
  std::shared_ptr<const Volume> volume;  ///< of smoke or cloud that stands here; null: none
};

struct AnimationChannel {
  enum class Path : std::uint8_t { kTranslation, kRotation, kScale, kWeights };
  enum class Interpolation : std::uint8_t { kStep, kLinear, kCubicSpline };
  int node = kNone;
  Path path = Path::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;
  std::vector<float> values;  ///< components a key; three times as many for cubic splines (in, value, out)
  int components = 3;
};

struct Animation {
  std::string name;
  std::vector<AnimationChannel> channels;
};

struct EnvironmentLights;  // gloam/lights.h

/// Light from infinitely far away: an equirectangular map or an analytic sky.
/// u = atan2(z, x) / 2 pi + 1/2, v = asin(y) / pi + 1/2, v up; pixels are stored with the top row (v = 1) first.
struct Environment {
  std::string name;  ///< file, or the sky's name
  int width = 0, height = 0;
  std::vector<glm::vec3> radiance;  ///< width * height
  float rotation_rad = 0.0f;        ///< turns the light about +Y, counter-clockwise seen from above
  float intensity = 1.0f;
  Warnings warnings;  ///< what the reader mended
  /// What `radiance` was painted from, where that is known exactly; null: the pixels are all there is.
  std::shared_ptr<const EnvironmentLights> lights;
  bool empty() const { return radiance.empty(); }
};

/// All of a file. Indices are checked by the reader: whoever gets a Scene may use them unchecked.
struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;
  std::vector<int> roots;  ///< nodes of the scene that is shown
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Skin> skins;
  std::vector<Animation> animations;
  Environment
      environment;    ///< empty unless the scene brings its own (EXT_lights_image_based, built-in scenes)
  Warnings warnings;  ///< what the reader mended or left out

  float duration_s() const;  ///< time of the last key of all animations
};

/// Reads .gltf, .glb, and .obj, .ply, .off, .fbx, .3ds where built with assimp; `builtin:NAME` makes a scene by code.
/// Throws Error that names the file and the field.
Scene loadScene(const std::string& path_or_name, const Progress& progress = {});

/// Adds a round floor, three times as wide as the scene, under its lowest point at time 0: somewhere for the shadow of a
/// bare model to fall. `albedo` is linear; `cells` vertices a side, finer toward the middle.
void addGround(Scene& scene, const glm::vec3& albedo = glm::vec3(0.5f), int cells = 160);

/// Names of the scenes that are made by code, each with a line that says what it shows.
struct BuiltinScene {
  const char* name;
  const char* summary;
};
const std::vector<BuiltinScene>& builtinScenes();

/// The same scene with a mesh of its own for every rigid one that is placed: what is baked into a mesh holds for one
/// place only. EXT_mesh_gpu_instancing becomes nodes; meshes that no shown node places are left out. Skinned and morphed
/// meshes stay shared.
Scene makeInstancesUnique(const Scene& scene);

struct WriteOptions {
  bool half_float = false;  ///< store transfer as 16-bit floats
};
/// Writes a .glb (docs/formats/ describes the extension that holds transfer). Writes beside the target and renames;
/// throws Error where the file cannot be written.
void writeGlb(const Scene& scene, const std::filesystem::path& path, const WriteOptions& options = {});

/// Reads an equirectangular .hdr or .exr, or makes an analytic sky by name ("sky:mild", "sky:preetham?elevation=30", …,
/// as `gloam list` shows; docs/skies.md). Negative pixels become 0 with a warning. Throws Error, also for a pixel that is
/// not a number or infinite.
Environment loadEnvironment(const std::string& path_or_name);
const std::vector<BuiltinScene>& builtinSkies();
/// Radiance that arrives from a direction, bilinear, with the environment's rotation and intensity.
glm::vec3 radianceFrom(const Environment& environment, const glm::vec3& direction);

// ---- A scene at one instant ---------------------------------------------------------------------------------------

/// One mesh standing in the world.
struct Instance {
  int mesh = kNone;  ///< index into Scene::meshes
  int node = kNone;
  glm::mat4 world_from_object{1.0f};
  /// Vertices of skinned or morphed meshes, already in world space; empty for rigid ones. Where set, world_from_object
  /// is the identity.
  std::vector<glm::vec3> deformed_positions, deformed_normals;
  std::vector<glm::vec4> deformed_tangents;
  bool deformed() const { return !deformed_positions.empty(); }
};

struct PosedCamera {
  Camera camera;
  glm::mat4 world_from_view{1.0f};  ///< looks along -Z
};

struct PosedLight {
  Light light;
  glm::vec3 position{0.0f};
  glm::vec3 direction{0.0f, 0.0f, -1.0f};  ///< the way it shines
};

/// What is where at a time. Keeps no pointer into the scene.
struct PosedScene {
  float time_s = 0.0f;
  std::vector<Instance> instances;
  std::vector<PosedCamera> cameras;
  std::vector<PosedLight> lights;
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};  ///< of all vertices
};

/// Evaluates animation at a time (clamped to each channel's range), skins and morphs on all cores.
PosedScene pose(const Scene& scene, float time_s);

/// A camera that shows all of the scene: used where a file has none.
PosedCamera framingCamera(const PosedScene& posed, float aspect);
/// Turns a camera about the vertical axis through the middle of the scene.
PosedCamera orbit(const PosedCamera& camera, const PosedScene& posed, float angle_rad);

}  // namespace gloam
