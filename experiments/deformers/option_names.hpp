// The words that options have in scenes and records.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/solver/options.hpp"

#include <array>
#include <string>
#include <utility>

namespace experiments {

template <typename Enum>
struct OptionNames;

template <>
struct OptionNames<pbs::Order> {
    static constexpr std::array<std::pair<pbs::Order, const char*>, 3> table{
        {{pbs::Order::ordered, "ordered"}, {pbs::Order::grouped, "grouped"}, {pbs::Order::plain, "plain"}}};
};
template <>
struct OptionNames<pbs::Precision> {
    static constexpr std::array<std::pair<pbs::Precision, const char*>, 2> table{
        {{pbs::Precision::f32, "f32"}, {pbs::Precision::f64, "f64"}}};
};
template <>
struct OptionNames<pbs::Masses> {
    static constexpr std::array<std::pair<pbs::Masses, const char*>, 2> table{
        {{pbs::Masses::unit, "unit"}, {pbs::Masses::lumped, "lumped"}}};
};
template <>
struct OptionNames<pbs::StiffnessForm> {
    static constexpr std::array<std::pair<pbs::StiffnessForm, const char*>, 2> table{
        {{pbs::StiffnessForm::per_iteration, "per_iteration"}, {pbs::StiffnessForm::exponent, "exponent"}}};
};
template <>
struct OptionNames<pbs::ClassOrder> {
    static constexpr std::array<std::pair<pbs::ClassOrder, const char*>, 6> table{
        {{pbs::ClassOrder::bind_stretch_volume, "bind_stretch_volume"},
         {pbs::ClassOrder::bind_volume_stretch, "bind_volume_stretch"},
         {pbs::ClassOrder::stretch_bind_volume, "stretch_bind_volume"},
         {pbs::ClassOrder::stretch_volume_bind, "stretch_volume_bind"},
         {pbs::ClassOrder::volume_bind_stretch, "volume_bind_stretch"},
         {pbs::ClassOrder::volume_stretch_bind, "volume_stretch_bind"}}};
};
template <>
struct OptionNames<pbs::LbsEntry> {
    static constexpr std::array<std::pair<pbs::LbsEntry, const char*>, 2> table{
        {{pbs::LbsEntry::start, "start"}, {pbs::LbsEntry::increment, "increment"}}};
};
template <>
struct OptionNames<pbs::BindOnBone> {
    static constexpr std::array<std::pair<pbs::BindOnBone, const char*>, 2> table{
        {{pbs::BindOnBone::pinned, "pinned"}, {pbs::BindOnBone::unbound, "unbound"}}};
};
template <>
struct OptionNames<pbs::VolumeForm> {
    static constexpr std::array<std::pair<pbs::VolumeForm, const char*>, 5> table{{{pbs::VolumeForm::derived, "derived"},
                                                                                   {pbs::VolumeForm::labels_relative, "labels_relative"},
                                                                                   {pbs::VolumeForm::labels_absolute, "labels_absolute"},
                                                                                   {pbs::VolumeForm::sign, "sign"},
                                                                                   {pbs::VolumeForm::as_printed, "as_printed"}}};
};
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
    static constexpr std::array<std::pair<FemAttachment, const char*>, 3> table{
        {{FemAttachment::embedded, "embedded"}, {FemAttachment::nodes, "nodes"}, {FemAttachment::bind, "bind"}}};
};
template <>
struct OptionNames<reference_fem::LinearSolver> {
    static constexpr std::array<std::pair<reference_fem::LinearSolver, const char*>, 3> table{
        {{reference_fem::LinearSolver::cholmod, "cholmod"},
         {reference_fem::LinearSolver::umfpack, "umfpack"},
         {reference_fem::LinearSolver::cg_ml, "cg_ml"}}};
};

template <typename Enum>
std::string name_of(Enum value)
{
    for (const auto& [entry, name] : OptionNames<Enum>::table)
        if (entry == value) return name;
    return "";
}

template <typename Enum>
Enum option_of(const std::string& name)  // the schema has checked the name
{
    for (const auto& [entry, text] : OptionNames<Enum>::table)
        if (name == text) return entry;
    return OptionNames<Enum>::table.front().first;
}

}  // namespace experiments
