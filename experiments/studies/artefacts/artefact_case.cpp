#include "experiments/studies/artefacts/artefact_case.hpp"

#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <utility>

namespace experiments {
namespace {

const std::vector<std::string> profile_columns = {"body",
                                                  "vertices",
                                                  "pose",
                                                  "joint",
                                                  "deformer",
                                                  "order",
                                                  "precision",
                                                  "offset_m",
                                                  "area_over_rest",
                                                  "smallest_radius_over_rest",
                                                  "largest_radius_over_rest",
                                                  "outlines",
                                                  "limb_share"};
const std::vector<std::string> intersection_columns = {"body",      "vertices", "pose",      "deformer", "order",
                                                       "precision", "surface",  "triangles", "pairs",    "pairs_at_rest"};

Scene with_vertices(Scene scene, int vertices)
{
    if (vertices > 0) scene.character.vertices = vertices;
    return scene;
}

std::vector<int> frames_of(const ArtefactCase& of)
{
    std::vector<int> frames;
    for (const ArtefactPose& pose : of.poses) frames.push_back(pose.frame);
    return frames;
}

std::string group_of(const DeformerSpec& spec)
{
    return options_if<FemOptions>(spec) ? "reference" : spec.kind;
}

// Of finite elements; 0 of other deformers.
int element_order_of(const DeformerSpec& spec)
{
    const FemOptions* fem = options_if<FemOptions>(spec);
    return fem ? fem->element_order : 0;
}

// Deformers whose sections are part of a claim.
bool is_on_other_meshes(const DeformerSpec& spec)
{
    static const std::set<std::string> claimed = {"lbs", "dqs", "pbs"};
    return claimed.contains(spec.kind) || element_order_of(spec) == 1;
}

class Search {
public:
    explicit Search(const ArtefactCase& of)
        : of_(of), records_{{}, analysis::CsvTable(profile_columns), analysis::CsvTable(intersection_columns), {}}
    {
    }

    void look_at(const ArtefactBody& body, const DeformerSpec& spec, bool with_intersections)
    {
        const Shapes shapes = body.posed.shapes(spec, poses_of(spec));
        for (std::size_t pose = 0; pose < shapes.size(); ++pose) {
            if (!shapes[pose].finished) {
                records_.breakdown += fmt::format("{} in {}. ", spec.label, of_.poses[pose].name);
                continue;
            }
            for (std::size_t joint = 0; joint < body.joints.size(); ++joint) add_profile(body, spec, shapes[pose], pose, joint);
            if (with_intersections) add_intersections(body, spec, shapes[pose], pose);
        }
    }

    ArtefactRecords records() && { return std::move(records_); }

private:
    std::vector<analysis::CsvTable::Cell> row_head(const ArtefactBody& body, std::size_t pose) const
    {
        const pbs::Character& character = body.posed.character();
        return {character.name, static_cast<int>(character.mesh.rest.rows()), of_.poses[pose].name};
    }

    std::optional<std::size_t> poses_of(const DeformerSpec& spec) const
    {
        if (element_order_of(spec) < 2) return {};
        return static_cast<std::size_t>(of_.second_order_poses);
    }

    static void add_deformer(std::vector<analysis::CsvTable::Cell>& row, const DeformerSpec& spec)
    {
        row.push_back(spec.name);
        for (const std::string& setting : projection_of(spec)) row.push_back(setting);
    }

    void add_profile(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose, std::size_t joint)
    {
        const JointProfile profile = body.sections[joint].measure(shape.positions, body.posed.pose(pose));
        records_.samples.push_back({group_of(spec), pose, joint, extremes_of(profile), element_order_of(spec)});
        for (const JointSection& section : profile) {
            auto row = row_head(body, pose);
            row.push_back(body.joints[joint].name);
            add_deformer(row, spec);
            row.insert(row.end(), {section.offset_m, section.area, section.smallest_radius, section.largest_radius, section.outlines,
                                   section.limb_share});
            records_.profiles.add_row(row);
        }
    }

    void add_intersections(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose)
    {
        const pbs::Character& character = body.posed.character();
        const pbs::Positions own = shape.positions.topRows(character.mesh.rest.rows());
        add_count(body, spec, pose, "tets' boundary", body.posed.boundary(), own, character.mesh.rest);
        if (!character.surface) return;
        const auto embedded = [&](const pbs::Positions& x) { return pbs::embedded_positions(*character.surface, x, character.mesh.tets); };
        add_count(body, spec, pose, "rendered", character.surface->triangles, embedded(own), embedded(character.mesh.rest));
    }

    void add_count(const ArtefactBody& body, const DeformerSpec& spec, std::size_t pose, const std::string& surface,
                   const pbs::Triangles& triangles, const pbs::Positions& now, const pbs::Positions& rest)
    {
        const auto [at_rest, is_new] = at_rest_.try_emplace(surface, 0);
        if (is_new) at_rest->second = pbs::count_self_intersections(rest, triangles);
        auto row = row_head(body, pose);
        add_deformer(row, spec);
        row.insert(row.end(),
                   {surface, static_cast<int>(triangles.rows()), pbs::count_self_intersections(now, triangles), at_rest->second});
        records_.intersections.add_row(row);
    }

    const ArtefactCase& of_;
    std::map<std::string, int> at_rest_;  // pairs of the body's own surfaces
    ArtefactRecords records_;
};

}  // namespace

std::array<std::string, 2> projection_of(const DeformerSpec& spec)
{
    const auto* pbs = options_if<pbs::PbsOptions>(spec);
    if (!pbs) return {};
    return {name_of(pbs->order), name_of(pbs->precision)};
}

std::vector<DeformerSpec> other_orders(const DeformerSpec& pbs)
{
    std::vector<DeformerSpec> others;
    const auto& own = options_of<pbs::PbsOptions>(pbs);
    for (const pbs::Precision precision : {pbs::Precision::f32, pbs::Precision::f64})
        for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::grouped, pbs::Order::plain}) {
            if (order == own.order && precision == own.precision) continue;
            others.push_back(pbs);
            options_of<pbs::PbsOptions>(others.back()).order = order;
            options_of<pbs::PbsOptions>(others.back()).precision = precision;
        }
    return others;
}

ArtefactBody::ArtefactBody(const ArtefactCase& of, int vertices) : posed(with_vertices(of.scene, vertices), frames_of(of))
{
    for (const LimbJoint& joint : limb_joints(posed.character()))
        if (of.joint.empty() || of.joint == joint.name) joints.push_back(joint);
    for (const LimbJoint& joint : joints) sections.emplace_back(posed.character(), joint);
}

ArtefactRecords find_artefacts(const ArtefactCase& of, const ArtefactBody& body)
{
    Search search(of);
    for (const DeformerSpec& spec : of.scene.deformers) search.look_at(body, spec, true);
    for (const DeformerSpec& spec : other_orders(spec_of(of.scene, "pbs"))) search.look_at(body, spec, false);
    for (const int vertices : of.vertices) {
        const ArtefactBody other(of, vertices);
        for (const DeformerSpec& spec : of.scene.deformers)
            if (is_on_other_meshes(spec)) search.look_at(other, spec, false);
    }
    return std::move(search).records();
}

}  // namespace experiments
