// The rendered surface of a run's frames and what carries it, for whoever moves it by the tets:
//   surface_rest.vtp   the surface at rest [m]
//   embedding.csv      point, tet, barycentric_0 ... barycentric_3   of each of its points: the tet that carries it and
//                      the share of each of the tet's corners, in the order of the frames' .vtu. Shares sum to one; for a
//                      point outside its tet some are negative
#pragma once

#include "analysis/records/csv_table.hpp"
#include "pbs/character/character.hpp"

#include <string>

namespace experiments {

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface);

// Both files, into a run's folder.
void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const std::string& folder);

}  // namespace experiments
