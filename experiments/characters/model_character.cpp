#include "experiments/characters/model_character.hpp"

#include "experiments/characters/body_cache.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/separated_parts.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/characters/thin_shells.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/system/child_process.hpp"

#include <algorithm>
#include <cmath>

namespace pbs {
namespace {

constexpr int model_version = 2;  // raised whenever something else is made of the same file, so that the cache knows
constexpr double smallest_m = 0.05, largest_m = 20.0;  // of a body whose unit is believed
constexpr double far_from_tets = 0.01;  // over the diagonal of the body; the wrap alone takes up to 0.008
constexpr int most_poses = 24;          // of an animation, evenly in time
constexpr const char* open_surface =
    "; the surface is open, and the tets fill a layer along it: close it where it should enclose flesh";

// Parts of the tets through which no bone passes would be held by nothing.
void leave_out_parts_without_bone(Character& character, const std::string& file, RemarkList& remarks)
{
    const std::vector<int> part = parts_of(character.mesh.tets);
    const std::vector<bool> has_bone = has_bone_inside(character.mesh, part, character.skeleton);
    const auto without = std::ranges::count(has_bone, false), parts = std::ranges::ssize(has_bone);
    if (without == 0 || without == parts) return;
    std::vector<bool> kept;
    for (const int own : part) kept.push_back(has_bone[static_cast<std::size_t>(own)]);
    const double whole_m3 = tet_volumes(character.mesh.rest, character.mesh.tets).sum();
    character.mesh = kept_tets(character.mesh, kept);
    const double lost_pct = 100.0 * (1.0 - tet_volumes(character.mesh.rest, character.mesh.tets).sum() / whole_m3);
    remarks.push_back({Gravity::part_left_out, file + ": " + std::to_string(without) + " of " + std::to_string(parts) +
                                                   " separate parts have no bone inside; they are left out, with " +
                                                   number_text(lost_pct, 3) + " % of the volume"});
}

// Parts move apart in the poses of the animation.
std::vector<Pose> sampled_poses(const RiggedModel& model)
{
    std::vector<Pose> poses;
    if (!model.animation) return poses;
    const auto& [start_s, end_s] = std::pair(model.animation->start_s, model.animation->end_s);
    for (int i = 0; i <= most_poses; ++i)
        poses.push_back(rigid_pose(
            model.body, node_transforms(model.rig, model.animation, start_s + (end_s - start_s) * i / most_poses)));
    return poses;
}

// One bone ends where the other one, its child, begins.
bool are_in_a_chain(int first, int second, const Skeleton& skeleton)
{
    const int parent = std::min(first, second), child = std::max(first, second);  // parents come first
    return skeleton.bones[static_cast<std::size_t>(child)].parent == parent &&
           std::ranges::count(bones_meeting(skeleton, parent, BoneEnd::tail), child) > 0;
}

// In a chain a joint holds both bones together: the flesh is not cut between them, but open there.
std::string words_on_cuts(const std::vector<Cut>& cuts, const Skeleton& skeleton)
{
    std::vector<std::string> between, at_joints;
    for (const auto& [first, second, area_m2] : cuts) {
        const bool in_a_chain = are_in_a_chain(first, second, skeleton);
        (in_a_chain ? at_joints : between)
            .push_back(skeleton.bones[static_cast<std::size_t>(first)].name + (in_a_chain ? " - " : " and ") +
                       skeleton.bones[static_cast<std::size_t>(second)].name);
    }
    std::string words = "parts that touch or nearly touch at rest move apart; the flesh is ";
    if (!between.empty()) words += "cut between " + name_list(between);
    if (!at_joints.empty())
        words += (between.empty() ? "open at the joint " : ", and open at the joint ") + name_list(at_joints);
    return words;
}

CarriedWeight carried_weight_of(const RiggedBody& body, const Character& character)
{
    return carried_weight(body.skin, character.artist->weights, *character.surface, character.mesh.tets,
                          static_cast<int>(body.skeleton.bones.size()));
}

// Whether the tets carry at most half of the weight, for each joint.
std::vector<bool> joints_without_flesh(const CarriedWeight& weight)
{
    std::vector<bool> without;
    for (std::size_t b = 0; b < weight.carried.size(); ++b)
        without.push_back(weight.of_artist[b] > 0.0 && weight.carried[b] <= 0.5 * weight.of_artist[b]);
    return without;
}

// Whether a point belongs to a separate shell whose weights the tets around it carry to at most one half, such as a
// cape that was left out of the tets. The larger part of a body is no such shell.
std::vector<bool> in_shells_without_flesh(const RiggedBody& body, const CarriedWeight& weight)
{
    const std::size_t points = weight.at_point.size();
    Classes shells(points);
    for (const Triangles& triangles : {body.triangles, joined_triangles(body.surface, body.triangles)})
        for (const auto& triangle : triangles.rowwise())
            for (const int corner : triangle) shells.unite(triangle(0), corner);
    std::vector<double> size(points, 0.0), carried(points, 0.0);
    for (std::size_t p = 0; p < points; ++p) {
        const auto shell = static_cast<std::size_t>(shells.find(static_cast<int>(p)));
        size[shell] += 1.0;
        carried[shell] += weight.at_point[p];
    }
    std::vector<bool> is_without;
    for (std::size_t p = 0; p < points; ++p) {
        const auto shell = static_cast<std::size_t>(shells.find(static_cast<int>(p)));
        is_without.push_back(carried[shell] <= 0.5 * size[shell] && 2.0 * size[shell] < static_cast<double>(points));
    }
    return is_without;
}

// Flesh of other parts would carry these points elsewhere.
std::vector<std::pair<int, double>> points_of_joints(const RiggedBody& body, const CarriedWeight& weight)
{
    const std::vector<bool> without = joints_without_flesh(weight), in_shell = in_shells_without_flesh(body, weight);
    std::vector<std::pair<int, double>> points;
    for (int p = 0; p < body.skin.vertices(); ++p) {
        double share = 0.0;
        for (int e = body.skin.first[p]; e < body.skin.first[p + 1]; ++e)
            if (in_shell[p] || without[body.skin.bone[e]]) share += body.skin.weight[e];
        if (share > 0.0) points.emplace_back(p, std::min(share, 1.0));
    }
    return points;
}

void take_weights(const RiggedBody& body, const std::function<bool(Eigen::Index, const SurfacePoint&)>& may_move,
                  Character& character)
{
    const TransferredWeights transferred = transfer_weights(character.mesh, body.surface, body.triangles, body.skin,
                                                            static_cast<int>(body.skeleton.bones.size()), may_move);
    character.artist->weights = transferred.weights;
    character.artist->largest_distance_m = transferred.largest_distance_m;
}

// of_flesh: the model's body without the triangles that the tets leave out. Cuts the flesh between parts that the
// skeleton moves apart. Surface and weights follow; without a cut they are those of the nearest points.
void add_skin(const RiggedModel& model, const RiggedBody& of_flesh, const std::string& file, Character& character,
              RemarkList& remarks)
{
    const RiggedBody& body = model.body;
    const SkinParts parts(of_flesh, sampled_poses(model));
    const SeparatedFlesh flesh = separate_parts(character.mesh, parts, body.skeleton);
    character.mesh = flesh.mesh;
    const auto skin_of = [&](int tet) { return flesh.skin_of_tet[static_cast<std::size_t>(tet)]; };
    std::function<bool(Eigen::Index, int)> may_carry;
    std::function<bool(Eigen::Index, const SurfacePoint&)> may_move;
    if (!flesh.cuts.empty()) {
        may_carry = [&](Eigen::Index point, int tet) { return !parts.are_apart(parts.at_vertex(point), skin_of(tet)); };
        may_move = [&](Eigen::Index v, const SurfacePoint& point) {
            return !parts.are_apart(skin_of(flesh.tet_at(v)), point);
        };
        remarks.push_back({Gravity::information, file + ": " + words_on_cuts(flesh.cuts, body.skeleton)});
    }
    character.surface = embed(body.surface, body.triangles, character.mesh, may_carry);
    take_weights(of_flesh, may_move, character);
    const CarriedWeight weight = carried_weight_of(body, character);
    const auto without_flesh = std::ranges::count(joints_without_flesh(weight), true);
    character.artist->is_cut = !flesh.cuts.empty() || without_flesh > 0;
    character.artist->of_joints = points_of_joints(body, weight);
    if (character.artist->of_joints.empty()) return;
    // Points that joints carry do not move the flesh of other parts either.
    Eigen::VectorXd of_joints = Eigen::VectorXd::Zero(body.surface.rows());
    for (const auto& [p, share] : character.artist->of_joints) of_joints(p) = share;
    take_weights(
        of_flesh,
        [&](Eigen::Index v, const SurfacePoint& point) {
            const Eigen::Vector3d shares = of_joints(of_flesh.triangles.row(point.triangle).transpose());
            return point.barycentric.dot(shares) < 0.5 && (!may_move || may_move(v, point));
        },
        character);
}

// The size of the joints over that of the surface; 1 for fewer than three joints, and for
// joints at one place, which state no size.
double relative_size_of_skeleton(const RiggedBody& body)
{
    const auto joints = static_cast<Eigen::Index>(body.skeleton.bones.size());
    if (joints < 3) return 1.0;
    Positions heads(joints, 3);
    for (Eigen::Index b = 0; b < joints; ++b) heads.row(b) = body.skeleton.bones[static_cast<std::size_t>(b)].head;
    const double size_m = diagonal_m(heads);
    return size_m > 0.0 ? size_m / diagonal_m(body.surface) : 1.0;
}

// A skeleton of another size is the cause of what else is wrong with sizes.
void add_size(const RiggedBody& body, const std::string& file, RemarkList& remarks)
{
    constexpr double most_apart = 50.0;
    const double relative = relative_size_of_skeleton(body);
    if (relative < 1.0 / most_apart || relative > most_apart) {
        remarks.push_back({Gravity::results_wrong,
                           file + ": the skeleton is " + number_text(relative, 2) +
                               " times as large as the mesh in the bind pose: one of them was scaled after the mesh "
                               "was bound; apply the "
                               "scales of armature and mesh in the program that made the model, and export it again"});
        return;
    }
    const double size_m = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).maxCoeff();
    if (size_m >= smallest_m && size_m <= largest_m) return;
    remarks.push_back({Gravity::part_left_out, file + ": unlikely units: the body's largest extent is " +
                                                   number_text(size_m, 4) +
                                                   " m; --scale (character.scale in a scene) corrects it"});
}

void add_sheet(const RiggedBody& body, const std::string& file, RemarkList& remarks)
{
    const double offset_m = sheet_offset_m({body.surface, body.triangles});
    if (offset_m > 0.0)
        remarks.push_back({Gravity::results_wrong,
                           file + ": the surface encloses no volume; the tets fill a layer on both sides of it, " +
                               number_text(100.0 * offset_m / diagonal_m(body.surface), 3) +
                               " % of the body's size thick"});
}

// The number of handles of a watertight surface, by V - E + F = 2 (parts - handles). It is 0 for an open surface.
int handles_of(const Triangles& triangles)
{
    if (!is_watertight(triangles)) return 0;
    const int points = 1 + triangles.maxCoeff();
    Classes classes(static_cast<std::size_t>(points));
    std::vector<bool> is_used(static_cast<std::size_t>(points));
    for (const auto& triangle : triangles.rowwise())
        for (const int v : triangle) {
            classes.unite(triangle(0), v);
            is_used[static_cast<std::size_t>(v)] = true;
        }
    int parts = 0, vertices = 0;
    for (int v = 0; v < points; ++v) {
        vertices += is_used[static_cast<std::size_t>(v)];
        parts += is_used[static_cast<std::size_t>(v)] && classes.find(v) == v;
    }
    const int euler = vertices - static_cast<int>(triangles.rows()) / 2;  // 3 F = 2 E
    return parts - euler / 2;
}

// The verb `mesh` refuses tets whose volume or shape differs from that of the surface. A surface without volume has
// its own remark.
void add_shape(const RiggedBody& body, const Character& character, const std::string& file, RemarkList& remarks)
{
    const TetMesh& mesh = character.mesh;
    if (sheet_offset_m({body.surface, body.triangles}) > 0.0) return;
    const double ratio = tet_volumes(mesh.rest, mesh.tets).sum() / std::abs(fan_volume(body.surface, body.triangles));
    if (ratio < 0.5 || ratio > 2.0)
        remarks.push_back({Gravity::results_wrong,
                           file + ": the tets hold " + number_text(ratio, 3) +
                               " times the volume that the surface seems to enclose: it is open, or its triangles are "
                               "not oriented one way; "
                               "close the surface or orient its triangles outward in the program that made it"});
    const Topology shape = topology_of(mesh.tets, mesh.rest.rows());
    const int handles = shape.boundary_components - shape.boundary_euler / 2,
              own = handles_of(joined_triangles(body.surface, body.triangles));
    if (handles <= own) return;
    constexpr double nearly_all_pct = 95.0;  // what grew together moves as the artist wants it, then
    const bool does_no_harm =
        !body.skeleton.bones.empty() && carried_weight_of(body, character).share_pct() > nearly_all_pct;
    remarks.push_back({does_no_harm ? Gravity::information : Gravity::results_wrong,
                       file + ": the tets have " + std::to_string(handles) + " handles and the model has " +
                           std::to_string(own) +
                           " (by their Euler numbers): parts that nearly touch have grown together; --vertices "
                           "(character.vertices in a "
                           "scene) asks for finer tets"});
}

void add_bones_outside(const RiggedBody& body, const TetMesh& mesh, const std::string& file, RemarkList& remarks)
{
    constexpr double little = 0.01;  // of the skin: an end joint, or a root on the ground
    std::vector<double> moved(body.skeleton.bones.size(), 0.0);
    for (std::size_t e = 0; e < body.skin.bone.size(); ++e)
        moved[static_cast<std::size_t>(body.skin.bone[e])] += body.skin.weight[e] / body.skin.vertices();
    std::vector<std::string> outside;
    std::vector<bool> is_inside(body.skeleton.bones.size(), false);
    for (const auto& [bone, tet] : bones_in_tets(mesh, body.skeleton, 1.0 / 6.0))
        is_inside[static_cast<std::size_t>(bone)] = true;
    for (std::size_t b = 0; b < is_inside.size(); ++b)
        if (!is_inside[b] && moved[b] >= little) outside.push_back(body.skeleton.bones[b].name);
    const bool is_layer =
        outside.size() == body.skeleton.bones.size() && !is_watertight(joined_triangles(body.surface, body.triangles));
    if (!outside.empty())
        remarks.push_back({Gravity::part_left_out, file + ": " + std::to_string(outside.size()) + " of " +
                                                       std::to_string(body.skeleton.bones.size()) +
                                                       " bones lie outside the body: " + name_list(outside) +
                                                       (is_layer ? open_surface : "")});
}

void add_distance(const RiggedBody& body, double distance_m, const std::string& file, RemarkList& remarks)
{
    if (const double share = distance_m / diagonal_m(body.surface); share > far_from_tets)
        remarks.push_back({Gravity::part_left_out, file + ": the boundary of the tets lies up to " +
                                                       number_text(100.0 * share, 3) +
                                                       " % of the body's size from the surface of the model"});
}

void add_joints_without_flesh(const RiggedBody& body, const Character& character, const std::string& file,
                              RemarkList& remarks)
{
    const std::vector<bool> is_without = joints_without_flesh(carried_weight_of(body, character));
    std::vector<std::string> without;
    for (std::size_t b = 0; b < is_without.size(); ++b)
        if (is_without[b]) without.push_back(body.skeleton.bones[b].name);
    if (!without.empty())
        remarks.push_back({Gravity::part_left_out, file + ": " + std::to_string(without.size()) + " of " +
                                                       std::to_string(is_without.size()) +
                                                       " joints are without flesh, for the tets are too coarse for "
                                                       "what they move, and the surface alone follows them: " +
                                                       name_list(without)});
}

// The tets of this part of the body's surface, which depend on the surface alone: other animations, weights or joints
// in the file leave them as they are. The mesher does not know the name of the file.
Character meshed(const SurfaceMesh& part, double offset_m, const Skeleton& skeleton, const ModelSource& source)
{
    std::string made_from = std::to_string(model_version) + "|" + std::to_string(part.points.rows()) + "|";
    made_from.append(reinterpret_cast<const char*>(part.points.data()), part.points.size() * sizeof(double));
    made_from.append(reinterpret_cast<const char*>(part.triangles.data()), part.triangles.size() * sizeof(int));
    if (offset_m > 0.0) made_from += "|" + number_text(offset_m, 17);
    const SurfaceBody surface{
        .name = file_name(source.file),
        .made_from = made_from,
        .skeleton = skeleton.bones.empty() ? source.skeleton : skeleton,
        .surface = [&] { return part; },
        // The model may have any number of handles and parts, and its joints may lie outside.
        .meshing = {
            .wrap_offset_m = offset_m, .boundary_euler = {}, .is_closed = false, .is_one_piece = false, .inside = {}}};
    try {
        return make_surface_body(surface, source.vertices > 0 ? source.vertices : default_model_vertices, false);
    } catch (const TooManyTets& error) {
        throw TooManyTets(InputError(source.file, 0, "", "", error.what()));
    } catch (const InputError& error) {
        throw InputError(source.file, 0, "", "", error.what());
    }
}

// Where parts are too thin for the tets, separate ones are left out of them and of `body`, and what is still too thin
// is wrapped at a distance.
Character meshed(RiggedBody& body, const ModelSource& source, RemarkList& remarks)
{
    const SurfaceMesh whole = {body.surface, body.triangles};
    try {
        return meshed(whole, 0.0, body.skeleton, source);
    } catch (const TooManyTets&) {
    }
    const ThickShells thick = thick_shells(whole, source.vertices > 0 ? source.vertices : default_model_vertices);
    body.triangles = thick.triangles;
    const SurfaceMesh part = used_part({body.surface, body.triangles});
    if (thick.left_out > 0) {
        remarks.push_back({Gravity::part_left_out,
                           source.file + ": " + std::to_string(thick.left_out) +
                               " separate parts of the surface are thinner than the tets, and left out of them"});
        try {
            return meshed(part, 0.0, body.skeleton, source);
        } catch (const TooManyTets&) {
        }
    }
    constexpr double distance = 1.0 / 85.0;  // over the size: the largest one at which an open surface is wrapped
    Character character = meshed(part, distance * diagonal_m(part.points), body.skeleton, source);
    remarks.push_back({Gravity::results_wrong,
                       source.file +
                           ": parts of the body are thinner than the tets, which enclose it at a distance of " +
                           number_text(100.0 * distance, 2) +
                           " % of its size: the flesh is that much thicker than the model; --vertices "
                           "(character.vertices in a scene) asks for finer tets"});
    return character;
}

}  // namespace

