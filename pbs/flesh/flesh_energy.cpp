#include "pbs/flesh/flesh_energy.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <string>

namespace pbs {
namespace {

// [v]_x, with [v]_x w = v x w.
Eigen::Matrix3d cross_product_matrix(const Vec3& v)
{
    Eigen::Matrix3d matrix;
    matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return matrix;
}

}  // namespace

double sliver_factor(const TetMesh& mesh, Eigen::Index tet)
{
    constexpr double sliver = 1e-5, regular = 0.1178511301977579;  // 1 / (6 sqrt 2)
    double longest = 0.0;
    for (const auto& [i, j] : edges_of_tet)
        longest = std::max(longest, (mesh.rest.row(mesh.tets(tet, i)) - mesh.rest.row(mesh.tets(tet, j))).norm());
    const double volume = tet_volumes(mesh.rest, mesh.tets.row(tet))(0);
    const double flatness = volume / (longest * longest * longest);
    return flatness < sliver ? flatness / regular : 1.0;
}

FleshEnergy::FleshEnergy(const TetMesh& mesh, const FleshMaterial& material, const BoneHold& hold)
    : hold_(hold.stiffness())
{
    const Eigen::VectorXd volumes = positive_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        FleshTet tet{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, {}, 0.0, 0.0};
        const auto gradients = barycentric_gradients(mesh, t);
        const double factor = sliver_factor(mesh, t);
        slivers_ += factor < 1.0;
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = edges_of_tet[e];
            tet.w[e] = -material.mu * factor * volumes(t) * gradients.col(i).dot(gradients.col(j)) +
                       hold.edge_stiffness()(t, e);
        }
        tet.kappa = factor * material.lambda / (36.0 * volumes(t));
        tet.d = 6.0 * material.alpha * volumes(t);
        tets_.push_back(tet);
    }
}

double FleshEnergy::value(const Positions& x, const Positions& centres) const
{
    Positions ignored;
    return value_and_gradient(x, centres, ignored);
}

double FleshEnergy::value_and_gradient(const Positions& x, const Positions& centres, Positions& gradient) const
{
    double value = 0.0;
    gradient.resize(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const Eigen::RowVector3d from_centre = x.row(i) - centres.row(i);
        value += hold_(i) / 2.0 * from_centre.squaredNorm();
        gradient.row(i) = hold_(i) * from_centre;
    }
    for (const FleshTet& tet : tets_) {
        Vec3 p[4], g[4] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        for (int i = 0; i < 4; ++i) p[i] = x.row(tet.vertex[i]);
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = edges_of_tet[e];
            const Vec3 edge = p[i] - p[j];
            value += tet.w[e] / 2.0 * edge.squaredNorm();
            g[i] += tet.w[e] * edge;
            g[j] -= tet.w[e] * edge;
        }
        const Vec3 p21 = p[1] - p[0], p31 = p[2] - p[0], p41 = p[3] - p[0];
        const Vec3 n2 = p31.cross(p41), n3 = p41.cross(p21), n4 = p21.cross(p31);
        const double beyond = n4.dot(p41) - tet.d, pressure = tet.kappa * beyond;
        value += tet.kappa / 2.0 * beyond * beyond;
        g[0] -= pressure * (n2 + n3 + n4);
        g[1] += pressure * n2;
        g[2] += pressure * n3;
        g[3] += pressure * n4;
        for (int i = 0; i < 4; ++i) gradient.row(tet.vertex[i]) += g[i].transpose();
    }
    return value;
}

Eigen::SparseMatrix<double> flesh_laplacian(const TetMesh& mesh, const FleshMaterial& material,
                                            const FleshEnergy& energy, double volume_share)
{
    constexpr double regular = 1e-9;
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd diagonal = energy.hold();
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const FleshTet& tet = energy.tets()[t];
        const auto gradients = barycentric_gradients(mesh, t);
        const double factor = sliver_factor(mesh, t);
        for (int e = 0; e < 6; ++e) {
            const auto [i, j] = edges_of_tet[e];
            const double h = tet.w[e] - volume_share * material.lambda * factor * volumes(t) *
                                            gradients.col(i).dot(gradients.col(j));
            const auto [low, high] = std::minmax(tet.vertex[i], tet.vertex[j]);
            entries.emplace_back(high, low, -h);
            diagonal(low) += h;
            diagonal(high) += h;
        }
    }
    for (Eigen::Index i = 0; i < diagonal.size(); ++i)
        // 1: a vertex without tets
        entries.emplace_back(i, i, diagonal(i) > 0.0 ? (1.0 + regular) * diagonal(i) : 1.0);
    Eigen::SparseMatrix<double> laplacian(diagonal.size(), diagonal.size());
    laplacian.setFromTriplets(entries.begin(), entries.end());
    return laplacian;
}

