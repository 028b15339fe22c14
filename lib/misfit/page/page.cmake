# The page of `misfit open` and of report.html, and uPlot, which it draws with, compiled into misfit_page.
file(GLOB misfit_page_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/misfit/page/web/*)
set(misfit_uplot ${PROJECT_SOURCE_DIR}/lib/misfit/page/uplot)
set(misfit_embed ${PROJECT_SOURCE_DIR}/lib/misfit/page/embed.cmake)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/misfit_page.cpp
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${PROJECT_SOURCE_DIR}/lib/misfit/page/web -DUPLOT=${misfit_uplot}
    -DOUT=${PROJECT_BINARY_DIR}/misfit_page.cpp -P ${misfit_embed}
  DEPENDS ${misfit_page_files} ${misfit_embed} ${misfit_uplot}/uPlot.esm.js ${misfit_uplot}/uPlot.min.css VERBATIM)
target_sources(misfit_page PRIVATE ${PROJECT_BINARY_DIR}/misfit_page.cpp)
# The page is a string of hundreds of kilobytes; clang warns of more than the 65536 characters that a compiler must take.
set_source_files_properties(${PROJECT_BINARY_DIR}/misfit_page.cpp PROPERTIES COMPILE_OPTIONS -Wno-overlength-strings)
