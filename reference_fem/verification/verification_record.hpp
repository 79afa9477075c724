// The verification on record: the rows of DIR/verification.csv.
#pragma once

#include "analysis/records/tables.hpp"

#include <optional>
#include <string>
#include <vector>

namespace reference_fem {

struct RowMaterial {
    std::string law = {};                // an identifier: stable_neo_hookean; empty without an elastic law
    std::optional<double> poisson = {};  // its Poisson's ratio
};

struct RowQuantity {
    std::string key = {};          // of what is compared, an identifier: tip_deflection
    std::string description = {};  // the same in words, with the settings that it belongs to
    std::string setting = {};      // an identifier that distinguishes rows with the same quantity: newmark_omega_h_0.1
};

struct RowElements {
    std::optional<int> order = {};  // 1 linear, 2 quadratic; nothing in a row without finite elements
    // displacement, mean_dilatation or taylor_hood; without finite elements pbs, volume_constraints or one_point
    std::string formulation = "displacement";

    std::string text() const;  // P2, P2 taylor_hood, one_point
};

// One row of the verification record: a value of the reference solver compared with the value from theory, another code
// or a published benchmark.
struct VerificationRow {
    std::string problem = {};  // its name in the list of problems
    RowQuantity quantity = {};
    RowElements elements = {};
    RowMaterial material = {};
    std::string mesh = {};  // divisions
    double h_m = 0.0;       // edge of a cell
    int dofs = 0;
    double value = 0.0, reference = 0.0;
    std::string unit = {};    // of both; 1 where there is none
    std::string source = {};  // of the reference: a full citation, or 'closed form: ...'

    // Bounds that must hold; a row without bounds is for information.
    std::optional<double> low = {}, high = {};  // of the value
    std::string bound_from = {};                // where the bounds come from
    std::optional<double> observed_order = {};  // in h, between the next coarser mesh and this one; or in the time step
    std::optional<double> expected_order = {};
    std::string note = {};
};
using VerificationRows = std::vector<VerificationRow>;

inline constexpr double order_tolerance = 0.1;

// 100 (value - reference) / |reference|; nothing where the reference is 0.
std::optional<double> difference_pct(const VerificationRow& row);

// Value within the bounds and order within order_tolerance; no value where the row requires neither.
std::optional<bool> holds(const VerificationRow& row);

// The columns of verification.csv: a row and what follows from it.
const analysis::Columns<VerificationRow>& verification_columns();

// How much of a verification problem to run, and with which deliberate error.
struct Effort {
    bool full = false;  // all meshes of the sequence
    double lambda_error =
        0.0;  // for tests: a relative error of the solver's first Lame parameter, unknown to the reference values
};

}  // namespace reference_fem
