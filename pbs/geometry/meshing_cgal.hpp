// From CGAL's complexes to our arrays. Seen by the meshing .cpp files alone.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>

#include <unordered_map>
#include <vector>

namespace pbs {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// CGAL seeds its generator with the clock; a fixed seed makes meshing repeat to the bit.
inline void fix_meshing_seed()
{
    CGAL::get_default_random() = CGAL::Random(0);
}

// Vertices are numbered as the cells first name them; cells come in the order of the triangulation's container.
template <class Complex>
TetMesh tet_mesh_of(const Complex& complex)
{
    TetMesh mesh;
    mesh.tets.resize(static_cast<Eigen::Index>(complex.number_of_cells_in_complex()), 4);
    std::unordered_map<const void*, int> index_of;
    std::vector<Vec3> points;
    Eigen::Index t = 0;
    for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell, ++t)
        for (int corner = 0; corner < 4; ++corner) {
            const auto vertex = cell->vertex(corner);
            const auto [entry, is_new] = index_of.emplace(&*vertex, static_cast<int>(points.size()));
            if (is_new) points.emplace_back(vertex->point().x(), vertex->point().y(), vertex->point().z());
            mesh.tets(t, corner) = entry->second;
        }
    mesh.rest.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) mesh.rest.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
    return mesh;
}

}  // namespace pbs
