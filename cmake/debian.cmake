# `cpack` in the build folder: Debian packages mcdem, libmcdem-dev and python3-mcdem for the system it runs on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mcdem)
set(CPACK_PACKAGE_CONTACT "mcdem developers <developers@mcdem.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "dense soft granular matter by the multi-contact discrete element method")
set(CPACK_PACKAGE_DESCRIPTION "Simulates dense packings of soft elastic grains whose contacts feel one another,
 on any OpenCL device, and diagnoses where simulation and experiment part.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
if(MCDEM_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME mcdem)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS
  "python3-mcdem, python3-h5py, python3-matplotlib, fonts-dejavu-core, python3-plotly, python3-jinja2, python3-pandas, \
python3-ase, python3-meshio")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libmcdem-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libboost-dev, libeigen3-dev, libfmt-dev, libhdf5-dev, \
libssl-dev, libtomlplusplus-dev, nlohmann-json3-dev, ocl-icd-opencl-dev, opencl-clhpp-headers, opencl-headers, \
zlib1g-dev")
math(EXPR next "${Python3_VERSION_MINOR} + 1")
set(next ${Python3_VERSION_MAJOR}.${next})  # an extension module suits one version
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-mcdem)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
  "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3 (<< ${next}), python3-numpy, python3-scipy, pocl-opencl-icd | opencl-icd")
include(CPack)
