// The work of one projection of each class, counted by hand: the numerator and the denominator of the roofline.
// Operations: every +, -, *, / and square root of real numbers counts one, a change of sign or a comparison none, and a multiply-add two.
// They are those of pbs/solver/batched/pbs_kernels.cpp, which computes in advance what no frame changes (k over w1 + w2, 6 V0). The same
// count is used for every order, so that GFLOP/s are useful ones; what `plain` does beyond them is not counted.
// Bytes: what has to pass between the core and the level that holds the working set in one pass over the class: the constraint's own data
// once, and its share of the positions (x, y, z, w) once in and once out. Loads that a nearer cache answers are not counted.
#pragma once

namespace pbs {

enum class ConstraintClass { stretch, volume, bind };

double flops_of(ConstraintClass of);

// How constraints and positions lie in memory. One pose: a constraint has a vertex index of 4 bytes for each vertex, its rest value and its
// stiffness, a bind constraint d and k; a vertex is x, y, z, w. Many poses side by side share the constraints, which then carry inverse
// masses and a class of stiffness; a vertex is x, y, z for each pose. Bind points, x, y, z, belong to each pose.
struct ProjectionLayout {
    double scalar_bytes = 4.0;
    int poses = 1;
};

struct BodySize {
    double vertices = 0.0, edges = 0.0, tets = 0.0;

    double constraints(ConstraintClass of) const;
};

// One pass over a class [bytes per constraint and pose].
double bytes_of(ConstraintClass of, const ProjectionLayout& layout, const BodySize& size);

// One iteration over all three classes, all poses together [bytes]: no step is faster than these bytes over the bandwidth.
double bytes_per_iteration(const ProjectionLayout& layout, const BodySize& size);

// The memory that one iteration over all three classes touches [bytes].
double working_set_bytes(const ProjectionLayout& layout, const BodySize& size);

}  // namespace pbs
