#include "experiments/rigs/rig_reader.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/guarded_reading.hpp"
#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/rigs/rig_formats.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace pbs {
namespace {

constexpr double farthest = 1e9;  // [file's units]
// Weights of 8 bits, four per point, sum to one within 4/255 at worst and 1e-3 where they are rounded well.
constexpr double sum_tolerance = 1e-3;
constexpr double negative_rounding = 1e-3;  // of exporters: a weight between it and 0 is 0

template <typename Numbers>
bool bounded(const Numbers& numbers)
{
    return (numbers.array().abs() <= farthest).all();  // false for what is not a number
}

bool is_index(int index, std::size_t count)
{
    return index >= 0 && index < static_cast<int>(count);
}

bool is_sound(const NodeTransform& rest)
{
    return bounded(rest.translation) && bounded(rest.rotation.coeffs()) && rest.rotation.norm() > 0.0 &&
           bounded(rest.scale) && (!rest.matrix || bounded(rest.matrix->matrix()));
}

bool is_sound(const Weights& skin, Eigen::Index points, std::size_t joints)
{
    return skin.vertices() == points && skin.first.front() == 0 &&
           std::is_sorted(skin.first.begin(), skin.first.end()) &&
           skin.first.back() == static_cast<int>(skin.bone.size()) && skin.weight.size() == skin.bone.size() &&
           std::ranges::all_of(skin.bone, [&](int joint) { return is_index(joint, joints); }) &&
           std::ranges::all_of(skin.weight, [](double weight) { return weight >= 0.0 && weight <= 1.0 + 1e-9; });
}

bool is_sound(const RigMesh& mesh, std::size_t nodes)
{
    const auto points = static_cast<std::size_t>(mesh.points.rows());
    return is_index(mesh.node, nodes) &&
           std::ranges::all_of(mesh.triangles.reshaped(), [&](int corner) { return is_index(corner, points); }) &&
           mesh.look.numbers.rows() <= mesh.points.rows() &&
           mesh.look.material.size() <= static_cast<std::size_t>(mesh.triangles.rows()) &&
           std::ranges::all_of(mesh.joints,
                               [&](const SkinJoint& joint) {
                                   return is_index(joint.node, nodes) && bounded(joint.inverse_bind.matrix());
                               }) &&
           (mesh.dual_quaternion_share.empty() || mesh.dual_quaternion_share.size() == points) &&
           (mesh.joints.empty() || is_sound(mesh.skin, mesh.points.rows(), mesh.joints.size()));
}

bool is_sound(const std::optional<KeyTrack>& track)
{
    if (!track) return true;
    const auto& times = track->times_s;
    const std::size_t per_key = track->interpolation == Interpolation::cubic_spline ? 3 : 1;
    return !times.empty() && std::is_sorted(times.begin(), times.end()) && std::isfinite(times.front()) &&
           std::isfinite(times.back()) && track->values.size() == per_key * times.size() &&
           std::ranges::all_of(track->values, [](const Eigen::Vector4d& value) { return bounded(value); });
}

bool is_sound(const std::optional<FbxTransform>& node)
{
    return !node || (std::ranges::all_of(node->lcl, bounded<Vec3>) && bounded(node->rotation_offset) &&
                     bounded(node->rotation_pivot) && bounded(node->scaling_offset) && bounded(node->scaling_pivot) &&
                     bounded(node->pre_rotation_deg) && bounded(node->post_rotation_deg));
}

bool is_sound(const std::optional<FbxCurve>& curve)
{
    return !curve || (!curve->empty() && std::ranges::is_sorted(*curve, {}, &FbxKey::time_s) &&
                      std::ranges::all_of(*curve, [](const FbxKey& key) {
                          return std::isfinite(key.time_s) && std::abs(key.value) <= farthest &&
                                 std::isfinite(key.slope) && std::isfinite(key.next_slope);
                      }));
}

bool is_sound(const FbxTracks& tracks)
{
    return std::ranges::all_of(tracks, [](const auto& axes) {
        return std::ranges::all_of(axes, [](const auto& curve) { return is_sound(curve); });
    });
}

bool is_sound(const RigAnimation& animation, std::size_t nodes)
{
    return std::isfinite(animation.start_s) && std::isfinite(animation.end_s) && animation.start_s <= animation.end_s &&
           std::ranges::all_of(animation.nodes, [&](const NodeTracks& tracks) {
               return is_index(tracks.node, nodes) && is_sound(tracks.translation) && is_sound(tracks.rotation) &&
                      is_sound(tracks.scale) && is_sound(tracks.fbx);
           });
}

// One share per joint.
std::vector<JointShare> merged(const std::vector<JointShare>& shares)
{
    std::vector<JointShare> merged;
    for (const JointShare& share : shares) {
        const auto same = std::ranges::find(merged, share.joint, &JointShare::joint);
        if (same == merged.end())
            merged.push_back(share);
        else
            same->weight += share.weight;
    }
    return merged;
}

// The first of equal names stays, the others are "NAME (2)", "NAME (3)", ..., without a number that makes the name of
// another animation.
void tell_apart(std::vector<RigAnimation>& animations)
{
    std::set<std::string> names;
    std::map<std::string, int> last;  // number of each name
    for (const RigAnimation& animation : animations) names.insert(animation.name);
    for (RigAnimation& animation : animations) {
        const std::string name = animation.name;
        int& number = last[name];
        if (++number == 1) continue;
        while (!names.insert(name + " (" + std::to_string(number) + ")").second) ++number;
        animation.name = name + " (" + std::to_string(number) + ")";
    }
}

enum class RigFormat { none, gltf, fbx, collada };

RigFormat format_of(const std::string& path)
{
    const std::string extension = content_extension(path);
    if (extension == ".glb" || extension == ".gltf") return RigFormat::gltf;
    if (extension == ".fbx") return RigFormat::fbx;
    return extension == ".dae" || extension == ".zae" ? RigFormat::collada : RigFormat::none;
}

}  // namespace

