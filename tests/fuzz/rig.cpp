// Any bytes as a rig, selected by their first byte: the output of the reader's process (p), glTF as text (g) and as .glb (b). The result is
// a rig whose skeleton, surface and poses are finite and whose weights sum to one, or an InputError.
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/gltf_rig.hpp"
#include "pbs/rig/rig_bytes.hpp"
#include "pbs/rig/rig_motion.hpp"
#include "pbs/rig/rig_pose.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

void expect(bool sound)
{
    if (!sound) std::abort();
}

std::string written(const std::string& name, const std::string& bytes)
{
    static const test_support::ScratchFolder folder;
    return folder.file(name, bytes);
}

pbs::Rig rig_of(char kind, const std::string& bytes)
{
    if (kind == 'p') return pbs::unpacked_rig(bytes, "rig.glb");
    // What the child process reads crosses to its parent as bytes, which are checked again.
    return pbs::unpacked_rig(pbs::packed(pbs::read_gltf_rig(written(kind == 'g' ? "fuzz.gltf" : "fuzz.glb", bytes))), "rig.glb");
}

void use(const pbs::Rig& rig)
{
    if (rig.meshes.empty()) return;
    const pbs::RigAnimation* animation = pbs::find_animation(rig, "");
    const pbs::RiggedBody body = pbs::make_rigged_body(rig, animation, 1.0);
    expect(body.surface.allFinite());
    for (int point = 0; point < body.skin.vertices(); ++point) {
        double sum = 0.0;
        for (int entry = body.skin.first[point]; entry < body.skin.first[point + 1]; ++entry) sum += body.skin.weight[entry];
        expect(std::abs(sum - 1.0) < 1e-6);
    }
    for (const pbs::Bone& bone : body.skeleton.bones) expect(bone.head.allFinite() && bone.tail.allFinite());
    const auto nodes = pbs::node_transforms(rig, animation, animation ? animation->end_s : 0.0);
    for (const Eigen::Isometry3d& bone : pbs::rigid_pose(body, nodes)) expect(bone.matrix().allFinite());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size == 0) return 0;
    try {
        use(rig_of(static_cast<char>(data[0]), std::string(reinterpret_cast<const char*>(data) + 1, size - 1)));
    } catch (const pbs::InputError&) {
    }
    return 0;
}
