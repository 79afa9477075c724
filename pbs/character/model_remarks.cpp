#include "pbs/character/model_remarks.hpp"

#include "pbs/character/transferred_weights.hpp"
#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/name_list.hpp"
#include "pbs/geometry/number_text.hpp"
#include "pbs/geometry/topology.hpp"

namespace pbs {
namespace {

constexpr double smallest_m = 0.05, largest_m = 20.0;  // of a body whose unit is believed
constexpr double far_from_tets = 0.01;                 // over the diagonal of the body; the wrap alone takes up to 0.008
constexpr int samples_per_bone = 5;                    // on its middle, the part that Eq. 2 gives to it alone

void add_size(const RiggedBody& body, const std::string& file, std::vector<std::string>& remarks)
{
    const double size_m = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).maxCoeff();
    if (size_m >= smallest_m && size_m <= largest_m) return;
    remarks.push_back(file + ": unlikely units: the body's largest extent is " + number_text(size_m, 4) +
                      " m; --scale (character.scale in a scene) corrects it");
}

void add_sheet(const RiggedBody& body, const std::string& file, std::vector<std::string>& remarks)
{
    const double offset_m = sheet_offset_m({body.surface, body.triangles});
    if (offset_m > 0.0)
        remarks.push_back(file + ": the surface encloses no volume; the tets fill a layer of " + number_text(offset_m, 3) +
                          " m on both sides of it");
}

void add_bones_outside(const RiggedBody& body, const TetMesh& mesh, const std::string& file, std::vector<std::string>& remarks)
{
    std::vector<Vec3> samples;
    for (const Bone& bone : body.skeleton.bones)
        for (int s = 0; s < samples_per_bone; ++s)
            samples.emplace_back(bone.head + (1.0 / 6.0 + 4.0 / 6.0 * (s + 0.5) / samples_per_bone) * (bone.tail - bone.head));
    const std::vector<bool> inside = points_inside(mesh.rest, boundary_of(mesh.tets), samples);
    std::vector<std::string> outside;
    for (std::size_t b = 0; b < body.skeleton.bones.size(); ++b) {
        int count = 0;
        for (int s = 0; s < samples_per_bone; ++s) count += inside[b * samples_per_bone + static_cast<std::size_t>(s)];
        if (count == 0) outside.push_back(body.skeleton.bones[b].name);
    }
    if (!outside.empty())
        remarks.push_back(file + ": " + std::to_string(outside.size()) + " of " + std::to_string(body.skeleton.bones.size()) +
                          " bones lie outside the body: " + name_list(outside));
}

void add_distance(const RiggedBody& body, double distance_m, const std::string& file, std::vector<std::string>& remarks)
{
    const double diagonal_m = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).norm();
    if (distance_m > far_from_tets * diagonal_m)
        remarks.push_back(file + ": the boundary of the tets lies up to " + number_text(distance_m, 3) +
                          " m from the surface of the model");
}

void add_joints_without_flesh(const RiggedBody& body, const Character& character, const std::string& file,
                              std::vector<std::string>& remarks)
{
    const std::vector<Bone>& bones = body.skeleton.bones;
    const CarriedWeight weight =
        carried_weight(body.skin, character.artist->weights, *character.surface, character.mesh.tets, static_cast<int>(bones.size()));
    std::vector<std::string> without;
    for (std::size_t b = 0; b < bones.size(); ++b)
        if (weight.carried[b] <= 0.5 * weight.of_artist[b]) without.push_back(bones[b].name);
    if (!without.empty())
        remarks.push_back(file + ": " + std::to_string(without.size()) + " of " + std::to_string(bones.size()) +
                          " joints are without flesh: the tets are too coarse for what they move: " + name_list(without));
}

}  // namespace

std::vector<std::string> remarks_on_model(const RiggedBody& body, const Character& character, const std::string& file)
{
    std::vector<std::string> remarks;
    for (const std::string& remark : body.remarks) remarks.push_back(file + ": " + remark);
    add_size(body, file, remarks);
    add_sheet(body, file, remarks);
    if (body.skeleton.bones.empty()) return remarks;
    add_distance(body, character.artist->largest_distance_m, file, remarks);
    add_bones_outside(body, character.mesh, file, remarks);
    add_joints_without_flesh(body, character, file, remarks);
    return remarks;
}

}  // namespace pbs
