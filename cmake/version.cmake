# version_library(NAME): a library with mcdem::version_text, "0.1.0 (commit)", up to date at every build.
function(version_library name)
  set(output ${CMAKE_BINARY_DIR}/version.cpp)
  add_custom_target(${name}_source BYPRODUCTS ${output}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_SOURCE_DIR} -DVERSION=${PROJECT_VERSION} -DOUTPUT=${output}
      -P ${CMAKE_SOURCE_DIR}/cmake/write_version.cmake VERBATIM)
  add_library(${name} STATIC ${output})
  add_dependencies(${name} ${name}_source)
endfunction()
