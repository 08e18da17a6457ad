// Headers that nearly every test includes, precompiled (tests/CMakeLists.txt).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/precompiled.h"
