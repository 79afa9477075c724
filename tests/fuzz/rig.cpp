// Any bytes as a rig, selected by their first byte: glTF as text (g) or as .glb. The result is a rig whose skeleton, surface and poses are
// finite and whose weights sum to one, or an InputError.
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/gltf_rig.hpp"
#include "pbs/rig/rig_reader.hpp"
#include "tests/fuzz/sound_rig.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace {

std::string written(const std::string& name, const std::string& bytes)
{
    static const test_support::ScratchFolder folder;
    return folder.file(name, bytes);
}

pbs::Rig rig_of(char kind, const std::string& bytes)
{
    return pbs::checked(pbs::read_gltf_rig(written(kind == 'g' ? "fuzz.gltf" : "fuzz.glb", bytes)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size == 0) return 0;
    try {
        fuzz::expect_sound(rig_of(static_cast<char>(data[0]), std::string(reinterpret_cast<const char*>(data) + 1, size - 1)));
    } catch (const pbs::InputError&) {
    }
    return 0;
}
