// Which of a case's shapes is the truth, and how far it may be from the limit on ever finer tets.
#pragma once

#include "analysis/error_norms.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/body_mesh.hpp"
#include "experiments/studies/work_precision/point_setting.hpp"

namespace experiments {

// A setting's shape in the case's pose.
struct ReachedPoint {
    const PointSetting* setting = nullptr;
    const BodyMesh* mesh = nullptr;
    Shape shape;             // on its own mesh
    pbs::Positions on_base;  // on the case's own vertices
};

struct ReachedReference {
    const ReachedPoint* point = nullptr;      // null: none was reached
    const ReachedPoint* beside = nullptr;     // the second solution; null: none, and no bar
    std::optional<analysis::ErrorNorms> bar;  // bound of its distance from the limit
};

// Stable neo-Hookean: quadratic on the case's own tets, or else linear there. Beside it, for the bar: of a quadratic one the quadratic one
// on the finest coarser mesh, or else the linear one; of a linear one that on tets cut into eight, or else on the finest coarser mesh.
// Order 1 is presumed, whatever the elements (reference_error_bar.hpp says why).
ReachedReference choose_reference(const std::vector<ReachedPoint>& points, Eigen::Index base_vertices, const analysis::ErrorRuler& ruler);

}  // namespace experiments
