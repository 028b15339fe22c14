# Included after the layer `core`: a target that writes misfit_commit.h at every build, when its content changed. Run as a script (cmake -P) by it.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(misfit_commit_dir ${CMAKE_BINARY_DIR}/generated)
  add_custom_target(misfit_commit
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUTPUT=${misfit_commit_dir}/misfit_commit.h -DVERSION=${PROJECT_VERSION}
      -P ${CMAKE_CURRENT_LIST_DIR}/commit.cmake
    BYPRODUCTS ${misfit_commit_dir}/misfit_commit.h
    COMMENT "Reading the commit" VERBATIM)
  add_dependencies(misfit_core misfit_commit)
  target_include_directories(misfit_core PRIVATE ${misfit_commit_dir})
  return()
endif()

# The repository must be the source folder itself: a tarball unpacked inside another repository has no commit.
set(commit "unknown")
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short=10 HEAD
    OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed STREQUAL "0")
    set(commit ${head})
    execute_process(COMMAND git --no-optional-locks -C ${SOURCE} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT changes STREQUAL "")
      string(APPEND commit "+")
    endif()
  endif()
endif()

set(text "#define MISFIT_VERSION \"${VERSION}\"\n#define MISFIT_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUTPUT} "${text}")
endif()
