// CalculiX's answers to the same nodes, tets and data as rows of the record. Its elements C3D4 and C3D10 are P1 and P2, so both programs
// solve one and the same system, and what differs is rounding or an error of one of them.
//
//   cantilever  #|=====================| |    weight and end load, linear
//               #|=====================| v
#pragma once

#include "reference_fem/elastic_body.hpp"
#include "reference_fem/verification/calculix/calculix_deck.hpp"
#include "reference_fem/verification/calculix/calculix_run.hpp"
#include "reference_fem/verification/problems.hpp"

#include <string>

namespace reference_fem {

inline constexpr ElasticMaterial calculix_flesh{.young_pa = 1e5, .poisson = 0.3};

struct CalculixComparison {
    const Effort& effort;
    std::string program, version;
};

// The largest difference of a node's displacement, relative to the largest displacement, in a pose that is described in words. Mesh and
// cell size are left to the caller.
VerificationRow calculix_row(const CalculixComparison& comparison, const std::string& pose, const std::string& law, AnsweredProblem answer,
                             const DeckOptions& options);

VerificationRows calculix_cantilever_rows(const CalculixComparison& comparison);  // P1 and P2
VerificationRows calculix_timing_rows(const CalculixComparison& comparison);      // of the first solve

// A cantilever under its weight and an end load: the reference's answer to it, and the time of its first linear solve.
// Nodes at the lowest x are held; the nodes at the highest x share the end load [N] equally.
struct LoadedCantilever {
    ElasticMaterial material;
    double density_kg_m3 = 1000.0;
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero(), end_load_n = pbs::Vec3::Zero();
};
NodalProblem cantilever_problem(const SimplexSpace& space, const LoadedCantilever& cantilever);
AnsweredProblem answered_cantilever(const pbs::TetMesh& mesh, int element_order, const LoadedCantilever& cantilever);

// Processor time of the first linear solve by the reference and by CalculiX.
struct FirstSolveTiming {
    int dofs = 0;
    double elements_s = 0.0;  // reference: triangulation, numbering of nodes
    double solve_s = 0.0;     // reference: stiffness, load, elimination, symbolic analysis, factor, solve
    double calculix_s = 0.0;  // CalculiX's whole process: deck read, solved, 7 digits printed, no restart file
    double reading_s = 0.0;   // CalculiX's process for a deck of the same nodes, tets and material without a step: started, read

    double speedup() const { return calculix_s / solve_s; }
    double speedup_with_elements() const { return calculix_s / (elements_s + solve_s); }
    double speedup_without_reading() const { return (calculix_s - reading_s) / solve_s; }
};

// Both solve in turn, with one thread each. Each time is the smallest of the repeats, which other work on the machine disturbed least;
// processor time is disturbed less than wall time. std::runtime_error where CalculiX does not finish.
FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order,
                                  const LoadedCantilever& cantilever, int repeats);

// A body that an attachment holds, by prescribed tets or by springs, as a problem that CalculiX can solve too, with the reference's answer.
enum class BodyModel {
    linear,
    st_venant_kirchhoff,
    st_venant_kirchhoff_at_four_points,  // P2 integrated by C3D10's rule; the reference's own rule has six points
};
struct HeldBody {
    ElasticMaterial material;
    BodyModel model = BodyModel::linear;
    int element_order = 1;
    Attachment attachment;  // no vertex is bound
    TargetsAt targets_at;   // of the problem at 1, and of rest, where a large rotation begins, at 0
};
AnsweredProblem answered_body(const pbs::TetMesh& mesh, const HeldBody& body);

// The analysis that the model needs. With springs CalculiX's Newton stops at a residual of 1e-12 of the mean force, otherwise at 1e-9.
DeckOptions deck_options(const HeldBody& body);

// How far the two programs' answers may differ at a node, relative to the largest displacement: an error of forces relative to |K| |u|,
// times cond(K), which turns it into one of displacements, times |u| over the largest displacement. Norms are 2-norms, and a node's
// difference is at most that of all. K is the stiffness at rest with the springs (problems.hpp). The errors of forces are
//   rounding: sqrt(n) eps, n unknowns;
//   at large strain the reference's last residual, 1e-11 of the gradients of flesh and springs, each at most |K| |u|;
//   and CalculiX's: in each unknown at most its bound times the mean force of elements on their nodes, which is at most |K| |u|.
double difference_bound(const pbs::TetMesh& mesh, const HeldBody& body, const pbs::Positions& displacements);
std::string difference_bound_text(BodyModel model);

}  // namespace reference_fem
