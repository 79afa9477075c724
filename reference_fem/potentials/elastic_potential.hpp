// The strain energy of the flesh, Pi(u) = sum over tets and quadrature points of w psi(I + grad u), by any constitutive law.
#pragma once

#include "reference_fem/element_tables.hpp"
#include "reference_fem/formulation.hpp"
#include "reference_fem/laws/constitutive_law.hpp"
#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

struct Jacobians {
    double lowest = 1.0;  // of det F over all quadrature points
    int lowest_tet = -1;  // where
    int inverted = 0;     // quadrature points with det F <= 0
    double volume = 0.0;  // [m^3]: sum of w det F, exact for P1; for P2 up to its quadrature
};

class ElasticPotential : public Potential {
public:
    // formulation: displacement or mean_dilatation. The space outlives the potential.
    ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation);

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness, NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return model_ == Model::linear; }

    Jacobians jacobians(const Eigen::VectorXd& displacement) const;

private:
    using NodalVectors = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, 10, 3>;  // nodes of a tet x 3
    NodalVectors nodal(const Eigen::VectorXd& displacement, Eigen::Index tet) const;
    Eigen::Matrix3d deformation_gradient(const NodalVectors& nodal, Eigen::Index tet, int q) const;
    // theta at the points of a tet: each point's own, or the mean of all. Infinite where the law is not defined.
    double mean_dilatation(const std::vector<PointResponse>& responses, Eigen::Index tet) const;

    TetNodes tet_nodes_;
    Model model_;
    Formulation formulation_;
    std::unique_ptr<const ConstitutiveLaw> law_;
    ElementTables tables_;
};

}  // namespace reference_fem
