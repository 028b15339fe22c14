# What `cmake --install` and `cpack` make of misfit: the program, the libraries with their headers as they are, and find_package(misfit).
include(CMakePackageConfigHelpers)
set(misfit_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/misfit)

set(misfit_libraries misfit_options misfit_models misfit_apps)
foreach(layer IN LISTS MISFIT_LAYERS)
  if(layer)
    list(APPEND misfit_libraries misfit_${layer})
  endif()
endforeach()
add_library(misfit::models ALIAS misfit_models)
add_library(misfit::apps ALIAS misfit_apps)
set_target_properties(misfit_models PROPERTIES EXPORT_NAME models)
# "apps/command_line.h" is found in the source tree and, installed, under include/misfit.
set_target_properties(misfit_apps PROPERTIES EXPORT_NAME apps)
target_include_directories(misfit_apps INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/misfit>)

install(TARGETS misfit DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS ${misfit_libraries} EXPORT misfitTargets DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT misfitTargets NAMESPACE misfit:: DESTINATION ${misfit_cmake_dir})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/misfit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.h)
install(FILES ${PROJECT_SOURCE_DIR}/apps/command_line.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/misfit/apps)
install(FILES ${PROJECT_BINARY_DIR}/include/misfit_models_registry.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/misfitConfig.cmake @ONLY CONTENT [[
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4)
find_dependency(Ceres 2.1)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(tomlplusplus)
find_dependency(CLI11)
find_dependency(Boost 1.74 COMPONENTS iostreams filesystem system)
include(${CMAKE_CURRENT_LIST_DIR}/misfitTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/misfit_add_effects.cmake)
]])
write_basic_package_version_file(${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/misfitConfig.cmake ${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/models/misfit_add_effects.cmake DESTINATION ${misfit_cmake_dir})

# misfit_debian_packages(RESULT PATTERN): names in packages.txt whose line matches, joined as Debian wants them.
function(misfit_debian_packages result pattern)
  file(STRINGS ${PROJECT_SOURCE_DIR}/packages.txt lines REGEX "^[^#].*")
  list(FILTER lines INCLUDE REGEX ${pattern})
  list(TRANSFORM lines REPLACE " .*" "")
  list(JOIN lines ", " joined)
  set(${result} "${joined}" PARENT_SCOPE)
endfunction()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the misfit developers")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
misfit_debian_packages(CPACK_DEBIAN_PACKAGE_DEPENDS "# runtime$")
misfit_debian_packages(CPACK_DEBIAN_PACKAGE_RECOMMENDS "-bin # recommended$")  # mpirun brings the library of misfit_mpi.so
misfit_debian_packages(CPACK_DEBIAN_PACKAGE_SUGGESTS "-dev$")  # for programs that find_package(misfit)
include(CPack)
