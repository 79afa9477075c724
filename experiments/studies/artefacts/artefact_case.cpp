#include "experiments/studies/artefacts/artefact_case.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

namespace experiments {

using analysis::Columns;
using analysis::within;

const Columns<ProfileRow> profile_columns =
    within(&ProfileRow::place, artefact_place_columns) + Columns<ProfileRow>{{"joint", &ProfileRow::joint}} +
    within(&ProfileRow::deformer, artefact_deformer_columns) +
    within(&ProfileRow::section, Columns<JointSection>{{"offset_m", &JointSection::offset_m},
                                                       {"area_over_rest", &JointSection::area},
                                                       {"smallest_radius_over_rest", &JointSection::smallest_radius},
                                                       {"largest_radius_over_rest", &JointSection::largest_radius},
                                                       {"outlines", &JointSection::outlines},
                                                       {"limb_share", &JointSection::limb_share}});

const Columns<IntersectionRow> intersection_columns =
    within(&IntersectionRow::place, artefact_place_columns) +
    within(&IntersectionRow::deformer, artefact_deformer_columns) +
    MEMBER_COLUMNS(IntersectionRow, surface, triangles, pairs, pairs_at_rest);

ArtefactDeformer recorded(const DeformerSpec& spec)
{
    const auto* pbs = options_if<pbs::PbsOptions>(spec);
    return {spec.name, pbs ? name_of(pbs->order) : "", pbs ? name_of(pbs->precision) : ""};
}

namespace {

ArtefactPlace place_of(const ArtefactCase& artefact_case, const ArtefactBody& body, std::size_t pose)
{
    const pbs::Character& character = body.posed.character();
    return {character.name, static_cast<int>(character.mesh.rest.rows()), artefact_case.poses[pose].name};
}

Scene with_vertices(Scene scene, int vertices)
{
    if (vertices > 0) scene.character.vertices = vertices;
    return scene;
}

std::vector<int> frames_of(const ArtefactCase& artefact_case)
{
    std::vector<int> frames;
    for (const ArtefactPose& pose : artefact_case.poses) frames.push_back(pose.frame);
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

// The deformers whose sections a claim selects.
bool is_on_other_meshes(const DeformerSpec& spec)
{
    static const std::set<std::string> claimed = {"lbs", "dqs", "pbs", "pbs_author"};
    return claimed.contains(spec.kind) || element_order_of(spec) == 1;
}

class Search {
public:
    explicit Search(const ArtefactCase& artefact_case) : of_(artefact_case) {}

    void look_at(const ArtefactBody& body, const DeformerSpec& spec, bool with_intersections)
    {
        const Shapes shapes = shapes_of(body, spec);
        for (std::size_t pose = 0; pose < shapes.size(); ++pose) {
            if (!shapes[pose].finished) {
                records_.breakdown +=
                    fmt::format("{} did not reach {} on {} vertices: {}. ", spec.label, of_.poses[pose].name,
                                body.posed.character().mesh.rest.rows(), shapes[pose].worst_element);
                continue;
            }
            for (std::size_t joint = 0; joint < body.joints.size(); ++joint)
                if (is_turned(of_.poses[pose], body, joint)) add_profile(body, spec, shapes[pose], pose, joint);
            if (with_intersections) add_intersections(body, spec, shapes[pose], pose);
        }
    }

    ArtefactRecords records() && { return std::move(records_); }

private:
    Shapes shapes_of(const ArtefactBody& body, const DeformerSpec& spec) const
    {
        if (!of_.through_sweep || !std::any_cast<pbs::PbsOptions>(&spec.options))
            return body.posed.shapes(spec, poses_of(spec));
        const pbs::Character& character = body.posed.character();
        const pbs::Motion sweep = make_motion(of_.scene.motion, character.skeleton, of_.scene.file);
        const std::vector<pbs::Positions> of_frames = shapes_in_motion(character, sweep, spec);
        Shapes shapes;
        for (const ArtefactPose& pose : of_.poses) {
            const pbs::Positions& positions = of_frames.at(static_cast<std::size_t>(pose.frame));
            shapes.push_back({.positions = positions, .finished = positions.allFinite()});
        }
        return shapes;
    }

    std::optional<std::size_t> poses_of(const DeformerSpec& spec) const
    {
        if (element_order_of(spec) < 2) return {};
        return static_cast<std::size_t>(of_.second_order_poses);
    }

    void add_profile(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose,
                     std::size_t joint)
    {
        const JointProfile profile = body.sections[joint].measure(shape.positions, body.posed.pose(pose));
        const ArtefactDeformer deformer = recorded(spec);
        records_.samples.push_back({group_of(of_.scene, spec), pose, joint, extremes_of(profile),
                                    element_order_of(spec), deformer.order, deformer.precision});
        for (const JointSection& section : profile)
            records_.profiles.push_back({place_of(of_, body, pose), body.joints[joint].name, deformer, section});
    }

    void add_intersections(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose)
    {
        const pbs::Character& character = body.posed.character();
        const pbs::Positions own = shape.positions.topRows(character.mesh.rest.rows());
        add_count(body, spec, pose, "tets_boundary", body.posed.boundary(), own, character.mesh.rest);
        if (!character.surface) return;
        const auto embedded = [&](const pbs::Positions& x) {
            return pbs::embedded_positions(*character.surface, x, character.mesh.tets);
        };
        add_count(body, spec, pose, "rendered", character.surface->triangles, embedded(own),
                  embedded(character.mesh.rest));
    }

    void add_count(const ArtefactBody& body, const DeformerSpec& spec, std::size_t pose, const std::string& surface,
                   const pbs::Triangles& triangles, const pbs::Positions& now, const pbs::Positions& rest)
    {
        const auto [at_rest, is_new] = at_rest_.try_emplace(surface, 0);
        if (is_new) at_rest->second = pbs::count_self_intersections(rest, triangles);
        records_.intersections.push_back({place_of(of_, body, pose), recorded(spec), surface,
                                          static_cast<int>(triangles.rows()),
                                          pbs::count_self_intersections(now, triangles), at_rest->second});
    }

    const ArtefactCase& of_;
    std::map<std::string, int> at_rest_;  // pairs of triangles on each surface of the body
    ArtefactRecords records_;
};

constexpr double reach_radii = 2.0, fan_radii = 3.0;
constexpr int stations_per_radius = 5;

pbs::Vec3 direction(const pbs::Skeleton& skeleton, int bone, const pbs::Pose& pose)
{
    return pose[bone].linear() * (skeleton.bones[bone].tail - skeleton.bones[bone].head).normalized();
}

std::vector<double> offsets_of(const LimbJoint& joint)
{
    const double spacing_m = joint.radius_m / stations_per_radius;
    const int before = static_cast<int>(std::min(reach_radii * joint.radius_m, joint.reach_parent_m) / spacing_m);
    const int after = static_cast<int>(std::min(reach_radii * joint.radius_m, joint.reach_child_m) / spacing_m);
    std::vector<double> offsets_m;
    for (int i = -before; i <= after; ++i) offsets_m.push_back(i * spacing_m);
    return offsets_m;
}

bool is_below(const pbs::Skeleton& skeleton, int bone, int ancestor)
{
    while (bone >= 0 && bone != ancestor) bone = skeleton.bones[bone].parent;
    return bone == ancestor;
}

std::vector<bool> vertices_on_limb(const pbs::Character& character, const LimbJoint& joint)
{
    std::vector<bool> on_limb;
    for (const int bone : character.binding.bone) on_limb.push_back(is_below(character.skeleton, bone, joint.parent));
    return on_limb;
}

double share(double now, double rest)
{
    return rest > 0.0 ? now / rest : 1.0;
}

constexpr double cosine_of_60_deg = 0.5;
constexpr double straight_rad = 0.02;  // two bones at a smaller angle define no plane

pbs::Vec3 along(const pbs::Bone& bone)
{
    return bone.tail - bone.head;
}

// A foot does not continue the shin: planes across the ankle cut it lengthwise.
bool passes_through(const pbs::Bone& parent, const pbs::Bone& child)
{
    return along(parent).normalized().dot(along(child).normalized()) > cosine_of_60_deg;
}

double limb_radius(const pbs::Character& character, int parent, int child)
{
    const std::vector<bool> skin = pbs::boundary_vertices(character.mesh.tets, character.mesh.rest.rows());
    double sum_m = 0.0;
    int count = 0;
    for (std::size_t v = 0; v < character.binding.bone.size(); ++v) {
        if (!skin[v] || (character.binding.bone[v] != parent && character.binding.bone[v] != child)) continue;
        sum_m += character.binding.distance(v);
        ++count;
    }
    return sum_m / count;
}

// The radius of the circle that has the area of the limb's section across the joint; zero where the plane misses the
// skin.
double section_radius(const pbs::Character& character, const pbs::Bone& parent, const pbs::Bone& child)
{
    const pbs::Vec3 normal = along(parent).normalized() + along(child).normalized();
    const auto sections =
        pbs::section_outlines(character.mesh.rest, pbs::boundary_of(character.mesh.tets), {{child.head, normal}});
    const pbs::Positions* own = analysis::enclosing_outline(sections.front(), {child.head, normal});
    return own ? std::sqrt(analysis::outline_size(*own).area_m2 / std::numbers::pi) : 0.0;
}

std::optional<LimbJoint> found(const pbs::Character& character, const JointByHand& named)
{
    if (!why_left_out(character, named).empty()) return {};
    const int parent = pbs::find_bone(character.skeleton, named.parent),
              child = pbs::find_bone(character.skeleton, named.child);
    const pbs::Bone &before = character.skeleton.bones[parent], &after = character.skeleton.bones[child];
    return LimbJoint{name_of(named),
                     parent,
                     child,
                     after.head,
                     section_radius(character, before, after),
                     named.reach_parent * along(before).norm(),
                     named.reach_child * along(after).norm()};
}

}  // namespace

std::vector<DeformerSpec> other_orders(const DeformerSpec& pbs)
{
    std::vector<DeformerSpec> others;
    const auto& own = options_of<pbs::PbsOptions>(pbs);
    for (const pbs::Precision precision : {pbs::Precision::f32, pbs::Precision::f64})
        for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::plain}) {
            if (order == own.order && precision == own.precision) continue;
            others.push_back(pbs);
            options_of<pbs::PbsOptions>(others.back()).order = order;
            options_of<pbs::PbsOptions>(others.back()).precision = precision;
        }
    return others;
}

