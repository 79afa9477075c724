#include "experiments/run/parts_of_one_bone.hpp"

#include "pbs/character/bone_capsules.hpp"
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>

#include <map>
#include <numbers>

namespace experiments {

PartsOfOneBone::PartsOfOneBone(const pbs::Character& character)
{
    const pbs::TetMesh& mesh = character.mesh;
    const std::vector<int> alone = pbs::bones_that_move_alone(character);
    const Eigen::VectorXd volumes_m3 = pbs::tet_volumes(mesh.rest, mesh.tets);
    std::map<int, std::map<int, double>> shares;  // of each bone and vertex: a quarter of its tets [m^3]
    for (std::size_t tet = 0; tet < alone.size(); ++tet)
        if (alone[tet] >= 0)
            for (const int v : mesh.tets.row(static_cast<Eigen::Index>(tet))) shares[alone[tet]][v] += volumes_m3(tet) / 4.0;
    for (const auto& [bone, share] : shares) {
        double total_m3 = 0.0;
        pbs::Vec3 mean = pbs::Vec3::Zero();
        for (const auto& [v, volume_m3] : share) {
            total_m3 += volume_m3;
            mean += volume_m3 * mesh.rest.row(v).transpose();
        }
        mean /= total_m3;
        parts_.push_back({.bone = bone, .vertices = {}, .arms = Eigen::Matrix3Xd(3, share.size())});
        Part& part = parts_.back();
        for (const auto& [v, volume_m3] : share) {
            part.arms.col(static_cast<Eigen::Index>(part.vertices.size())) = volume_m3 / total_m3 * (mesh.rest.row(v).transpose() - mean);
            part.vertices.push_back(v);
        }
    }
}

PartLag PartsOfOneBone::largest_lag(const pbs::Positions& positions, const pbs::Pose& pose) const
{
    PartLag largest;
    for (const Part& part : parts_) {
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // the arms add up to zero, so that the mean of x drops out
        for (std::size_t i = 0; i < part.vertices.size(); ++i)
            covariance += positions.row(part.vertices[i]).transpose() * part.arms.col(static_cast<Eigen::Index>(i)).transpose();
        const Eigen::AngleAxisd turn(pbs::nearest_rotation(covariance) * pose[part.bone].linear().transpose());
        const double turn_deg = turn.angle() * 180.0 / std::numbers::pi;
        if (turn_deg > largest.turn_deg || largest.bone < 0) largest = {.turn_deg = turn_deg, .bone = part.bone};
    }
    return largest;
}

}  // namespace experiments