// With e_k = x_k - x_0, 6 V = e_1 . (e_2 x e_3). Its second derivative in e_i and e_j, where (i, j, k) is a cyclic
// order, is -[e_k]_x.
Eigen::SparseMatrix<double> flesh_hessian(const FleshEnergy& energy, const Positions& x)
{
    std::vector<Eigen::Triplet<double>> entries;
    const auto add_block = [&](int i, int j, const Eigen::Matrix3d& block) {
        if (i < j) return;
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < (i == j ? a + 1 : 3); ++b) entries.emplace_back(3 * i + a, 3 * j + b, block(a, b));
    };
    for (const FleshTet& tet : energy.tets()) {
        Vec3 e[4], n[4];
        for (int k = 1; k < 4; ++k) e[k] = (x.row(tet.vertex[k]) - x.row(tet.vertex[0])).transpose();
        for (int k = 1; k < 4; ++k) n[k] = e[k % 3 + 1].cross(e[(k + 1) % 3 + 1]);
        n[0] = -(n[1] + n[2] + n[3]);
        const double pressure = tet.kappa * (n[3].dot(e[3]) - tet.d);
        Eigen::Matrix3d of_volume[4][4];  // the second derivatives of 6 V
        for (auto& row : of_volume) std::fill(std::begin(row), std::end(row), Eigen::Matrix3d::Zero());
        for (int k = 1; k < 4; ++k) {
            of_volume[k % 3 + 1][(k + 1) % 3 + 1] = -cross_product_matrix(e[k]);
            of_volume[(k + 1) % 3 + 1][k % 3 + 1] = cross_product_matrix(e[k]);
        }
        for (int j = 1; j < 4; ++j) of_volume[0][j] = -(of_volume[1][j] + of_volume[2][j] + of_volume[3][j]);
        for (auto& row : of_volume) row[0] = -(row[1] + row[2] + row[3]);
        Eigen::Matrix4d of_edges = Eigen::Matrix4d::Zero();
        for (int edge = 0; edge < 6; ++edge) {
            const auto [i, j] = edges_of_tet[edge];
            of_edges(i, j) = of_edges(j, i) = -tet.w[edge];
            of_edges(i, i) += tet.w[edge];
            of_edges(j, j) += tet.w[edge];
        }
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                add_block(tet.vertex[i], tet.vertex[j],
                          of_edges(i, j) * Eigen::Matrix3d::Identity() + tet.kappa * n[i] * n[j].transpose() +
                              pressure * of_volume[i][j]);
    }
    for (Eigen::Index i = 0; i < energy.hold().size(); ++i)
        add_block(static_cast<int>(i), static_cast<int>(i), energy.hold()(i) * Eigen::Matrix3d::Identity());
    Eigen::SparseMatrix<double> hessian(3 * energy.hold().size(), 3 * energy.hold().size());
    hessian.setFromTriplets(entries.begin(), entries.end());
    return hessian;
}

FleshMaterial flesh_material(double poisson)
{
    if (!(poisson >= 0.0 && poisson < 0.5))
        throw InputError("flesh", 0, "poisson", std::to_string(poisson), "expected 0 <= poisson < 1/2");
    const double mu = 1.0 / (2.0 * (1.0 + poisson));
    const double lame = poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    const double lambda = lame + mu;
    return {mu, lambda, 1.0 + mu / lambda};
}

std::vector<NeoHookeanTet> neo_hookean_tets(const TetMesh& mesh)
{
    const Eigen::VectorXd volumes = positive_volumes(mesh.rest, mesh.tets);
    std::vector<NeoHookeanTet> tets;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        NeoHookeanTet tet{{mesh.tets(t, 0), mesh.tets(t, 1), mesh.tets(t, 2), mesh.tets(t, 3)}, {}, volumes(t)};
        Eigen::Matrix3d edges;
        for (int k = 0; k < 3; ++k) edges.col(k) = mesh.rest.row(tet.vertex[k + 1]) - mesh.rest.row(tet.vertex[0]);
        tet.rest_inverse = edges.inverse();
        tets.push_back(tet);
    }
    return tets;
}

Eigen::Matrix3d deformation_gradient(const NeoHookeanTet& tet, const Vec3& p1, const Vec3& p2, const Vec3& p3,
                                     const Vec3& p4)
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
