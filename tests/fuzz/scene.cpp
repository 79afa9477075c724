// Any text as a scene: the result is a scene or an InputError.
#include "experiments/settings/scene_values.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/fuzz/fuzzed_schema.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const experiments::SceneValues values(std::string(reinterpret_cast<const char*>(data), size), "scene.toml", {}, fuzzed_schema());
        values.resolved();
    } catch (const pbs::InputError&) {
    }
    return 0;
}
