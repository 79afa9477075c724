// Any text as a skeleton: bones whose parents precede them, or an InputError.
#include "pbs/character/skeleton_file.hpp"
#include "pbs/geometry/input_error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const pbs::Skeleton skeleton = pbs::parse_skeleton(std::string(reinterpret_cast<const char*>(data), size), "skeleton.toml");
        for (int bone = 0; bone < static_cast<int>(skeleton.bones.size()); ++bone)
            if (skeleton.bones[bone].parent >= bone || skeleton.bones[bone].head == skeleton.bones[bone].tail) std::abort();
    } catch (const pbs::InputError&) {
    }
    return 0;
}
