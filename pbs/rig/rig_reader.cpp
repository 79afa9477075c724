#include "pbs/rig/rig_reader.hpp"

#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/rig/assimp_rig.hpp"
#include "pbs/rig/gltf_rig.hpp"
#include "pbs/rig/rig_bytes.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

enum class RigFormat { none, gltf, fbx, collada };

RigFormat format_of(const std::string& path)
{
    const std::string extension = content_extension(path);
    if (extension == ".glb" || extension == ".gltf") return RigFormat::gltf;
    if (extension == ".fbx") return RigFormat::fbx;
    return extension == ".dae" || extension == ".zae" ? RigFormat::collada : RigFormat::none;
}

// With or without a mesh.
Rig read_any_rig(const std::string& path)
{
    require_readable(path, most_mesh_bytes);
    const RigFormat format = format_of(path);
    if (format == RigFormat::none)
        throw InputError(path, 0, "", "", "no rig: expected glTF 2.0 (.glb, .gltf), FBX (.fbx) or COLLADA (.dae, .zae)");
    const auto read = [&](const std::string& file) {
        return packed(format == RigFormat::gltf ? read_gltf_rig(file) : read_assimp_rig(file));
    };
    return unpacked_rig(read_isolated(path, read), path);
}

}  // namespace

bool is_rig_file(const std::string& path)
{
    return format_of(path) != RigFormat::none;
}

Rig read_rig(const std::string& path)
{
    Rig rig = read_any_rig(path);
    if (rig.meshes.empty()) throw InputError(path, 0, "meshes", "0", "expected a mesh with triangles");
    return rig;
}

bool rig_has_skin(const std::string& path)
{
    const Rig rig = read_any_rig(path);
    return std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return !mesh.joints.empty(); });
}

namespace {

constexpr double sum_tolerance =
    1e-3;  // weights of 8 bits, four per point, sum to one within 4/255 at worst and 1e-3 where they are rounded well

}  // namespace

void SkinWeights::add_point(const std::vector<JointShare>& shares)
{
    std::vector<JointShare> merged;
    for (const JointShare& share : shares) {
        const auto same = std::find_if(merged.begin(), merged.end(), [&](const JointShare& other) { return other.joint == share.joint; });
        if (same == merged.end())
            merged.push_back(share);
        else
            same->weight += share.weight;
    }
    points_.push_back(merged);
}

Weights SkinWeights::normalised(const std::string& file, const std::string& mesh, std::vector<std::string>& remarks) const
{
    Weights skin;
    skin.first.push_back(0);
    int without_weight = 0, other_sums = 0;
    for (std::size_t p = 0; p < points_.size(); ++p) {
        double sum = 0.0;
        for (const JointShare& share : points_[p]) {
            if (!(share.weight >= 0.0 && std::isfinite(share.weight)))
                throw InputError(file, 0, "mesh " + mesh + ", weight of point " + std::to_string(p), number_text(share.weight),
                                 "expected a finite number of 0 or more");
            sum += share.weight;
        }
        if (!(sum > 0.0)) {
            ++without_weight;
            skin.bone.push_back(0);
            skin.weight.push_back(1.0);
        } else {
            other_sums += std::abs(sum - 1.0) > sum_tolerance;
            for (const JointShare& share : points_[p]) {
                if (share.weight == 0.0) continue;
                skin.bone.push_back(share.joint);
                skin.weight.push_back(share.weight / sum);
            }
        }
        skin.first.push_back(static_cast<int>(skin.bone.size()));
    }
    if (without_weight > 0 && without_weight == static_cast<int>(points_.size()))
        throw InputError(file, 0, "mesh " + mesh + ", weights", "0", "expected a point with a weight: the mesh has a skin");
    const std::string of_mesh = " of the " + std::to_string(points_.size()) + " points of mesh " + mesh;
    if (without_weight > 0)
        remarks.push_back(std::to_string(without_weight) + of_mesh + " have no weight; they follow the first joint of the skin");
    if (other_sums > 0)
        remarks.push_back("the weights of " + std::to_string(other_sums) + of_mesh + " do not sum to one; they were divided by their sum");
    return skin;
}

}  // namespace pbs
