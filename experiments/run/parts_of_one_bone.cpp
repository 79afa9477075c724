#include "experiments/run/parts_of_one_bone.hpp"

#include "experiments/characters/bone_capsules.hpp"
#include "experiments/characters/model_character.hpp"
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <numbers>
#include <utility>

namespace experiments {

namespace {

constexpr double alone = 0.99;           // the weight of a point of the surface that one bone alone moves
constexpr double follows = 0.5;          // the mean weight of that bone in the tet that carries the point
constexpr std::size_t fewest = 8;        // points of a part: fewer, or points near a line, do not show a rotation
constexpr double least_of_widths = 0.1;  // the second width of a part over its first one

}  // namespace

PartsOfOneBone::PartsOfOneBone(const pbs::Character& character) : character_(character)
{
    const pbs::TetMesh& mesh = character.mesh;
    const std::vector<int> bones = pbs::bones_that_move_alone(character);
    const Eigen::VectorXd volumes_m3 = pbs::tet_volumes(mesh.rest, mesh.tets);
    std::map<int, Shares> shares;  // of each bone: a quarter of its tets [m^3]
    for (std::size_t tet = 0; tet < bones.size(); ++tet)
        if (bones[tet] >= 0)
            for (const int v : mesh.tets.row(static_cast<Eigen::Index>(tet)))
                shares[bones[tet]][v] += volumes_m3(tet) / 4.0;
    volume_m3_ = volumes_m3.sum();
    for (const auto& [bone, share] : shares) parts_.push_back(part_of(bone, share, mesh.rest));
    if (character.surface && character.artist && character.artist->model && !character.artist->weights.first.empty())
        add_parts_of_surface();
}

void PartsOfOneBone::add_parts_of_surface()
{
    const pbs::RiggedBody& body = character_.artist->model->body;
    const pbs::EmbeddedSurface& surface = *character_.surface;
    if (body.skin.vertices() != surface.tet.size()) return;
    std::vector<int> bone_of(static_cast<std::size_t>(surface.tet.size()), -1);
    for (int p = 0; p < body.skin.vertices(); ++p)
        for (int e = body.skin.first[p]; e < body.skin.first[p + 1]; ++e) {
            double in_tet = 0.0;
            for (const int v : character_.mesh.tets.row(surface.tet(p)))
                in_tet += character_.artist->weights.of(v, body.skin.bone[e]) / 4.0;
            if (body.skin.weight[e] > alone && in_tet > follows)
                bone_of[static_cast<std::size_t>(p)] = body.skin.bone[e];
        }
    pbs::Classes classes(bone_of.size());
    const pbs::Triangles across_seams = pbs::joined_triangles(body.surface, surface.triangles);
    for (const auto& triangle : across_seams.rowwise())
        for (int k = 0; k < 3; ++k)
            if (const int a = triangle(k), b = triangle((k + 1) % 3); bone_of[a] >= 0 && bone_of[a] == bone_of[b])
                classes.unite(a, b);
    const Eigen::VectorXd areas_m2 = pbs::lumped_areas(body.surface, across_seams);
    area_m2_ = areas_m2.sum();
    std::map<int, Shares> members;
    for (int p = 0; p < static_cast<int>(bone_of.size()); ++p)
        if (bone_of[p] >= 0 && areas_m2(p) > 0.0) members[classes.find(p)][p] = areas_m2(p);
    const pbs::Positions rest = pbs::embedded_positions(surface, character_.mesh.rest, character_.mesh.tets);
    for (const auto& [first, shares] : members) {
        if (shares.size() < fewest) continue;
        Part part = part_of(bone_of[first], shares, rest);
        const Eigen::Vector3d widths = Eigen::JacobiSVD<Eigen::Matrix3Xd>(part.arms).singularValues();
        if (widths(1) > least_of_widths * widths(0)) parts_of_surface_.push_back(std::move(part));
    }
}

PartsOfOneBone::Part PartsOfOneBone::part_of(int bone, const Shares& shares, const pbs::Positions& rest)
{
    double total = 0.0;
    pbs::Vec3 mean = pbs::Vec3::Zero();
    for (const auto& [v, share] : shares) {
        total += share;
        mean += share * rest.row(v).transpose();
    }
    mean /= total;
    Part part{.bone = bone, .size = total, .vertices = {}, .arms = Eigen::Matrix3Xd(3, shares.size())};
    for (const auto& [v, share] : shares) {
        part.arms.col(static_cast<Eigen::Index>(part.vertices.size())) =
            share / total * (rest.row(v).transpose() - mean);
        part.vertices.push_back(v);
    }
    return part;
}

PartLag PartsOfOneBone::largest_lag(const pbs::Positions& positions, const pbs::Pose& pose) const
{
    const PartLag of_tets = largest_lag_of(parts_, volume_m3_, positions, pose);
    if (parts_of_surface_.empty()) return of_tets;
    const pbs::Positions surface = pbs::embedded_positions(*character_.surface, positions, character_.mesh.tets);
    const PartLag of_surface = largest_lag_of(parts_of_surface_, area_m2_, surface, pose);
    PartLag largest = of_tets.bone < 0 || of_surface.turn_deg > of_tets.turn_deg ? of_surface : of_tets;
    largest.share = std::max(of_tets.share, of_surface.share);
    return largest;
}

PartLag PartsOfOneBone::largest_lag_of(const std::vector<Part>& parts, double body, const pbs::Positions& positions,
                                       const pbs::Pose& pose)
{
    PartLag largest;
    double lagging = 0.0;
    for (const Part& part : parts) {
        // the arms add up to zero, so that the mean of x drops out
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < part.vertices.size(); ++i)
            covariance +=
                positions.row(part.vertices[i]).transpose() * part.arms.col(static_cast<Eigen::Index>(i)).transpose();
        const Eigen::AngleAxisd turn(pbs::nearest_rotation(covariance) * pose[part.bone].linear().transpose());
        const double turn_deg = turn.angle() * 180.0 / std::numbers::pi;
        if (turn_deg > largest.turn_deg || largest.bone < 0) largest = {.turn_deg = turn_deg, .bone = part.bone};
        if (turn_deg > much_lag_deg) lagging += part.size;
    }
    if (lagging > 0.0) largest.share = lagging / body;
    return largest;
}

}  // namespace experiments
