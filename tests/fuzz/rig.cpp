// Any bytes as a rig, selected by their first byte: the output of the reader's process (p), glTF as text (g) and as .glb (b). The result is
// a rig whose skeleton, surface and poses are finite and whose weights sum to one, or an InputError.
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/gltf_rig.hpp"
#include "pbs/rig/rig_bytes.hpp"
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
    if (kind == 'p') return pbs::unpacked_rig(bytes, "rig.glb");
    // The child process sends its result to the parent as bytes, which are checked again.
    return pbs::unpacked_rig(pbs::packed(pbs::read_gltf_rig(written(kind == 'g' ? "fuzz.gltf" : "fuzz.glb", bytes))), "rig.glb");
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