ArtefactBody::ArtefactBody(const ArtefactCase& artefact_case, int vertices)
    : posed(with_vertices(artefact_case.scene, vertices), frames_of(artefact_case))
{
    for (const LimbJoint& joint : limb_joints(posed.character()))
        if (artefact_case.joint.empty() || artefact_case.joint == joint.name) joints.push_back(joint);
    for (const LimbJoint& joint : joints) sections.emplace_back(posed.character(), joint);
}

bool is_turned(const ArtefactPose& pose, const ArtefactBody& body, std::size_t joint)
{
    const std::string& child = body.posed.character().skeleton.bones[body.joints[joint].child].name;
    return pose.turned.empty() || std::ranges::count(pose.turned, child) > 0;
}

ArtefactRecords find_artefacts(const ArtefactCase& artefact_case, const ArtefactBody& body)
{
    Search search(artefact_case);
    std::vector<DeformerSpec> orders;
    if (!artefact_case.through_sweep) orders = other_orders(spec_of(artefact_case.scene, "pbs"));
    const auto look_at = [&](const ArtefactBody& mesh, bool is_own) {
        for (const DeformerSpec& spec : artefact_case.scene.deformers)
            if (is_own || is_on_other_meshes(spec)) search.look_at(mesh, spec, is_own && !artefact_case.through_sweep);
        for (const DeformerSpec& spec : orders) search.look_at(mesh, spec, false);
    };
    look_at(body, true);
    for (const int vertices : artefact_case.vertices) look_at(ArtefactBody(artefact_case, vertices), false);
    return std::move(search).records();
}

