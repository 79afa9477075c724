#include "experiments/distributed/loaded_body.hpp"

#include "experiments/deformers/fem/bone_attachment.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "reference_fem/verification/problems.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace experiments {
namespace {

// Cubes of 6 tets each: n along each side of the section, and as many along the bar as give the wanted number of tets.
pbs::TetMesh bar(int tets)
{
    const int n = std::max(1, static_cast<int>(std::lround(std::cbrt(tets / 60.0))));
    const int along = std::max(1, static_cast<int>(std::lround(tets / (6.0 * n * n))));
    return reference_fem::box_mesh({0, 0, 0}, {10, 1, 1}, {along, n, n});
}

std::vector<int> vertices_where(const pbs::TetMesh& mesh, const auto& holds)
{
    std::vector<int> vertices;
    for (int v = 0; v < mesh.rest.rows(); ++v)
        if (holds(mesh.rest(v, 0))) vertices.push_back(v);
    return vertices;
}

LoadedBody held_at_the_end(const BodyArguments& arguments, const reference_fem::LinearOptions& options)
{
    LoadedBody body;
    body.name = arguments.bar_tets > 0 ? "bar" : std::filesystem::path(arguments.mesh_file).filename().string();
    body.mesh = arguments.bar_tets > 0 ? bar(arguments.bar_tets) : pbs::read_tet_mesh(arguments.mesh_file).mesh;
    const double low = body.mesh.rest.col(0).minCoeff(), high = body.mesh.rest.col(0).maxCoeff(), rounding = 1e-9 * (high - low);
    const double held = std::isnan(arguments.held_below_m) ? low + rounding : arguments.held_below_m;
    const double pulled = std::isnan(arguments.pulled_above_m) ? high - rounding : arguments.pulled_above_m;
    body.problem.options = options;
    body.problem.held_vertices = vertices_where(body.mesh, [&](double x) { return x <= held; });
    body.problem.pulled_vertices = vertices_where(body.mesh, [&](double x) { return x >= pulled; });
    body.problem.traction_pa = arguments.traction_pa;
    return body;
}

LoadedBody limb(const BodyArguments& arguments, const reference_fem::LinearOptions& options)
{
    pbs::CharacterSource source;
    source.body = "limb";
    source.vertices = arguments.limb_vertices;
    const pbs::Character character = pbs::make_character(source);
    const FemOptions fem{.young_pa = options.young_pa, .attachment = FemAttachment::smooth};
    const BoneAttachment bones = bone_attachment(character, fem);
    constexpr double degree = std::numbers::pi / 180.0;
    std::vector<Eigen::Quaterniond> joints(character.skeleton.bones.size(), Eigen::Quaterniond::Identity());
    joints.back() = Eigen::AngleAxisd(arguments.bend_deg * degree, pbs::Vec3::UnitZ()) *
                    Eigen::AngleAxisd(arguments.twist_deg * degree, pbs::Vec3::UnitX());
    LoadedBody body{character.name, character.mesh, {}, fem};
    body.problem.options = options;
    body.problem.attachment = bones.attachment;
    body.problem.spring_targets = spring_targets(bones, pbs::pose_from_joints(character.skeleton, joints, pbs::Vec3::Zero()));
    return body;
}

}  // namespace

LoadedBody load_body(const BodyArguments& arguments, const reference_fem::LinearOptions& options)
{
    if ((arguments.bar_tets > 0) + (arguments.limb_vertices > 0) + !arguments.mesh_file.empty() != 1)
        throw pbs::InputError("", 0, "body", "", "expected one of --bar, --limb and --mesh");
    return arguments.limb_vertices > 0 ? limb(arguments, options) : held_at_the_end(arguments, options);
}

void broadcast(const reference_fem::MpiSession& session, LoadedBody& body)
{
    session.broadcast(body.name);
    session.broadcast(body.mesh.rest);
    session.broadcast(body.mesh.tets);
    session.broadcast(body.problem.held_vertices);
    session.broadcast(body.problem.pulled_vertices);
    session.broadcast(body.problem.attachment.spring_points);
    session.broadcast(body.problem.attachment.spring_stiffness);
    session.broadcast(body.problem.attachment.prescribed_tets);
    session.broadcast(body.problem.spring_targets);
    session.broadcast(body.problem.vertex_targets);
}

}  // namespace experiments
