# What the project needs. expect_all_found() names everything that is missing at once, with its packages (scripts/packages.txt).
# expect_found(VARIABLE NAME PACKAGE): unless the variable is true, NAME is missing, of the Debian package PACKAGE.
macro(expect_found variable name package)
  if(NOT ${variable})
    list(APPEND missing_libraries "${name}")
    list(APPEND missing_packages ${package})
  endif()
endmacro()

# needed(NAME PACKAGE [OPTION..]): find_package(NAME OPTION..).
macro(needed name package)
  find_package(${name} QUIET ${ARGN})
  expect_found(${name}_FOUND ${name} ${package})
endmacro()

function(expect_all_found)
  if(NOT missing_libraries)
    return()
  endif()
  file(STRINGS ${CMAKE_SOURCE_DIR}/scripts/packages.txt rows REGEX "^[a-z0-9.+-]+ +[a-z]")
  foreach(row ${rows})
    string(REGEX REPLACE " +" ";" names "${row}")
    list(POP_FRONT names debian fedora conda)
    if(debian IN_LIST missing_packages)
      string(APPEND debian_packages " ${debian}")
      string(APPEND fedora_packages " ${fedora}")
      string(APPEND conda_packages " ${conda}")
    endif()
  endforeach()
  list(JOIN missing_libraries ", " libraries)
  if(MCDEM_TESTS)
    set(without_tests "\n  Only the tests need GTest; -DMCDEM_TESTS=OFF builds without them.")
  endif()
  message(FATAL_ERROR "Not found: ${libraries}. Their packages:\n"
    "  Debian, Ubuntu: sudo apt-get install${debian_packages}\n"
    "  Fedora: sudo dnf install${fedora_packages}\n"
    "  conda: conda install -c conda-forge${conda_packages}\n"
    "  Libraries in a folder of your own: -DCMAKE_PREFIX_PATH=FOLDER (host/README.md).${without_tests}")
endfunction()
