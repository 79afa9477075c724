// The names of the deformers' options in scenes and records, and the options that are declared here: those of LBS and DQS, and the keys of
// PBS.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/geometry/precision.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {

template <typename Options>
class OptionFields;  // experiments/settings/option_fields.hpp
class SceneValues;

template <>
struct OptionNames<pbs::Precision> {
    static constexpr std::array<std::pair<pbs::Precision, const char*>, 2> table{
        {{pbs::Precision::f32, "f32"}, {pbs::Precision::f64, "f64"}}};
};

template <>
struct OptionNames<pbs::Order> {
    static constexpr std::array<std::pair<pbs::Order, const char*>, 3> table{
        {{pbs::Order::plain, "plain"}, {pbs::Order::ordered, "ordered"}, {pbs::Order::grouped, "grouped"}}};
};

template <>
struct OptionNames<pbs::MushSmoothing> {
    static constexpr std::array<std::pair<pbs::MushSmoothing, const char*>, 2> table{
        {{pbs::MushSmoothing::implicit_steps, "implicit"}, {pbs::MushSmoothing::explicit_steps, "explicit"}}};
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

// Options of LBS and DQS.
//   options_of<BlendOptions>(spec).precision = pbs::Precision::f32;
struct BlendOptions {
    // f32 blends relative to the middle of the body and differs from f64 by rounding.
    pbs::Precision precision = pbs::Precision::f64;
    // true: pbs::BlendSkinning. false: the blends of pbs/skinning/blend.hpp, one vertex after the other, in double only.
    bool packed = true;
};

// The keys of PBS in scenes.
const OptionFields<pbs::PbsOptions>& pbs_fields();
// Sets the options of PBS and the variant.
void read_pbs(const SceneValues& values, const std::string& table, DeformerSpec& spec);

}  // namespace experiments
