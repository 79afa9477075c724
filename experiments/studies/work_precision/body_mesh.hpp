// A mesh of a case's body: its own, or a coarser or finer one, on which shapes are carried to the vertices of its own. So errors on all
// meshes are measured at the same points of the flesh, by the same ruler.
//   const BodyMesh coarse(source, 600, base);
//   base_ruler.measure(coarse.on_base(positions), reference);
#pragma once

#include "pbs/character/bodies.hpp"

#include <memory>

namespace experiments {

class BodyMesh {
public:
    explicit BodyMesh(std::shared_ptr<const pbs::Character> base)
        : character_(std::move(base)), base_vertices_(character_->mesh.rest.rows())
    {
    }
    // Another mesh of about so many vertices; where it ends a little before the base's surface, its tets are extended.
    BodyMesh(pbs::CharacterSource source, int vertices, const pbs::Character& base);
    // Every tet of the base cut into eight; its first vertices are the base's.
    static BodyMesh refined(const pbs::Character& base);

    const pbs::Character& character() const { return *character_; }
    // From positions of its own vertices [m], #V x 3, where the base's vertices are, #V_base x 3.
    pbs::Positions on_base(const pbs::Positions& positions) const;
    // The farthest that a vertex of the base lies outside its tets [m].
    double largest_distance_outside_m() const { return points_ ? points_->largest_distance_outside_m : 0.0; }

private:
    std::shared_ptr<const pbs::Character> character_;
    std::optional<pbs::EmbeddedSurface> points_;  // the base's vertices; nothing: they are the first ones
    Eigen::Index base_vertices_ = 0;
};

}  // namespace experiments
