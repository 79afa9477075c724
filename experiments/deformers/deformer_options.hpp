// The names of the deformers' options in scenes and records, and the options of LBS and DQS.
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
inline constexpr NameTable<pbs::Precision, 2> option_names<pbs::Precision>{{{pbs::Precision::f32, "f32"}, {pbs::Precision::f64, "f64"}}};

template <>
inline constexpr NameTable<pbs::Order, 3> option_names<pbs::Order>{
    {{pbs::Order::plain, "plain"}, {pbs::Order::ordered, "ordered"}, {pbs::Order::grouped, "grouped"}}};

template <>
inline constexpr NameTable<pbs::MushSmoothing, 2> option_names<pbs::MushSmoothing>{
    {{pbs::MushSmoothing::implicit_steps, "implicit"}, {pbs::MushSmoothing::explicit_steps, "explicit"}}};

template <>
inline constexpr NameTable<pbs::Masses, 2> option_names<pbs::Masses>{{{pbs::Masses::unit, "unit"}, {pbs::Masses::lumped, "lumped"}}};
template <>
inline constexpr NameTable<pbs::StiffnessForm, 2> option_names<pbs::StiffnessForm>{
    {{pbs::StiffnessForm::per_iteration, "per_iteration"}, {pbs::StiffnessForm::exponent, "exponent"}}};
template <>
inline constexpr NameTable<pbs::ClassOrder, 6> option_names<pbs::ClassOrder>{
    {{pbs::ClassOrder::bind_stretch_volume, "bind_stretch_volume"},
     {pbs::ClassOrder::bind_volume_stretch, "bind_volume_stretch"},
     {pbs::ClassOrder::stretch_bind_volume, "stretch_bind_volume"},
     {pbs::ClassOrder::stretch_volume_bind, "stretch_volume_bind"},
     {pbs::ClassOrder::volume_bind_stretch, "volume_bind_stretch"},
     {pbs::ClassOrder::volume_stretch_bind, "volume_stretch_bind"}}};
template <>
inline constexpr NameTable<pbs::LbsEntry, 2> option_names<pbs::LbsEntry>{
    {{pbs::LbsEntry::start, "start"}, {pbs::LbsEntry::increment, "increment"}}};
template <>
inline constexpr NameTable<pbs::BindOnBone, 2> option_names<pbs::BindOnBone>{
    {{pbs::BindOnBone::pinned, "pinned"}, {pbs::BindOnBone::unbound, "unbound"}}};
template <>
inline constexpr NameTable<pbs::BindPoint, 2> option_names<pbs::BindPoint>{
    {{pbs::BindPoint::carried, "carried"}, {pbs::BindPoint::reprojected, "reprojected"}}};
template <>
inline constexpr NameTable<pbs::ZoneMean, 2> option_names<pbs::ZoneMean>{
    {{pbs::ZoneMean::of_all, "of_all"}, {pbs::ZoneMean::of_bone, "of_bone"}}};
template <>
inline constexpr NameTable<pbs::BindTo, 2> option_names<pbs::BindTo>{
    {{pbs::BindTo::bone_distance, "bone_distance"}, {pbs::BindTo::blended_position, "blended_position"}}};
template <>
inline constexpr NameTable<pbs::VolumeOf, 3> option_names<pbs::VolumeOf>{
    {{pbs::VolumeOf::tets, "tets"}, {pbs::VolumeOf::regions, "regions"}, {pbs::VolumeOf::tets_and_regions, "tets_and_regions"}}};
template <>
inline constexpr NameTable<pbs::VolumeForm, 5> option_names<pbs::VolumeForm>{{{pbs::VolumeForm::derived, "derived"},
                                                                              {pbs::VolumeForm::labels_relative, "labels_relative"},
                                                                              {pbs::VolumeForm::labels_absolute, "labels_absolute"},
                                                                              {pbs::VolumeForm::sign, "sign"},
                                                                              {pbs::VolumeForm::as_printed, "as_printed"}}};

// Options of LBS and DQS.
//   options_of<BlendOptions>(spec).precision = pbs::Precision::f32;
struct BlendOptions {
    // f32 blends relative to the middle of the body and differs from f64 by rounding.
    pbs::Precision precision = pbs::Precision::f64;
    // true: pbs::BlendSkinning. false: the blends of pbs/skinning/blend.hpp, one vertex after the other, in double only.
    bool packed = true;
};

// The keys `precision` and `packed` of a table, for plain code exists in f64 alone: what the scene does not state follows from what it
// states. InputError where it states precision f32 and packed false.
void agree_on_code(const SceneValues& values, const std::string& table, pbs::Precision& precision, bool& packed);

// The material points that the options bind the vertices to, posed [m], #V x 3. lbs: the vertices by linear blend skinning [m], #V x 3.
pbs::Positions bind_points_of(const pbs::PbsOptions& options, const pbs::Character& character, const pbs::Pose& pose,
                              const pbs::Positions& lbs);

// The keys of PBS in scenes.
const OptionFields<pbs::PbsOptions>& pbs_fields();
// InputError for keys that contradict each other. Sets the variant.
void check_pbs(const SceneValues& values, const std::string& table, pbs::PbsOptions& options, DeformerSpec& spec);

}  // namespace experiments
