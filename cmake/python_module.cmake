# The Python module mcdem in <build>/python, if pybind11 and Python's headers are installed (MCDEM_PYTHON).
# Debian's pybind11 and NumPy belong to Debian's Python, even if another one is first in PATH.
if(NOT DEFINED Python3_EXECUTABLE AND EXISTS /etc/debian_version AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_NOPYTHON ON)
find_package(pybind11 2.10 CONFIG QUIET)
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
# Python is built without sanitizers and cannot load modules built with them.
if(pybind11_FOUND AND Python3_Development.Module_FOUND AND NOT MCDEM_SANITIZE AND NOT MCDEM_FUZZ)
  set(can_build ON)
else()
  set(can_build OFF)
endif()
# Without -DMCDEM_PYTHON=.. not stored in the cache: the module is also built if its packages are installed later.
if(NOT DEFINED MCDEM_PYTHON)
  set(MCDEM_PYTHON ${can_build})
endif()
if(NOT MCDEM_PYTHON)
  return()
endif()
if(NOT can_build)
  message(FATAL_ERROR "MCDEM_PYTHON needs pybind11 2.10 and Python's headers (Debian: pybind11-dev, python3-dev)")
endif()

file(GLOB sources CONFIGURE_DEPENDS host/python/*.cpp)
Python3_add_library(mcdem_python MODULE WITH_SOABI ${sources})
target_link_libraries(mcdem_python PRIVATE mcdem_version mcdem_ensemble
  pybind11::headers)
set_target_properties(mcdem_python PROPERTIES OUTPUT_NAME _engine CXX_VISIBILITY_PRESET hidden
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/python/mcdem)
file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/host/python
  host/python/mcdem/*.py host/python/mcdem/*.pyi host/python/mcdem/py.typed
  host/python/mcdem/*.js host/python/mcdem/*.css host/python/mcdem/*.jinja host/python/mcdem/commands/commands.txt
  host/python/mcdem/commands/completion.*)
foreach(file ${files})
  configure_file(host/python/${file} ${CMAKE_BINARY_DIR}/python/${file} COPYONLY)
endforeach()
# Compiled once: commands run without writing bytecode (python3 -B), and would compile the package each time.
execute_process(COMMAND ${Python3_EXECUTABLE} -m compileall -q --invalidation-mode checked-hash ${CMAKE_BINARY_DIR}/python/mcdem)
