// Displacements from CalculiX's files. It prints 7 digits (deck.dat); its restart file (deck.rout, *RESTART, WRITE: Fortran records
// of raw memory) holds them in double. Which record of it they are depends on CalculiX's version, so it is recognised: the one of the
// right length that agrees with every printed number to its last digit. The ends of springs, which are not printed, are nodes behind them.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <string>

namespace reference_fem {

struct CalculixDisplacements {
    pbs::Positions displacements;  // [m], #nodes x 3
    bool in_double = false;        // from the restart file; false: 7 digits, as printed
};

// The one block of displacements in a .dat text, at time 1. pbs::InputError with `file` and line where there is none or a second one, a
// node is missing, twice or unknown, or a line is not a node and three numbers.
pbs::Positions read_printed_displacements(const std::string& text, const std::string& file, Eigen::Index nodes);

// Both; a restart file that is empty or holds no such record leaves the printed digits. pbs::InputError where it is cut short.
CalculixDisplacements read_displacements(const std::string& printed, const std::string& restart, Eigen::Index nodes);

}  // namespace reference_fem
