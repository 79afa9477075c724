// The strain energy of the flesh by any constitutive law: Pi(u) = sum over tets and quadrature points of w psi(I + grad u).
//   ElasticPotential flesh(space, Model::stable_neo_hookean, lame_parameters(young_pa, poisson), Formulation::mean_dilatation);
// With mean dilatation (J. Nagtegaal, D. Parks, J. Rice, CMAME 4, 1974; J. Simo, R. Taylor, K. Pister, CMAME 51, 1985) a tet's volume term
// is V lambda / 2 mean(theta)^2: one volume constraint a tet, which on P2 is the P2-P0 element. On P1 theta is constant and both agree.
// Quadrature has 1 point on P1 and 6 on P2, exact to degree 3: for the linear law and for det F, hence for the volume.
#pragma once

#include "reference_fem/element_tables.hpp"
#include "reference_fem/formulation.hpp"
#include "reference_fem/laws/constitutive_law.hpp"
#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

// The range of det F, which is 1 at rest.
struct Jacobians {
    double lowest = 1.0;  // of det F over all quadrature points
    int lowest_tet = -1;  // where
    int inverted = 0;     // quadrature points with det F <= 0
    double volume = 0.0;  // [m^3]: sum of w det F, exact
};

// Keeps what it needs of the space; infinite where the law is not defined at some quadrature point.
class ElasticPotential : public Potential {
public:
    // formulation: displacement or mean_dilatation, else pbs::InputError; so is mean dilatation of a law that is not of two parts.
    ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation);
    // Uses another quadrature, of at most 6 points.
    ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation, ElementTables tables);

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness, NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return model_ == Model::linear; }

    Jacobians jacobians(const Eigen::VectorXd& displacement) const;  // displacement [m], #dofs

    // F at quadrature point q of a tet.
    Eigen::Matrix3d deformation_gradient(const Eigen::VectorXd& displacement, Eigen::Index tet, int q) const;

private:
    struct TetState;
    TetState evaluate(const Eigen::VectorXd& displacement, Eigen::Index tet, Derivatives derivatives) const;

    TetNodes tet_nodes_;
    Model model_;
    Formulation formulation_;
    std::unique_ptr<const ConstitutiveLaw> law_;
    ElementTables tables_;
};

}  // namespace reference_fem
