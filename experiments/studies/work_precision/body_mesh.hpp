// The meshes of a case's body, and the shapes that the settings reach on them.
#pragma once

#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/point_setting.hpp"
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
    const PointSetting* setting = nullptr;
    const BodyMesh* mesh = nullptr;
    Shape shape;             // on its own mesh
    pbs::Positions on_base;  // on the case's own vertices
};

}  // namespace experiments
