// What one projection of each class asks of a machine, counted by hand: the numerator and the denominator of the roofline.
// Operations: every +, -, *, / and square root of real numbers is one, a change of sign or a comparison none; a multiply-add is two. They
// are those of pbs/solver/batched/project_lanes.hpp, which precomputes what no frame changes (k over w1 + w2, 6 V0), and stand for every
// order alike, so that GFLOP/s are useful ones: what `plain` does beyond them is its own affair.
// Bytes: what has to pass between the core and the level that holds the working set, once a pass over the class: the constraint's own data
// once, its share of the positions (x, y, z, w) once in and once out. Loads that a nearer cache answers are not counted.
#pragma once

namespace experiments {

enum class ConstraintClass { stretch, volume, bind };

double flops_of(ConstraintClass of);

// How constraints and positions lie in memory. One pose: a vertex index of 4 bytes each, rest value and stiffness, of bind d and k; a
// vertex is x, y, z, w. Many poses side by side share the constraints, which then carry inverse masses and a class of stiffness; a vertex
// is x, y, z of each. Bind points, x, y, z, belong to each pose.
struct Layout {
    double scalar_bytes = 4.0;
    int poses = 1;
};

double data_bytes_of(ConstraintClass of, const Layout& layout);  // of a constraint, shared by all poses

struct BodySize {
    double vertices = 0.0, edges = 0.0, tets = 0.0;

    double constraints(ConstraintClass of) const;
};

// Of one pass over a class [bytes a constraint and pose].
double bytes_of(ConstraintClass of, const Layout& layout, const BodySize& size);

// Of one iteration over all three, all poses together [bytes]: no step is quicker than these over the bandwidth.
double bytes_an_iteration(const Layout& layout, const BodySize& size);

// What one iteration over all three goes over [bytes].
double working_set_bytes(const Layout& layout, const BodySize& size);

}  // namespace experiments
