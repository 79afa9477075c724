#include "experiments/studies/work_precision/body_mesh.hpp"

#include "pbs/character/character.hpp"

namespace experiments {

namespace {

std::shared_ptr<pbs::Character> character_with(pbs::CharacterSource source, int vertices)
{
    source.vertices = vertices;
    return std::make_shared<pbs::Character>(pbs::make_character(source));
}

}  // namespace

BodyMesh::BodyMesh(const pbs::CharacterSource& source, int vertices, const pbs::Character& base)
    : character_(character_with(source, vertices)), base_vertices_(base.mesh.rest.rows())
{
    points_ = pbs::embed(base.mesh.rest, pbs::Triangles(0, 3), character_->mesh);
}

BodyMesh BodyMesh::refined(const pbs::Character& base)
{
    BodyMesh fine(std::make_shared<pbs::Character>(pbs::refined(base)));
    fine.base_vertices_ = base.mesh.rest.rows();
    return fine;
}

pbs::Positions BodyMesh::on_base(const pbs::Positions& positions) const
{
    return points_ ? pbs::embedded_positions(*points_, positions, character_->mesh.tets)
                   : pbs::Positions(positions.topRows(base_vertices_));
}

}  // namespace experiments
