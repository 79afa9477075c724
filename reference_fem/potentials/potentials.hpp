// A potential energy of the nodal displacements: one term of the total Pi(u) that a static solution minimises. The
// flesh, the springs of the bones, the bind constraint, loads and, in a time step, inertia and damping are such terms.
#pragma once

#include "reference_fem/assembly.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/laws/constitutive_law.hpp"
#include "reference_fem/options.hpp"

#include <cmath>

namespace reference_fem {

// projected: each tet's (or spring's) own matrix is replaced by the nearest one without negative eigenvalues, so that
// the sum is positive semi-definite and every Newton step descends.
enum class Definiteness { as_it_is, projected };

// Terms are added up: gradient and Hessian go on top of what is there.
class Potential {
public:
    virtual ~Potential() = default;

    // displacement [m], #dofs, degree of freedom 3 n + c is component c at node n.
    virtual double value(const Eigen::VectorXd& displacement) const = 0;  // [J]; infinite where a law is not defined
    // [N], #dofs
    virtual void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const = 0;
    // [N/m]
    virtual void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                             NodalMatrix& hessian) const = 0;

    // Both at once, where that is cheaper; the gradient is left unfinished where the value is not finite.
    virtual double value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
    {
        const double energy = value(displacement);
        if (std::isfinite(energy)) add_gradient(displacement, gradient);
        return energy;
    }

    // The largest share of `step` [m], 0 to 1, after which the term is still defined, where `value` alone does not show
    // it.
    virtual double largest_step(const Eigen::VectorXd&, const Eigen::VectorXd& /*step*/) const { return 1.0; }
    // Pairs of nodes without a common tet that the Hessian has blocks of, there and near that displacement.
    virtual std::vector<NodePair> couplings(const Eigen::VectorXd&) const { return {}; }

    virtual bool is_quadratic() const = 0;  // its Hessian is the same everywhere, so that a factor of it may be kept
};

// The strain energy of the flesh by any constitutive law: Pi(u) = sum over tets and quadrature points of w psi(I + grad
// u).
//   ElasticPotential flesh(space, Model::stable_neo_hookean, lame_parameters(young_pa, poisson),
//                          Formulation::mean_dilatation);
// With mean dilatation (J. Nagtegaal, D. Parks, J. Rice, CMAME 4, 1974; J. Simo, R. Taylor, K. Pister, CMAME 51, 1985)
// a tet's volume term is V lambda / 2 mean(theta)^2: one volume constraint per tet, which on P2 is the P2-P0 element.
// On P1 theta is constant and both agree. Quadrature has 1 point on P1 and 6 on P2, exact to degree 3: for the linear
// law and for det F, hence for the volume. The range of det F, which is 1 at rest.
struct Jacobians {
    double lowest = 1.0;  // of det F over all quadrature points
    int lowest_tet = -1;  // where
    int inverted = 0;     // quadrature points with det F <= 0
    double volume = 0.0;  // [m^3]: sum of w det F, exact
};

// Keeps what it needs of the space; infinite where the law is not defined at some quadrature point.
class ElasticPotential : public Potential {
public:
    // formulation: displacement or mean_dilatation, else pbs::InputError; so is mean dilatation of a law that is not of
    // two parts.
    ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation);
    // Uses another quadrature, of at most 6 points.
    ElasticPotential(const SimplexSpace& space, Model model, const Lame& lame, Formulation formulation,
                     ElementTables tables);

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                     NodalMatrix& hessian) const override;
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

// A quadratic potential by its matrix: c / 2 (u - u0)^T K (u - u0). The flesh of the linear law, and the
// stiffness-proportional part of Rayleigh's damping in a time step. Keeps a copy of K.
class StiffnessPotential : public Potential {
public:
    // stiffness [N/m], of the Hessians' pattern; as it is: c = 1, u0 = 0.
    explicit StiffnessPotential(const NodalMatrix& stiffness);

    void set(double coefficient, Eigen::VectorXd centre);  // c [1], u0 [m], #dofs

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    double value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                     NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return true; }

private:
    SparseMatrix stiffness_;
    double coefficient_ = 1.0;
    Eigen::VectorXd centre_;
};

// The Hessian of a potential at rest [N/m].
NodalMatrix rest_stiffness(const SimplexSpace& space, const Potential& potential);

// Forces that do not change with the displacement, such as gravity and tractions: -f . u.
// Its Hessian is 0.
class DeadLoad : public Potential {
public:
    explicit DeadLoad(Eigen::VectorXd force) : force_(std::move(force)) {}  // [N], #dofs

    void set(const Eigen::VectorXd& force) { force_ = force; }  // [N], #dofs; in place of the one before
    const Eigen::VectorXd& force() const { return force_; }     // [N], #dofs

    double value(const Eigen::VectorXd& displacement) const override { return -force_.dot(displacement); }
    void add_gradient(const Eigen::VectorXd&, Eigen::VectorXd& gradient) const override { gradient -= force_; }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix&) const override {}
    bool is_quadratic() const override { return true; }

private:
    Eigen::VectorXd force_;
};

// The springs of an attachment as a potential: sum_s k_s / 2 |x(p_s) - target_s|^2.
// Call move_to() before anything else.
class SpringPotential : public Potential {
public:
    explicit SpringPotential(const AttachedPoints& springs) : springs_(springs) {}  // which outlive the potential

    void move_to(const pbs::Positions& targets) { targets_ = targets; }  // [m], #S x 3

    double value(const Eigen::VectorXd& displacement) const override { return springs_.energy(targets_, displacement); }
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        springs_.add_pull(targets_, displacement, gradient);
    }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix& hessian) const override
    {
        springs_.add_to(hessian);
    }
    bool is_quadratic() const override { return true; }

private:
    const AttachedPoints& springs_;
    pbs::Positions targets_;
};

// The paper's bind constraint (Sec. 3.6) as an energy on vertices: sum_i k_i / 2 (|x_i - q_i| - d_i)^2, q_i the
// vertex's rest projection on its bone, carried by the bone. It keeps a distance and nothing else: around the bone and,
// past its ends, around the end point a vertex is free. A vertex on the bone (d_i = 0) is tied to q_i. Until move_to()
// the bind points q_i are the rest positions.
class BindPotential : public Potential {
public:
    // rest [m], #V x 3; distance d_i [m] and stiffness k_i [N/m], #V; k_i = 0: not bound. Vertex v is node v.
    BindPotential(const pbs::Positions& rest, const Eigen::VectorXd& distance, const Eigen::VectorXd& stiffness)
        : rest_(rest), distance_(distance), stiffness_(stiffness), bind_points_(rest)
    {
    }

    void move_to(const pbs::Positions& bind_points) { bind_points_ = bind_points; }  // q_i [m], #V x 3

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                     NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return false; }

private:
    pbs::Vec3 offset(const Eigen::VectorXd& displacement, Eigen::Index vertex) const;  // x_i - q_i [m]

    pbs::Positions rest_;
    Eigen::VectorXd distance_, stiffness_;
    pbs::Positions bind_points_;
};

}  // namespace reference_fem
