// Runs a cell twice, disturbed and undisturbed, and determines its outcome.
//   const CellResult result = run_cell(cell);
#pragma once

#include "analysis/metrics/stability_outcome.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>
#include <optional>

namespace experiments {

// The body of a cell and its motion: the pose, the blended shape and the bind points of each step.
//   StabilityBody body(cell);
//   for (int step = 0; step < body.steps(); ++step) driven->advance(body.drive(step), cell.time_step_s);
// A drive is the input of every method in a step.
struct Drive {
    const pbs::Pose& pose;
    const pbs::Positions& blended;      // LBS, or the broken initial shape [m], #V x 3
    const pbs::Positions& bind_points;  // posed q_i [m], #V x 3
};

// The scene of the cells of `body`: a limb, or a character that lands from a jump.
Scene stability_scene(const std::string& body);

// Characters are cached, so that all cells have the same tets.
const pbs::Character& stability_character(const StabilityCell& cell);

class StabilityBody {
public:
    explicit StabilityBody(const StabilityCell& cell);

    const pbs::Character& character() const { return character_; }
    int disturbed_steps() const { return static_cast<int>(way_.size()); }
    int steps() const { return disturbed_steps() + still_steps_; }
    Drive drive(int step);  // valid until the next call
    double diagonal_m() const { return diagonal_m_; }

private:
    const pbs::Character& character_;
    std::vector<pbs::Pose> way_;
    Start start_;
    int still_steps_, posed_ = -1;
    double diagonal_m_;
    pbs::Positions blended_, bind_points_;
};

// A body under one of the methods, driven step by step. All cells use this interface, whatever their method.
//   const auto driven = make_driven_body(cell, character);
//   const pbs::StepSummary step = driven->advance(drive, dt);
class DrivenBody {
public:
    virtual ~DrivenBody() = default;
    virtual pbs::StepSummary advance(const Drive& drive, double dt_s) = 0;
    virtual const pbs::Positions& positions() const = 0;  // [m], #V x 3
};

std::unique_ptr<DrivenBody> make_driven_body(const StabilityCell& cell, const pbs::Character& character);

struct CellResult {
    analysis::StabilityResult stability;
    std::vector<analysis::StabilityStep> steps;
    bool has_undisturbed = false;  // the same body comes to rest when it begins in the last pose
    int steps_not_reached = 0;
    // From a broken initial state: the method's iterations up to and including the first step that was reached. For Newton's method this is
    // the number until the residual was within tolerance, including a first solve that failed. PBS and XPBD always do all their iterations.
    std::optional<int> iterations_until_reached;
    double cpu_s = 0.0;
};
CellResult run_cell(const StabilityCell& cell);
std::string endings_text();  // when a run ends early, as Markdown

// A good mesh made bad on purpose: some vertices are moved so that a tet at each becomes thin, without inverting any tet.
//   const pbs::TetMesh spoilt = distorted(mesh, Defect::slivers, 1e-4);
// slivers: a vertex keeps the share `thinness` of its height over the opposite face of one tet. needles: it keeps that share of the length
// of one edge. A seeded twentieth of the vertices is moved, no two of the same tet. Vertices that would invert a tet are skipped.
pbs::TetMesh distorted(const pbs::TetMesh& mesh, Defect defect, double thinness);

}  // namespace experiments
