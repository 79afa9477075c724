// The options of deformers: their names in scenes and records, the options of LBS and DQS, the choice of the code, and
// the keys of PBS.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"
#include "pbs/solver/options.hpp"

namespace experiments {

template <typename Options>
class OptionFields;  // experiments/settings/option_fields.hpp
class SceneValues;

NAMED_OPTIONS(pbs::Precision, f32, f64)

NAMED_OPTIONS(pbs::StartShape, lbs, smooth_dqs)
NAMED_OPTIONS(pbs::Order, plain, ordered, spread)

template <>
inline constexpr NameTable<pbs::MushSmoothing, 2> option_names<pbs::MushSmoothing>{
    {{pbs::MushSmoothing::implicit_steps, "implicit"}, {pbs::MushSmoothing::explicit_steps, "explicit"}}};

NAMED_OPTIONS(pbs::Masses, unit, lumped)
NAMED_OPTIONS(pbs::StiffnessForm, per_iteration, exponent)
NAMED_OPTIONS(pbs::ClassOrder, bind_stretch_volume, bind_volume_stretch, stretch_bind_volume, stretch_volume_bind,
              volume_bind_stretch, volume_stretch_bind)
NAMED_OPTIONS(pbs::LbsEntry, start, increment)
NAMED_OPTIONS(pbs::BindOnBone, pinned, unbound)
NAMED_OPTIONS(pbs::BindPoint, carried, reprojected)
NAMED_OPTIONS(pbs::ZoneMean, of_all, of_bone)
NAMED_OPTIONS(pbs::BindTo, bone_distance, blended_position)
NAMED_OPTIONS(pbs::VolumeOf, tets, regions, tets_and_regions)
NAMED_OPTIONS(pbs::VolumeForm, derived, labels_relative, labels_absolute, sign, as_printed)

inline constexpr const char* start_meaning =
    "the shape at which a frame begins: lbs: linear blend skinning, as in the paper; smooth_dqs: dual quaternion "
    "skinning with weights "
    "that springs around the bones determine, as energy minimisation begins by default";

// Options of LBS and DQS.
//   options_of<BlendOptions>(spec).precision = pbs::Precision::f32;
struct BlendOptions {
    // f32 blends relative to the middle of the body and differs from f64 by rounding.
    pbs::Precision precision = pbs::Precision::f64;
    // true: pbs::BlendSkinning. false: the blends of pbs/skinning/blend.hpp, one vertex after the other, in double
    // only.
    bool packed = true;
};

// The keys `precision` and `packed` of a table, for plain code exists in f64 alone: what the scene does not state
// follows from what it states. InputError where it states precision f32 and packed false.
void agree_on_code(const SceneValues& values, const std::string& table, pbs::Precision& precision, bool& packed);

// The material points that the options bind the vertices to, posed [m], #V x 3. lbs: the vertices by linear blend
// skinning [m], #V x 3.
pbs::Positions bind_points_of(const pbs::PbsOptions& options, const pbs::Character& character, const pbs::Pose& pose,
                              const pbs::Positions& lbs);

// The keys of PBS in scenes.
const OptionFields<pbs::PbsOptions>& pbs_fields();
// InputError for keys that contradict each other. Sets the variant.
void check_pbs(const SceneValues& values, const std::string& table, pbs::PbsOptions& options, DeformerSpec& spec);

}  // namespace experiments
