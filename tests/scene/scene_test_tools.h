// Shared by the tests of scenes.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/errors.h"
#include "core/test_folder.h"
#include "scene/read/read_scene.h"

namespace mcdem {

/// The problems that `action` reports; fails the test if there are none.
template <class Action>
std::vector<std::string> problems_of(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.problems();
    }
    ADD_FAILURE() << "no problem was reported";
    return {};
}

/// The problems of a scene's text.
inline std::vector<std::string> problems_in(const std::string& text,
                                            const std::vector<std::string>& overrides = {}) {
    return problems_of([&] { parse_scene(text, "bad.toml", overrides); });
}

}  // namespace mcdem
