// Conversion of CGAL's complexes to our arrays. Only the meshing .cpp files include this.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <unordered_map>
#include <vector>

namespace pbs {

// Exact predicates, double coordinates.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// CGAL prints a warning when no refinement can begin. Callers see the empty complex and choose another way to begin.
class WithoutCgalWarnings {
public:
    WithoutCgalWarnings() : previous_(CGAL::set_warning_handler([](const char*, const char*, const char*, int, const char*) {})) {}
    ~WithoutCgalWarnings() { CGAL::set_warning_handler(previous_); }
    WithoutCgalWarnings(const WithoutCgalWarnings&) = delete;
    WithoutCgalWarnings& operator=(const WithoutCgalWarnings&) = delete;

private:
    CGAL::Failure_function previous_;
};

// Refines and no more. make_mesh_3 would limit the optimisers to the seconds that the refinement took; called by themselves they end by
// themselves, and the same way each time.
template <typename Complex, class Domain, class Criteria, class... Refinement>
Complex refine_mesh(const Domain& domain, const Criteria& criteria, const Refinement&... refinement)
{
    CGAL::get_default_random() = CGAL::Random(0);  // instead of the clock: a fixed seed makes meshing repeat to the bit
    const WithoutCgalWarnings quiet;
    namespace parameters = CGAL::parameters;
    return CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_perturb(), parameters::no_exude(), refinement...);
}

// Perturbs and exudes. sliver_bound_deg: dihedral angles above it are good enough; 0: as good as they get.
template <typename Complex, class Domain>
void optimise_mesh(Complex& complex, const Domain& domain, double sliver_bound_deg)
{
    CGAL::perturb_mesh_3(complex, domain, CGAL::parameters::sliver_bound = sliver_bound_deg);
    CGAL::exude_mesh_3(complex, CGAL::parameters::sliver_bound = sliver_bound_deg);
}

// Vertices are numbered as the cells first name them; cells come in the order of the triangulation's container.
template <typename Complex>
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