SectionExtremesOverRest extremes_of(const JointProfile& profile)
{
    SectionExtremesOverRest extremes;
    if (profile.empty()) return extremes;
    const JointSection widest = std::ranges::max(profile, {}, &JointSection::largest_radius);
    extremes.smallest_radius = std::ranges::min(profile, {}, &JointSection::smallest_radius).smallest_radius;
    extremes.largest_radius = widest.largest_radius;
    extremes.limb_share_of_widest = widest.limb_share;
    return extremes;
}

JointSections::JointSections(const pbs::Character& character, const LimbJoint& joint)
    : skeleton_(character.skeleton),
      joint_(joint),
      skin_(pbs::boundary_of(character.mesh.tets)),
      on_limb_(vertices_on_limb(character, joint)),
      offsets_m_(offsets_of(joint))
{
    const pbs::Pose still(skeleton_.bones.size(), Eigen::Isometry3d::Identity());
    rest_ = cuts(character.mesh.rest, still);
}

double JointSections::bend_deg(const pbs::Pose& pose) const
{
    const pbs::Vec3 before = direction(skeleton_, joint_.parent, pose),
                    after = direction(skeleton_, joint_.child, pose);
    return std::atan2(before.cross(after).norm(), before.dot(after)) * 180.0 / std::numbers::pi;
}

std::vector<pbs::CuttingPlane> JointSections::planes(const pbs::Pose& pose) const
{
    const pbs::Pose still(pose.size(), Eigen::Isometry3d::Identity());
    const pbs::Vec3 before = direction(skeleton_, joint_.parent, pose),
                    after = direction(skeleton_, joint_.child, pose);
    std::vector<pbs::CuttingPlane> planes;
    for (const double offset_m : offsets_m_) {
        const int bone = offset_m < 0.0 ? joint_.parent : joint_.child;
        const double turned = std::clamp(0.5 + 0.5 * offset_m / (fan_radii * joint_.radius_m), 0.0, 1.0);
        const pbs::Vec3 at_rest = joint_.point + offset_m * direction(skeleton_, bone, still);
        const pbs::Vec3 normal = (1.0 - turned) * before + turned * after;
        planes.push_back({pose[bone] * at_rest, normal.norm() > 0.0 ? normal : after});
    }
    return planes;
}

