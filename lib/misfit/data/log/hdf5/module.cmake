# misfit_hdf5: the only thing that is linked to HDF5, a program that is started when such a file is read: what the library does with a damaged
# one (it may crash, or run for ever) stays there, and misfit says so in words.
find_path(HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial REQUIRED)
find_library(HDF5_LIBRARY NAMES hdf5_serial hdf5 PATH_SUFFIXES hdf5/serial REQUIRED)
add_executable(misfit_hdf5 ${PROJECT_SOURCE_DIR}/lib/misfit/data/log/hdf5/misfit_hdf5.cpp)
target_include_directories(misfit_hdf5 SYSTEM PRIVATE ${HDF5_INCLUDE})
target_link_libraries(misfit_hdf5 PRIVATE misfit_options ${HDF5_LIBRARY})
set_target_properties(misfit_hdf5 PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
add_dependencies(misfit misfit_hdf5)
install(TARGETS misfit_hdf5 DESTINATION ${CMAKE_INSTALL_LIBDIR}/misfit COMPONENT program)
