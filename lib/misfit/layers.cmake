# misfit_layer(NAME [APART files…] LINKS layers and packages… [PRIVATE packages…]): one folder of lib/misfit = one static library misfit_NAME; a folder
# inside a folder is a layer of its own: NAME = fit/filter, library misfit_fit_filter.
# APART: these of its files are never compiled together with others (misfit_join_files), since they use the same names for parts that do the same.
# A folder of headers alone becomes an interface library, whose PRIVATE packages are left out.
add_library(misfit_options INTERFACE)
add_library(misfit::options ALIAS misfit_options)
target_compile_features(misfit_options INTERFACE cxx_std_20)
target_compile_options(misfit_options INTERFACE
  $<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wshadow>
  $<$<BOOL:${MISFIT_WERROR}>:$<BUILD_INTERFACE:-Werror>>
  # An index of either sign serves: g++'s -Wconversion says nothing of the sign, clang's would.
  $<$<CXX_COMPILER_ID:Clang>:$<BUILD_INTERFACE:-Wno-sign-conversion>>
  # With precompiled headers g++ 12 forgets which code is the standard library's, and shows what it wrongly sees in std::string concatenation
  # (gcc bugs 105651, 105329). Without them these warnings are on.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${MISFIT_PCH}>>:$<BUILD_INTERFACE:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds>>)
set_target_properties(misfit_options PROPERTIES EXPORT_NAME options)

# One set of precompiled headers for all layers: what most files include anyway. A file still includes what it uses (clang-tidy reads them without).
set(MISFIT_PCH_HEADERS <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <sstream> <string>
  <string_view> <unordered_map> <utility> <variant> <vector> <Eigen/Dense>)
if(MISFIT_PCH)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/misfit_pch.cpp CONTENT "// Only owns the precompiled headers of the layers.\n")
  add_library(misfit_pch OBJECT ${PROJECT_BINARY_DIR}/misfit_pch.cpp)
  target_link_libraries(misfit_pch PRIVATE misfit_options Eigen3::Eigen)
  target_precompile_headers(misfit_pch PRIVATE ${MISFIT_PCH_HEADERS})
endif()

# Lets a static library of this project use the precompiled headers, if they are on.
function(misfit_use_pch target)
  if(MISFIT_PCH)
    target_precompile_headers(${target} REUSE_FROM misfit_pch)
  endif()
endfunction()

# Lets g++ read the headers of sixteen files of this target at once, if that is on: half of the time of a first build goes into templates
# that every file instantiates anew. So names in anonymous namespaces are to be unique within a layer.
function(misfit_join_files target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${MISFIT_UNITY} UNITY_BUILD_BATCH_SIZE 16)
endfunction()

set(MISFIT_LAYERS "" CACHE INTERNAL "")
function(misfit_layer folder)
  cmake_parse_arguments(arg "" "" "APART;LINKS;PRIVATE" ${ARGN})
  string(REPLACE / _ name ${folder})
  set(links misfit_options)
  foreach(item IN LISTS arg_LINKS)
    string(REPLACE / _ layer ${item})
    if(TARGET misfit_${layer})
      list(APPEND links misfit_${layer})
    else()
      list(APPEND links ${item})
    endif()
  endforeach()

  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/misfit/${folder}/*.cpp)
  if(sources)
    set(scope PUBLIC)
    add_library(misfit_${name} STATIC ${sources})
    target_link_libraries(misfit_${name} PRIVATE ${arg_PRIVATE})
    misfit_use_pch(misfit_${name})
    misfit_join_files(misfit_${name})
    list(TRANSFORM arg_APART PREPEND ${PROJECT_SOURCE_DIR}/lib/misfit/${folder}/)
    set_source_files_properties(${arg_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  else()
    set(scope INTERFACE)
    add_library(misfit_${name} INTERFACE)
  endif()
  add_library(misfit::${name} ALIAS misfit_${name})
  target_link_libraries(misfit_${name} ${scope} ${links})
  target_include_directories(misfit_${name} ${scope}
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/lib> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_target_properties(misfit_${name} PROPERTIES EXPORT_NAME ${name})
  set(MISFIT_LAYERS "${MISFIT_LAYERS};${name}" CACHE INTERNAL "")
endfunction()
