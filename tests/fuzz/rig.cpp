// Any bytes as a rig, selected by their first byte: glTF as text (g) or as .glb. The result is a rig whose skeleton,
// surface and poses are finite and whose weights sum to one, or an InputError.
#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "tests/fuzz/sound_rig.hpp"

void fuzz::try_input(const std::string& bytes)
{
    if (bytes.empty()) return;
    expect_sound(
        pbs::checked(pbs::read_gltf_rig(written(bytes[0] == 'g' ? "fuzz.gltf" : "fuzz.glb", bytes.substr(1)))));
}
