// The places where the paper can be read in more than one way, and what it leaves unstated: each reading as options of the same solver and
// as what surrounds it. Reading A of a place is the baseline that a reading names, B is the reading itself.
//   for (const Reading& reading : readings_of_a_step(scene_options)) ...
// Substeps are no reading where nothing jiggles: every step then starts from LBS, and what was before does not count.
#pragma once

#include "pbs/solver/options.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

enum class BindPoint { carried, reprojected };  // a material point of the bone; or the LBS position projected on the posed bone, each step
enum class BlendedBones { nearest_end, either_end };  // Eq. 2's n_joints
enum class ZoneMean { of_all, of_bone };              // whose mean distance a jiggling vertex exceeds

struct Reading {
    std::string place;  // of the paper; empty: a baseline
    std::string name;   // of the reading
    std::string baseline;
    pbs::PbsOptions options;
    BindPoint bind_point = BindPoint::carried;
    BlendedBones blended_bones = BlendedBones::nearest_end;
    ZoneMean zone_mean = ZoneMean::of_all;
    int substeps = 1;  // of each time step
};

nlohmann::json to_json(const Reading& reading);  // whatever its motion depends on

inline constexpr const char* own_reading = "as the scene";  // baselines
inline constexpr const char* jiggling_reading = "jiggling 0.9";

// Of a step by itself, nothing jiggles; the baseline first.
std::vector<Reading> readings_of_a_step(const pbs::PbsOptions& own);
// Of steps that remember the last one: particles that are integrated; both baselines first.
std::vector<Reading> readings_of_motion(const pbs::PbsOptions& own);

}  // namespace experiments
