// The names of the options of PBS in scenes and records.
#pragma once

#include "experiments/deformers/order_names.hpp"
#include "experiments/deformers/precision_names.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {

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
struct OptionNames<pbs::BindTo> {
    static constexpr std::array<std::pair<pbs::BindTo, const char*>, 2> table{
        {{pbs::BindTo::bone_distance, "bone_distance"}, {pbs::BindTo::blended_position, "blended_position"}}};
};
template <>
struct OptionNames<pbs::VolumeOf> {
    static constexpr std::array<std::pair<pbs::VolumeOf, const char*>, 3> table{
        {{pbs::VolumeOf::tets, "tets"}, {pbs::VolumeOf::regions, "regions"}, {pbs::VolumeOf::tets_and_regions, "tets_and_regions"}}};
};
template <>
struct OptionNames<pbs::VolumeForm> {
    static constexpr std::array<std::pair<pbs::VolumeForm, const char*>, 5> table{{{pbs::VolumeForm::derived, "derived"},
                                                                                   {pbs::VolumeForm::labels_relative, "labels_relative"},
                                                                                   {pbs::VolumeForm::labels_absolute, "labels_absolute"},
                                                                                   {pbs::VolumeForm::sign, "sign"},
                                                                                   {pbs::VolumeForm::as_printed, "as_printed"}}};
};

}  // namespace experiments
