# The installed library `gloam` is the sum of all rooms; with it go the public headers, the CMake package, the command
# line and its completion. `cmake --install build/release --prefix …`, then find_package(gloam) and gloam::gloam.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY GLOAM_ROOMS)
set(objects "")
set(libraries "")
foreach(room IN LISTS rooms)
  list(APPEND objects $<TARGET_OBJECTS:${room}>)
  get_target_property(room_libraries ${room} LINK_LIBRARIES)
  list(APPEND libraries ${room_libraries})
endforeach()
list(REMOVE_DUPLICATES libraries)
list(FILTER libraries EXCLUDE REGEX "^gloam_")
list(FILTER libraries EXCLUDE REGEX "^glm::glm$")

add_library(gloam ${objects})
add_library(gloam::gloam ALIAS gloam)
# The headers speak of glm; all else is the library's own business, which a static one passes on to the linker.
target_link_libraries(gloam PUBLIC glm::glm PRIVATE ${libraries})
target_include_directories(gloam PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(gloam PUBLIC cxx_std_20)
set_target_properties(gloam PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINKER_LANGUAGE CXX)

# What the link line of a static gloam names must be found again by whoever uses it.
set(GLOAM_FIND_DEPENDENCIES "find_dependency(glm)\n")
if(NOT BUILD_SHARED_LIBS)
  set(package_of_hwy::hwy hwy)
  set(package_of_OpenEXR::OpenEXR OpenEXR)
  set(package_of_PNG::PNG PNG)
  set(package_of_JPEG::JPEG JPEG)
  set(package_of_fmt::fmt fmt)
  set(package_of_spdlog::spdlog spdlog)
  set(package_of_TBB::tbb TBB)
  set(package_of_meshoptimizer::meshoptimizer meshoptimizer)
  set(package_of_draco::draco draco)
  set(package_of_embree embree)
  set(package_of_assimp::assimp assimp)
  set(package_of_Threads::Threads Threads)
  set(package_of_nlohmann_json::nlohmann_json nlohmann_json)
  set(package_of_Vulkan::Headers Vulkan)
  set(package_of_Vulkan::Vulkan Vulkan)
  foreach(library IN LISTS libraries)
    if(DEFINED package_of_${library})
      string(APPEND GLOAM_FIND_DEPENDENCIES "find_dependency(${package_of_${library}})\n")
    elseif(library MATCHES "^PkgConfig::SPIRV_CROSS$")
      string(APPEND GLOAM_FIND_DEPENDENCIES "find_dependency(PkgConfig)\n"
        "pkg_check_modules(SPIRV_CROSS REQUIRED IMPORTED_TARGET spirv-cross-c-shared)\n")
    elseif(TARGET ${library} OR library MATCHES "::")
      message(FATAL_ERROR "cmake/Install.cmake: say which package holds ${library}")
    endif()
  endforeach()
endif()

install(TARGETS gloam EXPORT gloamTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/gloam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/gloam)
install(EXPORT gloamTargets NAMESPACE gloam:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/gloamConfig.cmake.in ${PROJECT_BINARY_DIR}/gloamConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gloamConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/gloamConfig.cmake ${PROJECT_BINARY_DIR}/gloamConfigVersion.cmake
  DESTINATION ${package_dir})

if(GLOAM_BUILD_APPS)
  install(TARGETS gloam_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES ${PROJECT_BINARY_DIR}/apps/gloam/completion/gloam
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()
