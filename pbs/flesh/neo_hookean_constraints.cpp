#include "pbs/flesh/flesh_energy.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_volume.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <string>

namespace pbs {

std::vector<NeoHookeanTet> neo_hookean_tets(const TetMesh& mesh)
{
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    std::vector<NeoHookeanTet> tets;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        if (!(volumes(t) > 0.0))
            throw InputError("flesh", 0, "tet " + std::to_string(t), std::to_string(volumes(t)) + " m^3", "expected a volume above 0");
        NeoHookeanTet tet{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, {}, volumes(t)};
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = mesh.rest.row(tet.vertex[k + 1]) - mesh.rest.row(tet.vertex[0]);
        tet.rest_inverse = edges.inverse();
        tets.push_back(tet);
    }
    return tets;
}

Eigen::Matrix3d deformation_gradient(const NeoHookeanTet& tet, const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4)
{
    Eigen::Matrix3d edges;
    edges << p2 - p1, p3 - p1, p4 - p1;
    return edges * tet.rest_inverse;
}

double hydrostatic_value(const Eigen::Matrix3d& F, double alpha)
{
    return F.determinant() - alpha;
}

Eigen::Matrix3d hydrostatic_gradient(const Eigen::Matrix3d& F)
{
    Eigen::Matrix3d cofactors;
    cofactors << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
    return cofactors;
}

double deviatoric_value(const Eigen::Matrix3d& F)
{
    return F.norm();
}

Eigen::Matrix3d deviatoric_gradient(const Eigen::Matrix3d& F)
{
    const double size = F.norm();
    return size > 0.0 ? Eigen::Matrix3d(F / size) : Eigen::Matrix3d::Zero();
}

Eigen::Matrix<double, 3, 4> vertex_gradients(const NeoHookeanTet& tet, const Eigen::Matrix3d& dC_dF)
{
    Eigen::Matrix<double, 3, 4> gradients;
    gradients.rightCols<3>() = dC_dF * tet.rest_inverse.transpose();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
    return gradients;
}

}  // namespace pbs
