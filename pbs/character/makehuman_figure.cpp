#include "pbs/character/makehuman_figure.hpp"

#include "pbs/character/face_stream.hpp"
#include "pbs/character/folded_skeleton.hpp"
#include "pbs/character/morph_targets.hpp"
#include "pbs/geometry/number_text.hpp"

#include <filesystem>

namespace pbs {
namespace {

constexpr double metres_a_unit = 0.1;

// The rig's ends of bones, 163 folded to 23: the spine to three, each limb segment to one, but the forearm, which keeps its two halves.
const std::vector<FoldedBone> fold = {
    {"pelvis", "", {"root____head"}, {"spine04____head"}},
    {"spine", "pelvis", {"spine04____head"}, {"spine02____head"}},
    {"chest", "spine", {"spine02____head"}, {"neck01____head"}},
    {"neck", "chest", {"neck01____head"}, {"head____head"}},
    {"head", "neck", {"head____head"}, {"head____tail"}},
    {"clavicle.*", "chest", {"clavicle.*____head"}, {"upperarm01.*____head"}},
    {"upper_arm.*", "clavicle.*", {"upperarm01.*____head"}, {"lowerarm01.*____head"}},
    {"forearm_upper.*", "upper_arm.*", {"lowerarm01.*____head"}, {"lowerarm02.*____head"}},
    {"forearm_lower.*", "forearm_upper.*", {"lowerarm02.*____head"}, {"wrist.*____head"}},
    {"hand.*", "forearm_lower.*", {"wrist.*____head"}, {"finger3-3.*____tail"}},
    {"hip.*", "pelvis", {"root____head"}, {"upperleg01.*____head"}},
    {"thigh.*", "hip.*", {"upperleg01.*____head"}, {"lowerleg01.*____head"}},
    {"shin.*", "thigh.*", {"lowerleg01.*____head"}, {"foot.*____head"}},
    {"foot.*", "shin.*", {"foot.*____head"}, {"toe2-1.*____head"}},
};

Positions read_vertices(const JsonFile& model)
{
    const std::vector<double> values = model.numbers<double>("vertices");
    if (values.empty() || values.size() % 3 != 0) model.refuse("vertices", "expected three numbers a vertex");
    return Eigen::Map<const Positions>(values.data(), static_cast<Eigen::Index>(values.size() / 3), 3);
}

// Mean [m] of the vertices that the rig lists for a joint.
Vec3 joint_of(const JsonFile& rig, const std::string& joint, const Positions& vertices)
{
    const std::string field = "joints." + joint;
    const std::vector<int> around = rig.numbers<int>(rig.at(rig.at("joints"), joint), field);
    if (around.empty()) rig.refuse(field, "expected vertices");
    Vec3 sum = Vec3::Zero();
    for (const int vertex : around) {
        if (vertex < 0 || vertex >= vertices.rows()) rig.refuse(field, expected_whole("vertices", 0, vertices.rows() - 1));
        sum += vertices.row(vertex).transpose();
    }
    return metres_a_unit * sum / static_cast<double>(around.size());
}

std::string file_name(const std::string& path)
{
    return std::filesystem::path(path).filename().string();
}

}  // namespace

MakehumanFigure read_makehuman(const MakehumanFiles& files, const std::vector<std::string>& targets)
{
    const JsonFile model(files.model), rig(files.rig);
    Positions vertices = read_vertices(model);
    const MorphTargets morphs(files.target_list, files.targets, vertices.rows());

    MakehumanFigure figure;
    figure.inputs = {
        {file_name(files.model), model.hash()}, {file_name(files.rig), rig.hash()}, {file_name(files.target_list), morphs.list_hash()}};
    for (const std::string& target : targets)
        figure.inputs.emplace_back(file_name(files.targets) + " " + target, morphs.add(target, vertices));
    figure.skin = surface_of_material(model, metres_a_unit * vertices, "body");
    figure.skeleton = fold_skeleton(fold, files.rig, [&](const std::string& joint) { return joint_of(rig, joint, vertices); });
    return figure;
}

}  // namespace pbs
