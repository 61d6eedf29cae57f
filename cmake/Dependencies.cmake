# Every dependency of gloam, found in one place. All are Debian 12 packages; nothing is vendored or downloaded.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(TBB REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(draco REQUIRED)
find_package(hwy REQUIRED)
find_package(Vulkan REQUIRED)
find_package(CLI11 REQUIRED)
pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)
find_path(EIGEN_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)
find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_path(VOLK_INCLUDE_DIR volk.h REQUIRED)
find_program(GLSLC_PROGRAM glslc REQUIRED)

# Embree 4 where the system has it, 3.13 on Debian 12.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 REQUIRED)
endif()

# Optional: OBJ, PLY, OFF, FBX and 3DS come through assimp where it is installed.
find_package(assimp QUIET)

# Optional: .vdb volumes come through OpenVDB where it is installed, with the Boost headers that its own include.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
find_path(OPENVDB_BOOST_INCLUDE_DIR boost/numeric/conversion/conversion_traits.hpp)
find_library(OPENVDB_LIBRARY openvdb)
if(NOT OPENVDB_INCLUDE_DIR OR NOT OPENVDB_BOOST_INCLUDE_DIR)
  set(OPENVDB_LIBRARY "")
endif()

if(GLOAM_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
