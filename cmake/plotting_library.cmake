# The plotting library of reports: plotly.js from Debian's python3-plotly, compressed, in share/mcdem of the build folder
# and of the installation. The program reads it from there when it writes a page.
find_file(PLOTLY_JS NAMES plotly.min.js plotly.js
  PATHS /usr/share/python3-plotly /usr/lib/python3/dist-packages/plotly/package_data NO_DEFAULT_PATH)
set(PACKED_PLOTLY_JS ${CMAKE_BINARY_DIR}/share/mcdem/plotly.js.gz)
find_program(GZIP gzip REQUIRED)
if(PLOTLY_JS)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/mcdem)
  add_custom_command(OUTPUT ${PACKED_PLOTLY_JS}
    COMMAND ${GZIP} -9 -n -c ${PLOTLY_JS} > ${PACKED_PLOTLY_JS}
    DEPENDS ${PLOTLY_JS})
  add_custom_target(plotting_library ALL DEPENDS ${PACKED_PLOTLY_JS})
  install(FILES ${PACKED_PLOTLY_JS} DESTINATION ${CMAKE_INSTALL_DATADIR}/mcdem COMPONENT program)
else()
  message(WARNING "plotly.js is not there, so `mcdem report` will make no pages: install python3-plotly")
  add_custom_target(plotting_library)
endif()
