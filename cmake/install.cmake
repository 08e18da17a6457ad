# Rules for `cmake --install`, in three components: the program with its completions; the engine as a library
# for other programs (find_package(mcdem)); the Python module.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS mcdem RUNTIME COMPONENT program)

set(share ${CMAKE_INSTALL_DATAROOTDIR})
set(completion host/python/mcdem/commands/completion)
install(FILES ${completion}.bash DESTINATION ${share}/bash-completion/completions RENAME mcdem COMPONENT program)
install(FILES ${completion}.zsh DESTINATION ${share}/zsh/vendor-completions RENAME _mcdem COMPONENT program)
install(FILES ${completion}.fish DESTINATION ${share}/fish/vendor_completions.d RENAME mcdem.fish COMPONENT program)
if(NOT SKBUILD)
  install(DIRECTORY host/python/mcdem DESTINATION ${share}/mcdem/python COMPONENT program  # what commands run
    FILES_MATCHING PATTERN "*.py" PATTERN "*.js" PATTERN "*.css" PATTERN "*.jinja" PATTERN "commands.txt" PATTERN "completion.*"
    PATTERN __pycache__ EXCLUDE)
endif()
install(DIRECTORY scenes DESTINATION ${share}/mcdem COMPONENT program)

# The engine: all floors below the command line and the Python module.
set(floors core elasticity scene cl sim io ensemble)
add_library(mcdem_engine INTERFACE)
target_link_libraries(mcdem_engine INTERFACE mcdem_ensemble)
set_target_properties(mcdem_engine PROPERTIES EXPORT_NAME mcdem)
set(targets mcdem_engine mcdem_options mcdem_kernel_sources mcdem_version)
foreach(floor ${floors})
  set_target_properties(mcdem_${floor} PROPERTIES EXPORT_NAME ${floor})
  list(APPEND targets mcdem_${floor})
  install(DIRECTORY host/${floor} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mcdem COMPONENT development
    FILES_MATCHING PATTERN "*.h")
endforeach()
install(DIRECTORY kernels DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mcdem COMPONENT development
  FILES_MATCHING PATTERN "*.h")
install(TARGETS ${targets} EXPORT mcdemTargets COMPONENT development)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/mcdem)
install(EXPORT mcdemTargets NAMESPACE mcdem:: DESTINATION ${package} COMPONENT development)
configure_package_config_file(cmake/mcdemConfig.cmake.in ${CMAKE_BINARY_DIR}/mcdemConfig.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/mcdemConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/mcdemConfig.cmake ${CMAKE_BINARY_DIR}/mcdemConfigVersion.cmake
  DESTINATION ${package} COMPONENT development)

if(MCDEM_PYTHON)
  # The module folder of this Python below a prefix; Debian calls it dist-packages.
  if(NOT MCDEM_PYTHON_DIR)
    execute_process(COMMAND ${Python3_EXECUTABLE} -c "import site, sys; print('lib/python%d.%d/' % sys.version_info[:2] \
+ site.getsitepackages()[0].rsplit('/', 1)[1])" OUTPUT_VARIABLE site OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(MCDEM_PYTHON_DIR ${site} CACHE STRING "Folder of the Python module, below the prefix")
  endif()
  install(TARGETS mcdem_python LIBRARY DESTINATION ${MCDEM_PYTHON_DIR}/mcdem COMPONENT python)
  install(DIRECTORY host/python/mcdem DESTINATION ${MCDEM_PYTHON_DIR} COMPONENT python
    PATTERN __pycache__ EXCLUDE)
endif()
include(cmake/debian.cmake)
