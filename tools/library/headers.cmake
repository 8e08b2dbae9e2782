# SPDX-License-Identifier: Apache-2.0
# The model's headers as others include them, <hotfire/simplex.hpp>: copies in the build folder, whose own includes have the
# same prefix. The target hotfire::model is the same in a build, in an installation and in another project.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(public_headers ${PROJECT_BINARY_DIR}/include)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/model ${PROJECT_SOURCE_DIR}/model/*.hpp)
foreach(header IN LISTS headers)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/model/${header})
  file(READ ${PROJECT_SOURCE_DIR}/model/${header} text)
  string(REPLACE "#include \"model/" "#include \"hotfire/" text "${text}")
  set(old "")
  if(EXISTS ${public_headers}/hotfire/${header})
    file(READ ${public_headers}/hotfire/${header} old)
  endif()
  if(NOT text STREQUAL old)
    file(WRITE ${public_headers}/hotfire/${header} "${text}")
  endif()
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/tools/interface/c/hotfire.h ${public_headers}/hotfire.h COPYONLY)

add_library(hotfire_headers INTERFACE)
add_library(hotfire::model ALIAS hotfire_headers)
set_target_properties(hotfire_headers PROPERTIES EXPORT_NAME model)
target_compile_features(hotfire_headers INTERFACE cxx_std_20)
target_include_directories(hotfire_headers SYSTEM INTERFACE $<BUILD_INTERFACE:${public_headers}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(hotfire_headers INTERFACE Eigen3::Eigen)

if(HOTFIRE_INSTALL)
  set(package ${CMAKE_INSTALL_LIBDIR}/cmake/hotfire)
  install(DIRECTORY ${public_headers}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT sdk)
  install(TARGETS hotfire_headers EXPORT hotfireTargets COMPONENT sdk)
  install(EXPORT hotfireTargets NAMESPACE hotfire:: DESTINATION ${package} COMPONENT sdk)
  file(WRITE ${PROJECT_BINARY_DIR}/hotfireConfig.cmake "include(CMakeFindDependencyMacro)\nfind_dependency(Eigen3 3.4 NO_MODULE)\n"
    "include(\${CMAKE_CURRENT_LIST_DIR}/hotfireTargets.cmake)\n")
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/hotfireConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/hotfireConfig.cmake ${PROJECT_BINARY_DIR}/hotfireConfigVersion.cmake DESTINATION ${package}
    COMPONENT sdk)
  # From the folder of the package files up to the prefix, so that an installation may be moved.
  file(RELATIVE_PATH up_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  foreach(module hotfire hotfire-model)
    configure_file(${PROJECT_SOURCE_DIR}/tools/library/${module}.pc.in ${PROJECT_BINARY_DIR}/${module}.pc @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${module}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT sdk)
  endforeach()
endif()
