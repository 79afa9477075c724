// Any bytes as FBX, or as COLLADA, which assimp reads in a child process. The result is a rig whose skeleton, surface
// and poses are finite and whose weights sum to one, or an InputError. A breakdown of assimp itself is counted, since
// the child contains it for users too; one of the project's conversion is a finding.
#include "experiments/meshes/content_format.hpp"
#include "experiments/rigs/collada_document.hpp"
#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "tests/fuzz/library_child.hpp"
#include "tests/fuzz/sound_rig.hpp"
#include "tests/fuzz/token_mutator.hpp"

#include <assimp/Importer.hpp>

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
    return fuzz::mutated_tokens(data, size, most, seed, 0);
}

void fuzz::try_input(const std::string& bytes)
{
    const std::string path = written("fuzz.bin", bytes), extension = pbs::content_extension(path);
    if (extension != ".fbx" && extension != ".dae" && extension != ".zae") return;
    if (extension == ".fbx") return expect_sound(pbs::checked(pbs::read_fbx_rig(path)));
    const pbs::ColladaDocument document = pbs::read_collada_document(path);
    const LibraryChild child([&](LibraryChild::Parent& parent) {
        Assimp::Importer importer;
        const aiScene& scene = pbs::read_assimp_scene(importer, path, document.text);
        parent.library_is_done();
        expect_sound(pbs::checked(pbs::rig_of_scene(scene, path)));
    });
    expect(!child.broke_down_after_library());
    if (child.broke_down_in_library()) keep_breakdown(bytes);
}
