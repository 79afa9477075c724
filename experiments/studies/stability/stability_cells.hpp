// The cells of the map of stability, by method. full: more values of each factor, and more steps.
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

// A body, a method with its settings, a disturbance, and the factor that the cell varies.
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

// Cells in which one factor takes its values while everything else keeps its base value.
//   const Sweep time_step{"time_step", "s", {1e-4, 0.01, 1.0}, {0.001, 0.1}, [](StabilityCell& cell, double s) { cell.time_step_s = s; }};
//   append(cells, cells_of(time_step, base, full));
struct Sweep {
    using Set = void (*)(StabilityCell& cell, double value);

    std::string factor, unit;
    std::vector<double> values, more;  // more: in the full study only
    Set set;
    bool as_published = true;  // the paper's method with settings that it allows
};

std::vector<StabilityCell> cells_of(const Sweep& sweep, const StabilityCell& base, bool full);
std::vector<StabilityCell> cells_of_map(const Sweep& rows, const Sweep& columns, const StabilityCell& base, bool full);

// The factors that apply to every method.
extern const Sweep time_steps, twists, jumps, teleports, starts, slivers, needles;

void append(std::vector<StabilityCell>& cells, std::vector<StabilityCell> more);

std::vector<StabilityCell> pbs_cells(bool jiggle, bool full);  // on the limb, in both precisions
std::vector<StabilityCell> pbs_character_cells(const std::string& body, bool full);
std::vector<StabilityCell> pbs_map_cells(bool full);  // time step x k_stretch, iterations x twist
std::vector<StabilityCell> negative_controls();       // Eq. 12-20 as printed; distances whose squares overflow
std::vector<StabilityCell> xpbd_cells(bool full);
std::vector<StabilityCell> fem_static_cells(bool full);   // linear, corotational, stable neo-Hookean; in equilibrium
std::vector<StabilityCell> fem_dynamic_cells(bool full);  // corotational, stable neo-Hookean; in time
std::vector<StabilityCell> other_cells(bool full);        // the other deformers, on the limb

// A deformer that is compared with PBS.
struct ComparedKind {
    const char* kind;
    bool minimises;                                // an energy, from an initial guess: cell_table.hpp
    const char* without_start;                     // why it has no broken start, otherwise
    std::vector<const Sweep*> beyond_limits = {};  // settings up to and beyond those for which it is known to converge
};
const std::vector<ComparedKind>& compared_kinds();

// A deformer's settings, changed as a scene would change them, for deformers whose struct of options only their own file knows.
//   cell.spec = with_option(cell.spec, "poisson", 0.499);
bool has_option(const std::string& kind, const std::string& key);  // of the kind's own table

// All other options keep their values. InputError for a value out of its range.
DeformerSpec with_option(const DeformerSpec& spec, const std::string& key, const nlohmann::json& value);

}  // namespace experiments
