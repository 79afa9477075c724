// The names of the values of the reference's options in scenes and records.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/settings/option_names.hpp"

namespace experiments {

template <>
struct OptionNames<reference_fem::Model> {
    static constexpr std::array<std::pair<reference_fem::Model, const char*>, 5> table{
        {{reference_fem::Model::linear, "linear"},
         {reference_fem::Model::corotational, "corotational"},
         {reference_fem::Model::stable_neo_hookean, "stable_neo_hookean"},
         {reference_fem::Model::neo_hookean, "neo_hookean"},
         {reference_fem::Model::st_venant_kirchhoff, "st_venant_kirchhoff"}}};
};
template <>
struct OptionNames<reference_fem::Formulation> {
    static constexpr std::array<std::pair<reference_fem::Formulation, const char*>, 3> table{
        {{reference_fem::Formulation::displacement, "displacement"},
         {reference_fem::Formulation::mean_dilatation, "mean_dilatation"},
         {reference_fem::Formulation::taylor_hood, "taylor_hood"}}};
};
template <>
struct OptionNames<reference_fem::Dynamics> {
    static constexpr std::array<std::pair<reference_fem::Dynamics, const char*>, 3> table{
        {{reference_fem::Dynamics::quasi_static, "quasi_static"},
         {reference_fem::Dynamics::newmark, "newmark"},
         {reference_fem::Dynamics::generalized_alpha, "generalized_alpha"}}};
};
template <>
struct OptionNames<FemAttachment> {
    static constexpr std::array<std::pair<FemAttachment, const char*>, 4> table{{{FemAttachment::smooth, "smooth"},
                                                                                 {FemAttachment::embedded, "embedded"},
                                                                                 {FemAttachment::nodes, "nodes"},
                                                                                 {FemAttachment::bind, "bind"}}};
};
template <>
struct OptionNames<pbs::AttachmentKernel> {
    static constexpr std::array<std::pair<pbs::AttachmentKernel, const char*>, 2> table{
        {{pbs::AttachmentKernel::biweight, "biweight"}, {pbs::AttachmentKernel::wendland, "wendland"}}};
};
template <>
struct OptionNames<reference_fem::LinearSolver> {
    static constexpr std::array<std::pair<reference_fem::LinearSolver, const char*>, 3> table{
        {{reference_fem::LinearSolver::cholmod, "cholmod"},
         {reference_fem::LinearSolver::umfpack, "umfpack"},
         {reference_fem::LinearSolver::cg_ml, "cg_ml"}}};
};

}  // namespace experiments
