#include "experiments/work_precision/body_mesh.hpp"

namespace experiments {

BodyMesh::BodyMesh(pbs::CharacterSource source, int vertices, const pbs::Character& base)
{
    source.vertices = vertices;
    character_ = std::make_shared<pbs::Character>(pbs::make_character(source));
    points_ = pbs::embed(base.mesh.rest, pbs::Triangles(0, 3), character_->mesh);
}

pbs::Positions BodyMesh::on_base(const pbs::Positions& positions) const
{
    return points_ ? pbs::embedded_positions(*points_, positions, character_->mesh.tets) : positions;
}

}  // namespace experiments
