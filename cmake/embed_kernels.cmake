# embed_kernels(FOLDER OUTPUT): a C++ source with every .cl and .h of FOLDER as text, so that the
# program carries its kernels. Regenerated when a kernel changes.
function(embed_kernels folder output)
  file(GLOB kernels CONFIGURE_DEPENDS ${folder}/*.cl ${folder}/*.h)
  list(SORT kernels)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} "-DKERNELS=${kernels}" -P ${CMAKE_SOURCE_DIR}/cmake/write_kernel_sources.cmake
    DEPENDS ${kernels} ${CMAKE_SOURCE_DIR}/cmake/write_kernel_sources.cmake
    VERBATIM)
endfunction()
