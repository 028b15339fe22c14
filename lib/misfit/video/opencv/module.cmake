# misfit_video_opencv.so: the only thing that is linked to OpenCV, loaded when a video or an image is read: linked to the
# program it would cost 0.2 s at every start. OpenCV's own package file wants every one of its modules to be installed; these five are all that
# is needed.
find_path(OPENCV_INCLUDE opencv2/videoio.hpp PATH_SUFFIXES opencv4 REQUIRED)
set(misfit_opencv "")
foreach(component videoio imgcodecs calib3d imgproc core)
  find_library(OPENCV_${component} opencv_${component} REQUIRED)
  list(APPEND misfit_opencv ${OPENCV_${component}})
endforeach()

add_library(misfit_video_opencv MODULE ${PROJECT_SOURCE_DIR}/lib/misfit/video/opencv/module.cpp
  ${PROJECT_SOURCE_DIR}/lib/misfit/video/opencv/patterns.cpp)
target_include_directories(misfit_video_opencv PRIVATE ${PROJECT_SOURCE_DIR}/lib)
target_include_directories(misfit_video_opencv SYSTEM PRIVATE ${OPENCV_INCLUDE})
target_link_libraries(misfit_video_opencv PRIVATE misfit_options ${misfit_opencv})
set_target_properties(misfit_video_opencv PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
add_dependencies(misfit misfit_video_opencv)

# Programs of other projects look for it by the run path that misfit::video gives them, wherever misfit was installed.
install(TARGETS misfit_video_opencv DESTINATION ${CMAKE_INSTALL_LIBDIR}/misfit COMPONENT program)
target_link_options(misfit_video INTERFACE "$<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CMAKE_INSTALL_LIBDIR}/misfit>")
