// One cell of the map of stability: a body, a method with its settings, a disturbance, and the factor that the cell varies.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/settings/option_names.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

// The shape that the first step receives instead of the blended one. none: the blended one.
enum class Start { none, flattened, mirrored, random, point };

// The body begins at rest in the first pose of its motion and stays in the last. A limb's forearm turns about `axis` (rest world axes) to
// angle_deg in even steps; a character lands from a jump, 36 steps of its clip. In other cells the whole body is moved in one step, or its
// initial shape is broken.
struct Disturbance {
    pbs::Vec3 axis = pbs::Vec3::UnitZ();
    double angle_deg = 90.0;
    int turning_steps = 10;
    double teleport_m = 0.0;  // along (1, 1, 1)
    Start start = Start::none;
    bool stays = false;  // in the last pose from the beginning
};

// Tets that are distorted before anything is bound: a seeded share of the vertices is moved until a tet at each is thin.
enum class Defect { none, slivers, needles };

template <>
struct OptionNames<Start> {
    static constexpr std::array<std::pair<Start, const char*>, 5> table{{{Start::none, "none"},
                                                                         {Start::flattened, "flattened"},
                                                                         {Start::mirrored, "mirrored"},
                                                                         {Start::random, "random"},
                                                                         {Start::point, "point"}}};
};
template <>
struct OptionNames<Defect> {
    static constexpr std::array<std::pair<Defect, const char*>, 3> table{
        {{Defect::none, "none"}, {Defect::slivers, "slivers"}, {Defect::needles, "needles"}}};
};

inline constexpr double g_m_s2 = 9.81;  // one g

// The seed of masses, distorted tets and random initial shapes.
inline constexpr unsigned stability_seed = 20140528;

struct StabilityCell {
    std::string body = "limb";  // or a character
    std::string model, factor;  // e.g. pbs_jiggle, time_step
    double value = 0.0;
    std::string unit;
    std::string second_factor = {};  // of a map
    double second_value = 0.0;
    std::string second_unit = {};
    std::string named = {};  // value of a factor without numbers: flattened

    DeformerSpec spec;
    Disturbance disturbance;
    double time_step_s = 0.01;
    int still_steps = 100;
    Defect defect = Defect::none;
    double thinness = 1.0;    // share of the height or edge that the moved vertices keep
    double mass_ratio = 1.0;  // heaviest over lightest particle of a PBS body, seeded
    bool held_end = false;    // a tenth of the limb has infinite mass
    // The whole body is moved along x by this length in every second step, for a method that does not step a pose that equals the last one.
    double nudge_m = 0.0;

    bool as_published = false;  // the paper's method with settings that it allows; C08 is judged by these cells
};

std::string precision_of(const StabilityCell& cell);  // f32, f64
nlohmann::json to_json(const Disturbance& disturbance);
nlohmann::json to_json(const StabilityCell& cell);  // all members
std::string setting_of(const StabilityCell& cell);  // body, method, place and last pose: all members except those of the way to it

}  // namespace experiments
