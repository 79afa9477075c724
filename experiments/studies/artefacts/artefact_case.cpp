#include "experiments/studies/artefacts/artefact_case.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <utility>

namespace experiments {

using analysis::Columns;
using analysis::within;

namespace {

const Columns<JointSection> joint_section_columns = {
    {"offset_m", &JointSection::offset_m, "m", "distance of the cross-section from the joint along the bones; negative: on the parent"},
    {"area_over_rest", &JointSection::area, "", "area of the cross-section over that at rest"},
    {"smallest_radius_over_rest", &JointSection::smallest_radius, "", "smallest radius of its outline over that at rest"},
    {"largest_radius_over_rest", &JointSection::largest_radius, "", "largest radius of its outline over that at rest"},
    {"outlines", &JointSection::outlines, "", "number of closed outlines in the plane"},
    {"limb_share", &JointSection::limb_share, "", "share of the outline that belongs to the limb itself"}};

}  // namespace

const Columns<ProfileRow> profile_columns =
    within(&ProfileRow::place, artefact_place_columns) + Columns<ProfileRow>{{"joint", &ProfileRow::joint, "", "name of the joint"}} +
    within(&ProfileRow::deformer, artefact_deformer_columns) + within(&ProfileRow::section, joint_section_columns);

const Columns<IntersectionRow> intersection_columns =
    within(&IntersectionRow::place, artefact_place_columns) + within(&IntersectionRow::deformer, artefact_deformer_columns) +
    Columns<IntersectionRow>{{"surface", &IntersectionRow::surface, "", "rendered, or tets_boundary"},
                             {"triangles", &IntersectionRow::triangles, "", "number of its triangles"},
                             {"pairs", &IntersectionRow::pairs, "", "pairs of triangles that intersect in the pose"},
                             {"pairs_at_rest", &IntersectionRow::pairs_at_rest, "", "pairs of triangles that intersect at rest"}};

ArtefactPlace place_of(const ArtefactCase& of, const ArtefactBody& body, std::size_t pose)
{
    const pbs::Character& character = body.posed.character();
    return {character.name, static_cast<int>(character.mesh.rest.rows()), of.poses[pose].name};
}

ArtefactDeformer recorded(const DeformerSpec& spec)
{
    const auto* pbs = options_if<pbs::PbsOptions>(spec);
    return {spec.name, pbs ? name_of(pbs->order) : "", pbs ? name_of(pbs->precision) : ""};
}

namespace {

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

std::string group_of(const Scene& scene, const DeformerSpec& spec)
{
    const FemOptions* fem = options_if<FemOptions>(spec);
    if (!fem) return spec.kind;
    return fem->poisson == options_of<FemOptions>(spec_of(scene, scene.reference)).poisson ? "reference" : spec.label;
}

// The order of finite elements; 0 for other deformers.
int element_order_of(const DeformerSpec& spec)
{
    const FemOptions* fem = options_if<FemOptions>(spec);
    return fem ? fem->element_order : 0;
}

// The deformers whose sections are part of a claim.
bool is_on_other_meshes(const DeformerSpec& spec)
{
    static const std::set<std::string> claimed = {"lbs", "dqs", "pbs"};
    return claimed.contains(spec.kind) || element_order_of(spec) == 1;
}

class Search {
public:
    explicit Search(const ArtefactCase& of) : of_(of) {}

    void look_at(const ArtefactBody& body, const DeformerSpec& spec, bool with_intersections)
    {
        const Shapes shapes = body.posed.shapes(spec, poses_of(spec));
        for (std::size_t pose = 0; pose < shapes.size(); ++pose) {
            if (!shapes[pose].finished) {
                records_.breakdown += fmt::format("{} did not reach {} on {} vertices: {}. ", spec.label, of_.poses[pose].name,
                                                  body.posed.character().mesh.rest.rows(), shapes[pose].worst_element);
                continue;
            }
            for (std::size_t joint = 0; joint < body.joints.size(); ++joint) add_profile(body, spec, shapes[pose], pose, joint);
            if (with_intersections) add_intersections(body, spec, shapes[pose], pose);
        }
    }

    ArtefactRecords records() && { return std::move(records_); }

private:
    std::optional<std::size_t> poses_of(const DeformerSpec& spec) const
    {
        if (element_order_of(spec) < 2) return {};
        return static_cast<std::size_t>(of_.second_order_poses);
    }

    void add_profile(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose, std::size_t joint)
    {
        const JointProfile profile = body.sections[joint].measure(shape.positions, body.posed.pose(pose));
        records_.samples.push_back({group_of(of_.scene, spec), pose, joint, extremes_of(profile), element_order_of(spec)});
        for (const JointSection& section : profile)
            records_.profiles.push_back({place_of(of_, body, pose), body.joints[joint].name, recorded(spec), section});
    }

    void add_intersections(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose)
    {
        const pbs::Character& character = body.posed.character();
        const pbs::Positions own = shape.positions.topRows(character.mesh.rest.rows());
        add_count(body, spec, pose, "tets_boundary", body.posed.boundary(), own, character.mesh.rest);
        if (!character.surface) return;
        const auto embedded = [&](const pbs::Positions& x) { return pbs::embedded_positions(*character.surface, x, character.mesh.tets); };
        add_count(body, spec, pose, "rendered", character.surface->triangles, embedded(own), embedded(character.mesh.rest));
    }

    void add_count(const ArtefactBody& body, const DeformerSpec& spec, std::size_t pose, const std::string& surface,
                   const pbs::Triangles& triangles, const pbs::Positions& now, const pbs::Positions& rest)
    {
        const auto [at_rest, is_new] = at_rest_.try_emplace(surface, 0);
        if (is_new) at_rest->second = pbs::count_self_intersections(rest, triangles);
        records_.intersections.push_back({place_of(of_, body, pose), recorded(spec), surface, static_cast<int>(triangles.rows()),
                                          pbs::count_self_intersections(now, triangles), at_rest->second});
    }

    const ArtefactCase& of_;
    std::map<std::string, int> at_rest_;  // pairs of triangles on each surface of the body
    ArtefactRecords records_;
};

}  // namespace

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
