// One setting of one deformer, moving back and forth between a pose and that of the frame before: its shape in the pose, the time per
// frame, and the work per frame. A solver that begins in its last state (finite elements) is thus timed on the motion of one frame, as in a
// clip. A frame ends with the positions of the case's own vertices: where the deformer runs on another mesh, the transfer is part of the
// time.
//   PosedDeformer deformer(setting, mesh, motion);
//   const Shape shape = deformer.reach();      // from rest, however long it takes
//   take_turns({[&] { return deformer.turn(); }}, rounds);
// The time is processor time over all threads of the process, so that other work on the machine affects it less. A deformer that works in
// another process (DeformerTraits::has_own_clock) has the time that it states instead. It runs on the case's own mesh only.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/compared_deformers.hpp"
#include "pbs/character/bodies.hpp"

#include <memory>
#include <optional>

namespace experiments {

// A mesh of the body: the case's own, or a coarser or finer one. Shapes on it are mapped to the vertices of the case's own mesh, so that
// errors on all meshes are measured at the same points of the flesh and by the same metrics.
//   const BodyMesh coarse(source, 600, base);
//   error_metrics.measure(coarse.on_base(positions), reference);
class BodyMesh {
public:
    explicit BodyMesh(std::shared_ptr<const pbs::Character> base)
        : character_(std::move(base)), base_vertices_(character_->mesh.rest.rows())
    {
    }
    // Another mesh of about so many vertices. Where it ends slightly inside the base's surface, its tets are extended.
    BodyMesh(const pbs::CharacterSource& source, int vertices, const pbs::Character& base);
    // Every tet of the base cut into eight. The first vertices are those of the base.
    static BodyMesh refined(const pbs::Character& base);
    // The base with skinning weights that are harmonic where Eq. 2 blends.
    static BodyMesh with_smooth_weights(const pbs::Character& base);

    const pbs::Character& character() const { return *character_; }
    bool has_base_vertices() const { return !points_; }  // its first vertices are those of the base: nothing has to be transferred
    // The positions of the base's vertices [m], #V_base x 3, from those of its own vertices, #V x 3.
    pbs::Positions on_base(const pbs::Positions& positions) const;
    // The largest distance of a vertex of the base from its tets [m].
    double largest_distance_outside_m() const { return points_ ? points_->largest_distance_outside_m : 0.0; }

private:
    std::shared_ptr<const pbs::Character> character_;
    std::optional<pbs::EmbeddedSurface> points_;  // the base's vertices; nothing: they are the first ones
    Eigen::Index base_vertices_ = 0;
};

// A setting's shape in the case's pose.
struct ReachedPoint {
    const Setting* setting = nullptr;
    const BodyMesh* mesh = nullptr;
    Shape shape;             // on its own mesh
    pbs::Positions on_base;  // on the case's own vertices
};

// The clock of a point's times. processor: processor time of this process. own: the times that a deformer in another process states itself.
// wall: the wall time of that process, divided by the number of its poses.
enum class FrameClock { processor, own, wall };

struct PosePair {
    pbs::Pose pose, neighbour;  // neighbour: of the frame before
    double time_step_s = 0.01;
    std::vector<pbs::Pose> way = {};  // the poses before, through which a deformer with memory goes to its first pose
};

class PosedDeformer {
public:
    // The mesh and the poses outlive it. announced_turns: the number of turns that follow reach(); a program computes them in the same
    // call.
    PosedDeformer(const Setting& setting, const BodyMesh& mesh, const PosePair& poses, int announced_turns = 0);

    Shape reach();  // on its own mesh; a deformer with memory takes the way
    // One number, the time of the next frame [ms]. Not a number where the frame did not arrive, or the one before it did not.
    std::vector<double> turn();
    // The work of the first turn, which does not depend on the number of turns; before it, of reach().
    const pbs::WorkCounters& work() const { return work_; }
    bool has_own_clock() const { return has_own_clock_; }
    FrameClock clock() const;  // of the times; known after reach()

private:
    pbs::StepSummary advance(const pbs::Pose& pose);

    const BodyMesh& mesh_;
    const PosePair& poses_;
    std::unique_ptr<Deformer> deformer_;
    pbs::Positions on_base_;  // [m], of the case's own vertices
    pbs::WorkCounters work_;
    bool has_own_clock_;
    int turns_ = 0;
    bool is_there_ = false;  // in the pose
    bool has_arrived_ = true;
};

}  // namespace experiments

template <>
struct analysis::EnumNames<experiments::FrameClock> {
    static constexpr std::array<std::pair<experiments::FrameClock, const char*>, 3> table{
        {{experiments::FrameClock::processor, "processor"},
         {experiments::FrameClock::own, "own"},
         {experiments::FrameClock::wall, "wall"}}};
};