std::shared_ptr<const RiggedModel> read_model(const std::string& file, const std::string& animation, double scale)
{
    const Stage stage("reading " + file);
    auto model = std::make_shared<RiggedModel>();
    model->rig = read_rig(file);
    model->animation = find_animation(model->rig, animation);
    model->body = make_rigged_body(model->rig, model->animation, scale);
    return model;
}

Character make_model_character(const ModelSource& source, RemarkList& remarks)
{
    const InputFile input(source.file);
    const std::shared_ptr<const RiggedModel> model = read_model(source.file, source.animation, source.scale);
    const RiggedBody& body = model->body;
    const bool rigged = !body.skeleton.bones.empty();
    if (!rigged && source.skeleton.bones.empty())
        throw InputError(
            source.file, 0, "skins", "0",
            "the file has no joints: expected a skeleton (character.skeleton in a scene, --skeleton of `pbskin try`)");
    if (rigged && !source.skeleton.bones.empty())
        throw InputError(
            source.file, 0, "joints of the skins", std::to_string(body.skeleton.bones.size()),
            "expected no other skeleton (character.skeleton, --skeleton): the model has joints of its own");

    const auto hashed = input.hashed();
    RiggedBody of_flesh = body;
    Character character = meshed(of_flesh, source, remarks);
    const Stage weighting("carrying the weights of " + source.file + " to the tets");
    leave_out_parts_without_bone(character, source.file, remarks);
    character.inputs = hashed;
    character.artist.emplace();
    character.artist->model = model;
    if (rigged)
        add_skin(*model, of_flesh, source.file, character, remarks);
    else
        character.surface = embed(body.surface, body.triangles, character.mesh);
    add_shape(of_flesh, character, source.file, remarks);
    const RemarkList on_model = remarks_on_model(body, character, source.file);
    remarks.insert(remarks.end(), on_model.begin(), on_model.end());
    return character;
}

Positions surface_positions(const Character& character, const Positions& positions, const Pose& pose)
{
    Positions points = embedded_positions(*character.surface, positions, character.mesh.tets);
    if (!character.artist || character.artist->of_joints.empty()) return points;
    const Positions by_joints = artist_points(character.artist->model->body, pose);
    for (const auto& [p, share] : character.artist->of_joints)
        points.row(p) = (1.0 - share) * points.row(p) + share * by_joints.row(p);
    return points;
}

RemarkList remarks_on_model(const RiggedBody& body, const Character& character, const std::string& file)
{
    RemarkList remarks;
    for (const std::string& remark : body.remarks) remarks.push_back({Gravity::part_left_out, file + ": " + remark});
    for (const std::string& note : body.notes) remarks.push_back({Gravity::information, file + ": " + note});
    add_size(body, file, remarks);
    add_sheet(body, file, remarks);
    if (body.skeleton.bones.empty()) return remarks;
    add_distance(body, character.artist->largest_distance_m, file, remarks);
    add_bones_outside(body, character.mesh, file, remarks);
    add_joints_without_flesh(body, character, file, remarks);
    return remarks;
}

}  // namespace pbs
