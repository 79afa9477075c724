#include "pbs/flesh/projective_dynamics.hpp"

#include "pbs/flesh/flesh_energy.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"

#include <Eigen/LU>

#include <string>

namespace pbs {
namespace {

constexpr int ends_of_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

}  // namespace

ProjectiveWeights projective_weights(double poisson, bool keeps_volume)
{
    const FleshMaterial material = flesh_material(poisson);
    const double lame = material.lambda - material.mu;
    return {2.0 * material.mu, keeps_volume ? 3.0 * lame : 0.0};
}

// |F|^2 has the factor (mu + share lambda) / 2 there, and (2 mu + 3 lambda_Lame) / 2 here.
double volume_share_of_projective(double poisson, bool keeps_volume)
{
    const FleshMaterial material = flesh_material(poisson);
    const ProjectiveWeights weights = projective_weights(poisson, keeps_volume);
    return (weights.strain + weights.volume - material.mu) / material.lambda;
}

ProjectiveForces projective_forces(const ProjectiveTet& tet, const ProjectiveWeights& weights, const Eigen::Matrix3d& edges)
{
    const Eigen::Matrix3d f = edges * tet.inverse_edges;
    const LocalShapes local = local_shapes(f);
    const Eigen::Matrix3d strain = f - local.rotation, volume = f - local.unit_volume;
    return {0.5 * tet.volume * (weights.strain * strain.squaredNorm() + weights.volume * volume.squaredNorm()),
            tet.volume * (weights.strain * strain + weights.volume * volume) * tet.inverse_edges.transpose()};
}

ProjectiveEnergy::ProjectiveEnergy(const TetMesh& mesh, const ProjectiveWeights& weights, const BoneHold& hold)
    : weights_(weights), hold_(hold.stiffness())
{
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        ProjectiveTet tet{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, {}, 0.0, {}};
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = (mesh.rest.row(tet.vertex[k + 1]) - mesh.rest.row(tet.vertex[0])).transpose();
        tet.volume = edges.determinant() / 6.0;
        if (!(tet.volume > 0.0))
            throw InputError("projective_dynamics", 0, "tet " + std::to_string(t), number_text(tet.volume), "expected a positive volume");
        tet.inverse_edges = edges.inverse();
        for (int e = 0; e < 6; ++e) tet.w[e] = hold.edge_stiffness()(t, e);
        tets_.push_back(tet);
    }
}

double ProjectiveEnergy::value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const
{
    const Positions from_centre = x - centres;
    gradient = hold_.asDiagonal() * from_centre;
    double value = 0.5 * gradient.cwiseProduct(from_centre).sum();
    for (const ProjectiveTet& tet : tets_) {
        Eigen::Matrix<double, 3, 4> corners, forces;
        for (int k = 0; k < 4; ++k) corners.col(k) = x.row(tet.vertex[k]).transpose();
        const ProjectiveForces of_tet = projective_forces(tet, weights_, corners.rightCols<3>().colwise() - corners.col(0));
        value += of_tet.value;
        forces.rightCols<3>() = of_tet.columns;
        forces.col(0) = -of_tet.columns.rowwise().sum();
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = ends_of_edge[e];
            const Vec3 edge = corners.col(i) - corners.col(j);
            value += 0.5 * tet.w[e] * edge.squaredNorm();
            forces.col(i) += tet.w[e] * edge;
            forces.col(j) -= tet.w[e] * edge;
        }
        for (int k = 0; k < 4; ++k) gradient.row(tet.vertex[k]) += forces.col(k).transpose();
    }
    return value;
}

}  // namespace pbs
