// The work of one iteration of a deformer, counted by hand from its kernels: what a roofline divides by the time. The counts of each method
// are in files *_work.hpp next to its kernels.
// Operations: every +, -, *, / and square root of real numbers counts one, a change of sign, a comparison or a choice none, and a
// multiply-add two. Only useful ones count: not those on the fourth number of a row, in lanes without an element, or by a factor of one.
// The same count is used for plain and packed code.
// Bytes: what has to pass between the core and the level of memory that holds the working set. Each pass over an array counts its numbers
// once in and, where it writes them, once out; what is loaded again within a pass is answered by a nearer cache and does not count.
#pragma once

namespace pbs {

// The data that a deformer keeps for all frames and reads in each iteration. Only data whose size the mesh does not determine count.
struct KeptEntries {
    double entries = 0.0;  // of the factor's triangle with the diagonal, of the rows of weights that are blended, or of modes of springs
    double rows = 0.0;     // of weights that are blended for one vertex alone
};

// The sizes on which the work of an iteration depends.
struct BodyCounts {
    double vertices = 0.0, edges = 0.0, tets = 0.0;
    KeptEntries kept = {};
};

// One iteration, or one frame of a deformer without iterations. A loop is no faster than either operations or bytes allow.
struct IterationWork {
    double flops = 0.0;              // useful operations; 0: not counted
    double bytes = 0.0;              // 0: not counted
    double working_set_bytes = 0.0;  // decides the level of memory
};

namespace flop_counts {

// On vectors in space: a + b, a . b, a x b, s a, and a + s b.
inline constexpr double sum = 3, dot = 5, cross = 9, scaled = 3, scaled_and_added = 6;

}  // namespace flop_counts

}  // namespace pbs
