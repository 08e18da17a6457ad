// Headers that nearly every test of kernels and simulation includes, precompiled (tests/CMakeLists.txt).
#include "../precompiled.h"
#include "reference/test_scene.h"