bool is_rig_file(const std::string& path)
{
    return format_of(path) != RigFormat::none;
}

Rig read_any_rig(const std::string& path)
{
    const SourceFile file(path);
    require_readable(path, most_mesh_bytes);
    const RigFormat format = format_of(path);
    if (format == RigFormat::none)
        throw InputError(path, 0, "", "",
                         "no rig: expected glTF 2.0 (.glb, .gltf), FBX (.fbx) or COLLADA (.dae, .zae)");
    return checked(read_guarded(path, "rig",
                                format == RigFormat::gltf  ? read_gltf_rig
                                : format == RigFormat::fbx ? read_fbx_rig
                                                           : read_collada_rig));
}

Rig read_rig(const std::string& path)
{
    Rig rig = read_any_rig(path);
    leave_out_second_sides_and_unused_points(rig);
    if (rig.meshes.empty()) throw InputError(path, 0, "meshes", "0", "expected a mesh with triangles");
    for (const RigMesh& mesh : rig.meshes)
        if (const std::string remark = remark_on_single_precision(mesh.points, mesh.triangles); !remark.empty())
            rig.remarks.push_back("mesh " + mesh.name + ": " + remark);
    return rig;
}

RigMaterials read_materials(const std::string& path)
{
    RigMaterials materials;
    try {
        materials = read_guarded(path, "materials",
                                 format_of(path) == RigFormat::gltf ? read_gltf_materials : read_assimp_materials);
    } catch (const InputError& error) {  // a surface needs none
        materials.remarks = {error.what()};
    }
    for (std::string& remark : materials.remarks) remark = path + ": left out of the .glb files: " + remark;
    return materials;
}

bool rig_has_skin(const std::string& path)
{
    const Rig rig = read_any_rig(path);
    return std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return !mesh.joints.empty(); });
}

Rig checked(Rig rig)
{
    const auto require = [&](bool sound) {
        if (!sound) throw InputError(rig.file, 0, "", "", "damaged: the reader's answer is not a whole rig");
    };
    require(rig.unit_m > 0.0 && std::isfinite(rig.unit_m));
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) {
        RigNode& node = rig.nodes[n];
        require(node.parent >= -1 && node.parent < static_cast<int>(n) && is_sound(node.rest) && is_sound(node.fbx));
        node.rest.rotation.normalize();
    }
    for (const RigMesh& mesh : rig.meshes) {
        if (!bounded(mesh.points))
            throw InputError(rig.file, 0, "points of mesh " + mesh.name, "", "expected finite numbers of at most 1e9");
        require(is_sound(mesh, rig.nodes.size()));
    }
    for (const RigAnimation& animation : rig.animations) require(is_sound(animation, rig.nodes.size()));
    tell_apart(rig.animations);
    return rig;
}

Weights normalised_skin(const std::vector<std::vector<JointShare>>& points, const std::string& file,
                        const std::string& mesh, std::vector<std::string>& remarks, std::vector<std::string>& notes)
{
    Weights skin;
    skin.first.push_back(0);
    int without_weight = 0, other_sums = 0;
    double lowest = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        std::vector<JointShare> shares = merged(points[p]);
        double sum = 0.0;
        for (JointShare& share : shares) {
            if (share.weight < 0.0 && share.weight > -negative_rounding) {
                lowest = std::min(lowest, share.weight);
                share.weight = 0.0;
            }
            if (!(share.weight >= 0.0 && std::isfinite(share.weight)))
                throw InputError(file, 0, "mesh " + mesh + ", weight of point " + std::to_string(p),
                                 number_text(share.weight), "expected a finite number of 0 or more");
            sum += share.weight;
        }
        if (!(sum > 0.0)) {
            ++without_weight;
            skin.add(0, 1.0);
        } else {
            other_sums += std::abs(sum - 1.0) > sum_tolerance;
            for (const JointShare& share : shares)
                if (share.weight != 0.0) skin.add(share.joint, share.weight / sum);
        }
        skin.end_vertex();
    }
    if (without_weight > 0 && without_weight == static_cast<int>(points.size()))
        throw InputError(file, 0, "mesh " + mesh + ", weights", "0",
                         "expected a point with a weight: the mesh has a skin");
    const std::string of_mesh = " of the " + std::to_string(points.size()) + " points of mesh " + mesh;
    if (without_weight > 0)
        remarks.push_back(std::to_string(without_weight) + of_mesh +
                          " have no weight; they follow the first joint of the skin");
    if (lowest < 0.0)
        notes.push_back("negative weights of mesh " + mesh + ", down to " + number_text(lowest, 2) +
                        ", are taken as 0, as a rounding");
    if (other_sums > 0)
        notes.push_back("the weights of " + std::to_string(other_sums) + of_mesh +
                        " do not sum to one; they were divided by their sum");
    return skin;
}

}  // namespace pbs
