// Any text as a scene: the result is a scene or an InputError.
#include "experiments/settings/scene_values.hpp"
#include "tests/fuzz/fuzzed_schema.hpp"
#include "tests/fuzz/target.hpp"

void fuzz::try_input(const std::string& text)
{
    experiments::SceneValues(text, "scene.toml", {}, fuzzed_schema()).resolved();
}
