# embed_texts(OUTPUT HEADER FUNCTION FILES..): generates a C++ source that defines mcdem::FUNCTION(), declared in HEADER.
# It returns the embedded texts of the files by name. The source is generated again when a file changes.
function(embed_texts output header function)
  list(SORT ARGN)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DHEADER=${header} -DFUNCTION=${function} "-DFILES=${ARGN}"
      -P ${CMAKE_SOURCE_DIR}/cmake/write_embedded_texts.cmake
    DEPENDS ${ARGN} ${CMAKE_SOURCE_DIR}/cmake/write_embedded_texts.cmake
    VERBATIM)
endfunction()
