# embed_texts(OUTPUT HEADER FUNCTION FILES..): a C++ source that defines mcdem::FUNCTION(), which HEADER declares:
# the files' texts by their names, so that the program carries them. Made anew when a file changes.
function(embed_texts output header function)
  list(SORT ARGN)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${header} -DFUNCTION=${function} "-DFILES=${ARGN}"
      -P ${CMAKE_SOURCE_DIR}/cmake/write_embedded_texts.cmake
    DEPENDS ${ARGN} ${CMAKE_SOURCE_DIR}/cmake/write_embedded_texts.cmake
    VERBATIM)
endfunction()
