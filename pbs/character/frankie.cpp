#include "pbs/character/frankie.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/character/folded_skeleton.hpp"
#include "pbs/character/iqm.hpp"
#include "pbs/character/surface_body.hpp"
#include "pbs/geometry/input_error.hpp"

#include <filesystem>

namespace pbs {
namespace {

constexpr int default_vertices = 2108;
constexpr int skeleton_version = 1;  // raised with `fold`, so that the cache knows

// 52 joints to 26 bones, with the human's names where clips know them. The forearm is cut in two, as the human's is, so that the wrist's
// twist can be spread along it; the tail follows the pelvis, the ears the head.
const std::vector<FoldedBone> fold = {
    {"pelvis", "", {"CTRL_Pelvis"}, {"CTRL_FK_Femur.L", "CTRL_FK_Femur.R"}},
    {"spine", "pelvis", {"CTRL_Spin"}, {"CTRL_Spin.M"}},
    {"chest", "spine", {"CTRL_Spin.M"}, {"CTRL_RibCage"}},
    {"neck", "chest", {"CTRL_RibCage"}, {"CTRL_Head"}},
    {"head", "neck", {"CTRL_Head"}, {"CTRL_Eartip.L", "CTRL_Eartip.R"}},
    {"tail_1", "pelvis", {"Tail_1"}, {"Tail_3"}},
    {"tail_2", "tail_1", {"Tail_3"}, {"Tail_5"}},
    {"tail_3", "tail_2", {"Tail_5"}, {"Tail_8"}},
    {"clavicle.*", "chest", {"CTRL_RibCage"}, {"CTRL_FK_Humerus.*"}},
    {"upper_arm.*", "clavicle.*", {"CTRL_FK_Humerus.*"}, {"CTRL_FK_Forearm.*"}},
    {"forearm_upper.*", "upper_arm.*", {"CTRL_FK_Forearm.*"}, {"CTRL_FK_Forearm.*", "CTRL_FK_Hand.*"}},
    {"forearm_lower.*", "forearm_upper.*", {"CTRL_FK_Forearm.*", "CTRL_FK_Hand.*"}, {"CTRL_FK_Hand.*"}},
    {"hand.*", "forearm_lower.*", {"CTRL_FK_Hand.*"}, {"CTRL_FK_Fingers.*"}},
    {"hip.*", "pelvis", {"CTRL_Pelvis"}, {"CTRL_FK_Femur.*"}},
    {"thigh.*", "hip.*", {"CTRL_FK_Femur.*"}, {"CTRL_FK_Shin.*"}},
    {"shin.*", "thigh.*", {"CTRL_FK_Shin.*"}, {"CTRL_FK_Foot.*"}},
    {"foot.*", "shin.*", {"CTRL_FK_Foot.*"}, {"CTRL_FK_Toe.*"}},
};

// x left, z up, he looks along -y  ->  x left, y up, z forward.
Vec3 turned(const Vec3& point)
{
    return {point(0), point(2), -point(1)};
}

Skeleton skeleton_of(const IqmModel& model, const std::string& file)
{
    return fold_skeleton(fold, file, [&](const std::string& name) {
        for (const IqmJoint& joint : model.joints)
            if (joint.name == name) return turned(joint.position);
        throw InputError(file, 0, "joints", name, "missing");
    });
}

SurfaceMesh skin_of(const IqmModel& model)
{
    SurfaceMesh skin = model.surface;
    for (Eigen::Index i = 0; i < skin.points.rows(); ++i) skin.points.row(i) = turned(model.surface.points.row(i)).transpose();
    return skin;
}

}  // namespace

std::string frankie_file()
{
    return "/usr/share/games/cube2/packages/models/frankie/Frankie.iqm";
}

void require_frankie()
{
    if (!std::filesystem::exists(frankie_file()))
        throw InputError("", 0, "character.body", "frankie",
                         "not installed: needs the package cube2-data, which `pbskin fetch frankie` brings");
}

Character make_frankie(int vertices)
{
    require_frankie();
    const std::string file = frankie_file(), hash = hash_of_file(file);
    const IqmModel model = read_iqm(file);
    const SurfaceBody body{
        .name = "frankie", .made_from = hash + std::to_string(skeleton_version), .skeleton = skeleton_of(model, file), .surface = [&] {
            return skin_of(model);
        }};
    Character frankie = make_surface_body(body, vertices > 0 ? vertices : default_vertices, false);
    frankie.inputs = {{std::filesystem::path(file).filename().string(), hash}};
    return frankie;
}

}  // namespace pbs
