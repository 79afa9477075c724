// The rendered surface of a run's frames and the tets that carry it, for programs that move the surface with the tets:
//   surface_rest.vtp   the surface at rest [m]
//   embedding.csv      the tet that carries each of its points, with the point's barycentric coordinates
#pragma once

#include "analysis/records/tables.hpp"
#include "pbs/character/character.hpp"

namespace experiments {

struct EmbeddedPoint {
    int point = 0, tet = 0;
    std::array<double, 4> barycentric = {};  // their sum is one; for a point outside its tet some are negative
};
extern const analysis::Columns<EmbeddedPoint> embedding_columns;

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface);

// Writes both files into the folder of a run.
void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const std::string& folder);

}  // namespace experiments
