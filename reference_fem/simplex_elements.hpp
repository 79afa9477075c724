// deal.II's side of a SimplexSpace. To be included by simplex_space.cpp and assembly.cpp only: it takes some 20 s to compile.
// The requirements of deal.II 9.4.1 on tets: MappingFE everywhere (the default mapping crashes), QGaussSimplex<3>(n) with n <= 4.
#pragma once

#include "reference_fem/simplex_space.hpp"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>

namespace reference_fem {

// Stays where it is made: the handler refers to the triangulation.
struct SimplexSpace::Elements {
    // 1 or 2; the triangulation is filled later, by the space.
    explicit Elements(int element_order)
        : element(dealii::FE_SimplexP<3>(element_order), 3), mapping(dealii::FE_SimplexP<3>(1)), dof_handler(triangulation)
    {
    }

    dealii::Triangulation<3> triangulation;  // cell t is tet t of the mesh
    dealii::FESystem<3> element;             // three components of FE_SimplexP
    dealii::MappingFE<3> mapping;            // of straight tets
    dealii::DoFHandler<3> dof_handler;       // renumbered: 3 n + c is component c at node n
};

}  // namespace reference_fem