std::vector<JointSections::Cut> JointSections::cuts(const pbs::Positions& positions, const pbs::Pose& pose) const
{
    const std::vector<pbs::CuttingPlane> planes = this->planes(pose);
    const auto sections = pbs::section_outlines(positions, skin_, planes);
    std::vector<Cut> cuts;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        Cut cut{.outlines = static_cast<int>(sections[i].size())};
        const analysis::Plane plane = {planes[i].point, planes[i].normal};
        if (const pbs::Positions* own = analysis::enclosing_outline(sections[i], plane)) {
            cut.size = analysis::outline_size(*own);
            cut.limb_share = analysis::share_of_outline(*own, plane, positions, skin_, on_limb_);
        }
        cuts.push_back(cut);
    }
    return cuts;
}

JointProfile JointSections::measure(const pbs::Positions& positions, const pbs::Pose& pose) const
{
    const std::vector<Cut> now = cuts(positions, pose);
    JointProfile profile;
    for (std::size_t i = 0; i < now.size(); ++i) {
        const analysis::OutlineSize &size = now[i].size, &rest = rest_[i].size;
        profile.push_back({offsets_m_[i], share(size.area_m2, rest.area_m2),
                           share(size.smallest_radius_m, rest.smallest_radius_m),
                           share(size.largest_radius_m, rest.largest_radius_m), now[i].outlines, now[i].limb_share});
    }
    return profile;
}

std::string name_of(const JointByHand& joint)
{
    return joint.parent + "|" + joint.child;
}

std::string why_left_out(const pbs::Character& character, const JointByHand& joint)
{
    if (!joint.no_section.empty()) return joint.no_section;
    const auto& bones = character.skeleton.bones;
    for (const std::string& bone : {joint.parent, joint.child})
        if (pbs::find_bone(character.skeleton, bone) < 0) return "no_bone_" + bone;
    const int parent = pbs::find_bone(character.skeleton, joint.parent),
              child = pbs::find_bone(character.skeleton, joint.child);
    return section_radius(character, bones[parent], bones[child]) > 0.0 ? "" : "no_flesh_round_the_joint";
}

std::vector<JointByHand> joints_by_hand(const std::string& body)
{
    std::vector<JointByHand> joints;
    const nlohmann::json document = cases_document("artefacts");
    for (const nlohmann::json& joint : document.at("joint"))
        if (joint.at("body") == body)
            joints.push_back({joint.at("parent"), joint.at("child"), joint.at("reach").at(0), joint.at("reach").at(1),
                              joint.value("no_section", "")});
    return joints;
}

std::vector<LimbJoint> limb_joints(const pbs::Character& character)
{
    std::vector<LimbJoint> joints;
    const std::vector<JointByHand> by_hand = joints_by_hand(character.name);
    for (const JointByHand& joint : by_hand)
        if (const auto limb_joint = found(character, joint)) joints.push_back(*limb_joint);
    if (!by_hand.empty()) return joints;
    for (const LimbStation& station : limb_stations(character)) {
        if (station.carriers.size() != 2 || station.point.x() < -1e-9) continue;
        const int parent = station.carriers[0], child = station.carriers[1];
        if (!passes_through(character.skeleton.bones[parent], character.skeleton.bones[child])) continue;
        joints.push_back({station.name, parent, child, station.point, limb_radius(character, parent, child),
                          0.5 * along(character.skeleton.bones[parent]).norm(),
                          0.5 * along(character.skeleton.bones[child]).norm()});
    }
    return joints;
}

pbs::Vec3 twist_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint)
{
    return along(skeleton.bones[joint.child]).normalized();
}

pbs::Vec3 hinge_axis(const pbs::Skeleton& skeleton, const LimbJoint& joint)
{
    const pbs::Vec3 parent = along(skeleton.bones[joint.parent]).normalized(), child = twist_axis(skeleton, joint);
    const pbs::Vec3 across = parent.cross(child);
    if (across.norm() > straight_rad) return across.normalized();
    const pbs::Vec3 z = pbs::Vec3::UnitZ() - child.z() * child;
    return z.norm() > straight_rad ? pbs::Vec3(z.normalized()) : pbs::Vec3(pbs::Vec3::UnitX());
}

std::vector<bool> near_joint(const pbs::Character& character, const LimbJoint& joint, double share)
{
    std::vector<bool> near(character.binding.bone.size());
    for (std::size_t v = 0; v < near.size(); ++v) {
        const int bone = character.binding.bone[v];
        const double parameter = character.binding.parameter(v);
        near[v] = (bone == joint.child && parameter <= share) || (bone == joint.parent && parameter >= 1.0 - share);
    }
    return near;
}

}  // namespace experiments
