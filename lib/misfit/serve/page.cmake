# The page of `misfit open`, and uPlot, which it draws with, compiled into misfit_serve.
file(GLOB misfit_page CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/lib/misfit/serve/page/*)
set(misfit_uplot ${PROJECT_SOURCE_DIR}/lib/misfit/serve/uplot)
set(misfit_embed ${PROJECT_SOURCE_DIR}/lib/misfit/serve/embed.cmake)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/misfit_page.cpp
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${PROJECT_SOURCE_DIR}/lib/misfit/serve/page -DUPLOT=${misfit_uplot}
    -DOUT=${PROJECT_BINARY_DIR}/misfit_page.cpp -P ${misfit_embed}
  DEPENDS ${misfit_page} ${misfit_embed} ${misfit_uplot}/uPlot.esm.js ${misfit_uplot}/uPlot.min.css VERBATIM)
target_sources(misfit_serve PRIVATE ${PROJECT_BINARY_DIR}/misfit_page.cpp)
# Debian's package says how it was compiled; classes of its header depend on it.
target_compile_definitions(misfit_serve PRIVATE CPPHTTPLIB_OPENSSL_SUPPORT CPPHTTPLIB_ZLIB_SUPPORT CPPHTTPLIB_BROTLI_SUPPORT)
