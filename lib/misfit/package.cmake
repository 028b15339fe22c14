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

# Two packages: the program with its manual and studies to run, and what programs of others are built with.
install(TARGETS misfit DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(DIRECTORY ${misfit_manual_dir}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES ${misfit_manual_dir}/bash-completion/misfit DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/CITATION.cff
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT program
  PATTERN out EXCLUDE PATTERN batch EXCLUDE PATTERN .gitignore EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT source)  # the packages have it in `copyright`
install(TARGETS ${misfit_libraries} EXPORT misfitTargets DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT misfitTargets NAMESPACE misfit:: DESTINATION ${misfit_cmake_dir} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/misfit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev FILES_MATCHING PATTERN *.h)
install(FILES ${PROJECT_SOURCE_DIR}/apps/command_line.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/misfit/apps COMPONENT dev)
install(FILES ${PROJECT_BINARY_DIR}/include/misfit_models_registry.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(FILES ${PROJECT_SOURCE_DIR}/tests/package/identify.cpp ${PROJECT_SOURCE_DIR}/tests/package/CMakeLists.txt
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libmisfit-dev/examples COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/package/effects DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libmisfit-dev/examples COMPONENT dev)

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/misfitConfig.cmake @ONLY CONTENT [[
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(Eigen3 3.4)
find_dependency(Ceres 2.1)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(tomlplusplus)
find_dependency(CLI11)
find_dependency(ZLIB)
find_dependency(Boost 1.74 COMPONENTS iostreams filesystem system)
include(${CMAKE_CURRENT_LIST_DIR}/misfitTargets.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/misfit_add_effects.cmake)
]])
write_basic_package_version_file(${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/misfitConfig.cmake ${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/models/misfit_add_effects.cmake DESTINATION ${misfit_cmake_dir} COMPONENT dev)

# What Debian wants of every package.
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/lib/misfit/package/changelog OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz
  COMMAND_ERROR_IS_FATAL ANY)
foreach(package program=misfit dev=libmisfit-dev)
  string(REGEX MATCH "^[^=]+" component ${package})
  string(REGEX MATCH "[^=]+$" name ${package})
  install(FILES ${PROJECT_SOURCE_DIR}/lib/misfit/package/copyright ${PROJECT_BINARY_DIR}/changelog.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component})
endforeach()

# misfit_debian_packages(RESULT PATTERN): names in packages.txt whose line matches, joined as Debian wants them.
function(misfit_debian_packages result pattern)
  file(STRINGS ${PROJECT_SOURCE_DIR}/packages.txt lines REGEX "^[^#].*")
  list(FILTER lines INCLUDE REGEX ${pattern})
  list(TRANSFORM lines REPLACE " .*" "")
  list(JOIN lines ", " joined)
  set(${result} "${joined}" PARENT_SCOPE)
endfunction()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "grey-box system identification: find out what your model is missing")
set(CPACK_PACKAGE_CONTACT "the misfit developers <misfit@localhost>")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME misfit)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "misfit fits a model made of named physical effects to recordings, shows
where it fails, ranks the effects that it may be missing, adds them and
fits again. No number without its unit and uncertainty. Studies to run are
in /usr/share/doc/misfit/examples.")
misfit_debian_packages(misfit_runtime "# runtime$")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libc6 (>= 2.36), libgcc-s1, libstdc++6 (>= 12), ${misfit_runtime}")
misfit_debian_packages(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "-bin # recommended$")  # mpirun brings the library of misfit_mpi.so

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libmisfit-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEV_DESCRIPTION "Libraries and headers: for C++ programs that fit models and search for
missing effects with misfit, and for effects of one's own. Static
libraries, headers, find_package(misfit) and an example.")
misfit_debian_packages(misfit_headers "-dev$")
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "misfit (= ${PROJECT_VERSION}), ${misfit_headers}")  # it has the modules for video and MPI
include(CPack)
