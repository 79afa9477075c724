// The work of one iteration of AuthorSolver, counted by hand from author_constraints.hpp by the rules of iteration_work.hpp.
#pragma once

#include "pbs/geometry/iteration_work.hpp"

namespace pbs {

IterationWork work_of_author(const BodyCounts& body);

}  // namespace pbs
