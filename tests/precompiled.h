// What nearly every test includes, compiled once (tests/CMakeLists.txt).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/precompiled.h"
