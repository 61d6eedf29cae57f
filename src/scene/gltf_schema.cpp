// gloam - real-time soft global illumination
// SPDX-License-Identifier: MIT
//
// Members of glTF 2.0 (Khronos specification, section 5) and of the extensions that are read.
#include "scene/gltf_schema.h"

namespace gloam {
namespace {

constexpr bool kRequired = true;

constexpr Field kGltf[] = {
    {"asset", Kind::kObject, "asset", kRequired},
    {"accessors", Kind::kObjects, "accessor"},
    {"animations", Kind::kObjects, "animation"},
    {"buffers", Kind::kObjects, "buffer"},
    {"bufferViews", Kind::kObjects, "bufferView"},
    {"cameras", Kind::kObjects, "camera"},
    {"extensions", Kind::kObject, "gltf.extensions"},
    {"extensionsRequired", Kind::kNames},
    {"extensionsUsed", Kind::kNames},
    {"images", Kind::kObjects, "image"},
    {"materials", Kind::kObjects, "material"},
    {"meshes", Kind::kObjects, "mesh"},
    {"nodes", Kind::kObjects, "node"},
    {"samplers", Kind::kObjects, "sampler"},
    {"scene", Kind::kIndex, "scenes"},
    {"scenes", Kind::kObjects, "scene"},
    {"skins", Kind::kObjects, "skin"},
    {"textures", Kind::kObjects, "texture"},
};
constexpr Field kGltfExtensions[] = {
    {"KHR_lights_punctual", Kind::kObject, "punctualLights"},
    {"EXT_lights_image_based", Kind::kObject, "imageLights"},
};
constexpr Field kPunctualLights[] = {{"lights", Kind::kObjects, "light", kRequired}};
constexpr Field kImageLights[] = {{"lights", Kind::kObjects, "imageLight", kRequired}};
constexpr Field kAsset[] = {{"version", Kind::kString, "", kRequired}, {"minVersion", Kind::kString}};

constexpr Field kAccessor[] = {
    {"bufferView", Kind::kIndex, "bufferViews"},
    {"byteOffset", Kind::kCount},
    {"componentType", Kind::kCode, "5120 5121 5122 5123 5125 5126", kRequired},
    {"normalized", Kind::kBool},
    {"count", Kind::kCount, "", kRequired},
    {"type", Kind::kChoice, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4", kRequired},
    {"sparse", Kind::kObject, "sparse"},
};
constexpr Field kSparse[] = {
    {"count", Kind::kCount, "", kRequired, 0, kLargestInt},
    {"indices", Kind::kObject, "sparseIndices", kRequired},
    {"values", Kind::kObject, "sparseValues", kRequired},
};
constexpr Field kSparseIndices[] = {
    {"bufferView", Kind::kIndex, "bufferViews", kRequired},
    {"byteOffset", Kind::kCount, "", false, 0, kLargestInt},
    {"componentType", Kind::kCode, "5121 5123 5125", kRequired},
};
constexpr Field kSparseValues[] = {
    {"bufferView", Kind::kIndex, "bufferViews", kRequired},
    {"byteOffset", Kind::kCount, "", false, 0, kLargestInt},
};
constexpr Field kBuffer[] = {{"byteLength", Kind::kCount, "", kRequired}, {"uri", Kind::kString}};
constexpr Field kBufferView[] = {
    {"buffer", Kind::kIndex, "buffers", kRequired},
    {"byteOffset", Kind::kCount},
    {"byteLength", Kind::kCount, "", kRequired},
    {"byteStride", Kind::kCount, "", false, 4, 252},
    {"extensions", Kind::kObject, "bufferView.extensions"},
};
constexpr Field kBufferViewExtensions[] = {{"EXT_meshopt_compression", Kind::kObject, "meshopt"}};
constexpr Field kMeshopt[] = {
    {"buffer", Kind::kIndex, "buffers", kRequired},
    {"byteOffset", Kind::kCount},
    {"byteLength", Kind::kCount, "", kRequired},
    {"byteStride", Kind::kCount, "", kRequired, 1, 256},
    {"count", Kind::kCount, "", kRequired},
    {"mode", Kind::kChoice, "ATTRIBUTES TRIANGLES INDICES", kRequired},
    {"filter", Kind::kChoice, "NONE OCTAHEDRAL QUATERNION EXPONENTIAL"},
};

constexpr Field kAnimation[] = {
    {"name", Kind::kString},
    {"channels", Kind::kObjects, "channel", kRequired},
    {"samplers", Kind::kObjects, "animationSampler", kRequired},
};
constexpr Field kChannel[] = {
    {"sampler", Kind::kCount, "", kRequired, 0, kLargestInt},
    {"target", Kind::kObject, "channelTarget", kRequired},
};
constexpr Field kChannelTarget[] = {{"node", Kind::kIndex, "nodes"}, {"path", Kind::kString, "", kRequired}};
constexpr Field kAnimationSampler[] = {
    {"input", Kind::kIndex, "accessors", kRequired},
    {"output", Kind::kIndex, "accessors", kRequired},
    {"interpolation", Kind::kChoice, "LINEAR STEP CUBICSPLINE"},
};
constexpr Field kSkin[] = {
    {"name", Kind::kString},
    {"inverseBindMatrices", Kind::kIndex, "accessors"},
    {"joints", Kind::kIndices, "nodes", kRequired},
    {"skeleton", Kind::kIndex, "nodes"},
};

constexpr Field kCamera[] = {
    {"name", Kind::kString},
    {"type", Kind::kChoice, "perspective orthographic", kRequired},
    {"perspective", Kind::kObject, "perspective"},
    {"orthographic", Kind::kObject, "orthographic"},
};
constexpr Field kPerspective[] = {
    {"aspectRatio", Kind::kNumber, "", false, 1e-6, 1e6},
    {"yfov", Kind::kNumber, "", kRequired, 1e-6, 3.1415},
    {"zfar", Kind::kNumber, "", false, 1e-30, kUnbounded},
    {"znear", Kind::kNumber, "", kRequired, 1e-30, kUnbounded},
};
constexpr Field kOrthographic[] = {
    {"xmag", Kind::kNumber, "", kRequired},
    {"ymag", Kind::kNumber, "", kRequired},
    {"zfar", Kind::kNumber, "", kRequired},
    {"znear", Kind::kNumber, "", kRequired},
};
constexpr Field kLight[] = {
    {"name", Kind::kString},
    {"type", Kind::kString, "", kRequired},
    {"color", Kind::kNumbers, "", false, 3},
    {"intensity", Kind::kNumber, "", false, 0, kUnbounded},
    {"range", Kind::kNumber, "", false, 0, kUnbounded},
    {"spot", Kind::kObject, "spot"},
};
constexpr Field kSpot[] = {
    {"innerConeAngle", Kind::kNumber, "", false, 0, 3.1416},
    {"outerConeAngle", Kind::kNumber, "", false, 0, 3.1416},
};
constexpr Field kImageLight[] = {
    {"rotation", Kind::kNumbers, "", false, 4},
    {"intensity", Kind::kNumber, "", false, 0, kUnbounded},
    {"irradianceCoefficients", Kind::kAny, "", kRequired},
};

constexpr Field kImage[] = {
    {"name", Kind::kString},
    {"uri", Kind::kString},
    {"mimeType", Kind::kString},
    {"bufferView", Kind::kIndex, "bufferViews"},
};
constexpr Field kSampler[] = {
    {"magFilter", Kind::kCode, "9728 9729"},
    {"minFilter", Kind::kCode, "9728 9729 9984 9985 9986 9987"},
    {"wrapS", Kind::kCode, "33071 33648 10497"},
    {"wrapT", Kind::kCode, "33071 33648 10497"},
};
constexpr Field kTexture[] = {
    {"name", Kind::kString},
    {"sampler", Kind::kIndex, "samplers"},
    {"source", Kind::kIndex, "images"},
    {"extensions", Kind::kObject, "texture.extensions"},
};
constexpr Field kTextureExtensions[] = {
    {"KHR_texture_basisu", Kind::kObject, "textureSource"},
    {"EXT_texture_webp", Kind::kObject, "textureSource"},
};
constexpr Field kTextureSource[] = {{"source", Kind::kIndex, "images"}};
constexpr Field kTextureInfo[] = {
    {"index", Kind::kIndex, "textures", kRequired},
    {"texCoord", Kind::kCount, "", false, 0, 31},
    {"scale", Kind::kNumber},
    {"strength", Kind::kNumber},
    {"extensions", Kind::kObject, "textureInfo.extensions"},
};
constexpr Field kTextureInfoExtensions[] = {{"KHR_texture_transform", Kind::kObject, "textureTransform"}};
constexpr Field kTextureTransform[] = {
    {"offset", Kind::kNumbers, "", false, 2},
    {"rotation", Kind::kNumber},
    {"scale", Kind::kNumbers, "", false, 2},
    {"texCoord", Kind::kCount, "", false, 0, 31},
};
constexpr Field kMaterial[] = {
    {"name", Kind::kString},
    {"pbrMetallicRoughness", Kind::kObject, "metallicRoughness"},
    {"normalTexture", Kind::kObject, "textureInfo"},
    {"occlusionTexture", Kind::kObject, "textureInfo"},
    {"emissiveTexture", Kind::kObject, "textureInfo"},
    {"emissiveFactor", Kind::kNumbers, "", false, 3},
    {"alphaMode", Kind::kChoice, "OPAQUE MASK BLEND"},
    {"alphaCutoff", Kind::kNumber},
    {"doubleSided", Kind::kBool},
    {"extensions", Kind::kObject, "material.extensions"},
};
constexpr Field kMetallicRoughness[] = {
    {"baseColorFactor", Kind::kNumbers, "", false, 4},
    {"baseColorTexture", Kind::kObject, "textureInfo"},
    {"metallicFactor", Kind::kNumber},
    {"roughnessFactor", Kind::kNumber},
    {"metallicRoughnessTexture", Kind::kObject, "textureInfo"},
};
constexpr Field kMaterialExtensions[] = {
    {"KHR_materials_emissive_strength", Kind::kObject, "emissiveStrength"},
    {"KHR_materials_pbrSpecularGlossiness", Kind::kObject, "specularGlossiness"},
    {"KHR_materials_specular", Kind::kObject, "specular"},
    {"KHR_materials_unlit", Kind::kAny},
};
constexpr Field kEmissiveStrength[] = {{"emissiveStrength", Kind::kNumber, "", false, 0, kUnbounded}};
constexpr Field kSpecular[] = {{"specularFactor", Kind::kNumber, "", false, 0, 1}};
constexpr Field kSpecularGlossiness[] = {
    {"diffuseFactor", Kind::kNumbers, "", false, 4},
    {"diffuseTexture", Kind::kObject, "textureInfo"},
    {"specularFactor", Kind::kNumbers, "", false, 3},
    {"glossinessFactor", Kind::kNumber},
    {"specularGlossinessTexture", Kind::kObject, "textureInfo"},
};

constexpr Field kMesh[] = {
    {"name", Kind::kString},
    {"primitives", Kind::kObjects, "primitive", kRequired},
    {"weights", Kind::kNumbers},
};
constexpr Field kPrimitive[] = {
    {"attributes", Kind::kIndexMap, "accessors", kRequired},
    {"indices", Kind::kIndex, "accessors"},
    {"material", Kind::kIndex, "materials"},
    {"mode", Kind::kCode, "0 1 2 3 4 5 6"},
    {"targets", Kind::kIndexMaps, "accessors"},
    {"extensions", Kind::kObject, "primitive.extensions"},
};
constexpr Field kPrimitiveExtensions[] = {
    {"KHR_draco_mesh_compression", Kind::kObject, "draco"},
    {"GLOAM_precomputed_transfer", Kind::kAny},
};
constexpr Field kDraco[] = {
    {"bufferView", Kind::kIndex, "bufferViews", kRequired},
    {"attributes", Kind::kCountMap, "", kRequired},
};
constexpr Field kNode[] = {
    {"name", Kind::kString},
    {"camera", Kind::kIndex, "cameras"},
    {"children", Kind::kIndices, "nodes"},
    {"skin", Kind::kIndex, "skins"},
    {"matrix", Kind::kNumbers, "", false, 16},
    {"mesh", Kind::kIndex, "meshes"},
    {"rotation", Kind::kNumbers, "", false, 4},
    {"scale", Kind::kNumbers, "", false, 3},
    {"translation", Kind::kNumbers, "", false, 3},
    {"weights", Kind::kNumbers},
    {"extensions", Kind::kObject, "node.extensions"},
};
constexpr Field kNodeExtensions[] = {
    {"KHR_lights_punctual", Kind::kObject, "nodeLight"},
    {"EXT_mesh_gpu_instancing", Kind::kObject, "instancing"},
    {"KHR_node_visibility", Kind::kObject, "visibility"},
    {"GLOAM_neighbourhood_transfer", Kind::kAny},
    {"GLOAM_volume", Kind::kAny},
};
constexpr Field kNodeLight[] = {{"light", Kind::kIndex, "lights", kRequired}};
constexpr Field kInstancing[] = {{"attributes", Kind::kIndexMap, "accessors", kRequired}};
constexpr Field kVisibility[] = {{"visible", Kind::kBool}};
constexpr Field kScene[] = {
    {"name", Kind::kString},
    {"nodes", Kind::kIndices, "nodes"},
    {"extensions", Kind::kObject, "scene.extensions"},
    {"extras", Kind::kAny},
};
constexpr Field kSceneExtensions[] = {{"EXT_lights_image_based", Kind::kObject, "sceneLight"}};
constexpr Field kSceneLight[] = {{"light", Kind::kIndex, "imageLights", kRequired}};

// clang-format off
constexpr ObjectSchema kObjects[] = {
    {"gltf", kGltf}, {"gltf.extensions", kGltfExtensions}, {"asset", kAsset},
    {"punctualLights", kPunctualLights}, {"imageLights", kImageLights}, {"accessor", kAccessor},
    {"sparse", kSparse}, {"sparseIndices", kSparseIndices}, {"sparseValues", kSparseValues},
    {"buffer", kBuffer}, {"bufferView", kBufferView}, {"bufferView.extensions", kBufferViewExtensions},
    {"meshopt", kMeshopt}, {"animation", kAnimation}, {"channel", kChannel},
    {"channelTarget", kChannelTarget}, {"animationSampler", kAnimationSampler}, {"skin", kSkin},
    {"camera", kCamera}, {"perspective", kPerspective}, {"orthographic", kOrthographic}, {"light", kLight},
    {"spot", kSpot}, {"imageLight", kImageLight}, {"image", kImage}, {"sampler", kSampler},
    {"texture", kTexture}, {"texture.extensions", kTextureExtensions}, {"textureSource", kTextureSource},
    {"textureInfo", kTextureInfo}, {"textureInfo.extensions", kTextureInfoExtensions},
    {"textureTransform", kTextureTransform}, {"material", kMaterial},
    {"metallicRoughness", kMetallicRoughness}, {"material.extensions", kMaterialExtensions},
    {"emissiveStrength", kEmissiveStrength}, {"specular", kSpecular},
    {"specularGlossiness", kSpecularGlossiness}, {"mesh", kMesh}, {"primitive", kPrimitive},
    {"primitive.extensions", kPrimitiveExtensions}, {"draco", kDraco}, {"node", kNode},
    {"node.extensions", kNodeExtensions}, {"nodeLight", kNodeLight}, {"instancing", kInstancing},
    {"visibility", kVisibility}, {"scene", kScene}, {"scene.extensions", kSceneExtensions},
    {"sceneLight", kSceneLight},
};
// clang-format on

}  // namespace

std::span<const ObjectSchema> gltfSchema() {
  return kObjects;
}

}  // namespace gloam
