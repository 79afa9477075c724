// Frictionless contact of the flesh with itself as a potential: a barrier between the triangles of its surface that
// come near each other, so that the surface of a minimum does not intersect itself. Newton's method must not take a
// longer step than largest_step(). M. Li et al., Incremental Potential Contact, ACM TOG 39(4), 2020. Two changes make
// the pressure independent of the mesh: each point is pressed by the nearest place of a surface once, however many
// triangles meet there (M. Li et al., Convergent Incremental Potential Contact, arXiv 2307.15908, 2023), and the pairs
// of edges, which only keep edges from passing through each other, have half the range: flat faces come that near at a
// pressure of 1.2 times the stiffness.
//   ContactPotential contact(space, {.range_m = 0.002, .stiffness_pa = young_pa});
//   Two flat faces at the distance d < range press on each other with stiffness_pa |db/dd|, b(d) = -range (d/range -
//   1)^2 ln(d/range).
#pragma once

#include "reference_fem/contact/near_pairs.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include <array>
#include <vector>

namespace reference_fem {

struct ContactOptions {
    double range_m = 0.0;       // > 0: surfaces farther apart do not press
    double stiffness_pa = 0.0;  // > 0: the pressure at 0.57 of the range, about
};

// b(d) = -e (d/e - 1)^2 ln(d/e) [m] below the range e, else 0, with its derivatives [1] and [1/m].
struct Barrier {
    double value = 0.0, first = 0.0, second = 0.0;
};
Barrier barrier(double distance_m, double range_m);

// The pairs of the surface that press on each other in one state of deformation.
struct ContactState {
    double smallest_distance_m = 0.0;  // of the pairs that press; 0: none does
    int pairs = 0;
    double energy_j = 0.0;
};

// Where a node of the surface and the place that presses on it are at rest: close to each other at the tip of a crease.
struct PressedPair {
    pbs::Vec3 middle = pbs::Vec3::Zero();  // between them [m]
    double apart_m = 0.0;                  // their distance
};

class ContactPotential : public Potential {
public:
    // The space may go. pbs::InputError for options out of bounds.
    ContactPotential(const SimplexSpace& space, const ContactOptions& options);

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                     NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return false; }
    double largest_step(const Eigen::VectorXd& displacement, const Eigen::VectorXd& step) const override
    {
        return near_.largest_step(displacement, step);
    }
    std::vector<NodePair> couplings(const Eigen::VectorXd& displacement) const override;

    ContactState state(const Eigen::VectorXd& displacement) const;
    std::vector<PressedPair> pressed(const Eigen::VectorXd& displacement) const;
    // Whether an edge of the surface passes through a triangle. Such a state is no initial guess: the barrier would
    // keep it as it is.
    bool intersects(const Eigen::VectorXd& displacement) const { return near_.intersects(displacement); }

    const ContactSurface& surface() const { return near_.surface(); }

private:
    // A term weight m b(d) of the energy; m is 1, or less for nearly parallel edges.
    struct Term {
        PairKind kind;
        std::array<int, 4> nodes;
        ClosestPoints closest;
        double range_m, weight_n_m;  // [N/m]
    };
    struct Mollifier;

    std::vector<Term> terms_at(const Eigen::VectorXd& displacement) const;
    void add_terms_of_node(const std::vector<Term>& touched, const Eigen::VectorXd& displacement,
                           std::vector<Term>& terms) const;
    Mollifier mollifier(const Term& term, const FourPoints& points) const;

    ContactOptions options_;
    NearPairs near_;
    std::vector<int> triangles_at_node_;  // their number, #nodes of the space
};

}  // namespace reference_fem
