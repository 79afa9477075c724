#include "experiments/run/run_folder.hpp"

#include "experiments/process/machine.hpp"
#include "pbs/character/body_cache.hpp"
#include "pbs/character/model_character.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/skinning/weights.hpp"

#include <link.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace experiments {

const analysis::Columns<BonePlace> bone_columns = [] {
    auto columns = MEMBER_COLUMNS(BonePlace, bone, parent);
    for (const auto& [name, end] : {std::pair("head_", &BonePlace::head), std::pair("tail_", &BonePlace::tail)})
        for (int axis = 0; axis < 3; ++axis)
            columns.emplace_back(
                std::string(name) + "xyz"[axis] + "_m", [ end = end, axis ](auto& bone) -> auto& { return (bone.*end)(axis); });
    return columns;
}();

const analysis::Columns<PosedBone> posed_bone_columns =
    MEMBER_COLUMNS(PosedBone, frame, time_s) + analysis::within(&PosedBone::place, bone_columns);

const analysis::Columns<BoundVertex> bound_vertex_columns =
    MEMBER_COLUMNS(BoundVertex, vertex, bone, parameter, rest_distance_m, blended, jiggles);

namespace {

std::string parent_of(const pbs::Skeleton& skeleton, const pbs::Bone& bone)
{
    return bone.parent < 0 ? "" : skeleton.bones[bone.parent].name;
}

int loaded_shared_objects()
{
    int count = 0;
    const auto add = [](dl_phdr_info* info, std::size_t, void* counter) {
        if (info->dlpi_name && *info->dlpi_name) ++*static_cast<int*>(counter);  // the program itself has no name
        return 0;
    };
    dl_iterate_phdr(add, &count);
    return count;
}

const analysis::Columns<RegionBones> region_bone_columns = MEMBER_COLUMNS(RegionBones, bone, second_bone);

constexpr double nearest_bonus = 1e-6;  // decides for a corner's nearest bone if weights are equal

// Weight of each bone over the four corners of a tet, #bones, and whether one of them is blended.
struct TetWeights {
    std::vector<double> of_bone;
    bool blended = false;
};

TetWeights weights_of_tet(const pbs::Character& character, const pbs::Weights& weights, Eigen::Index tet)
{
    TetWeights sum{std::vector<double>(character.skeleton.bones.size(), 0.0)};
    for (const int vertex : character.mesh.tets.row(tet)) {
        sum.blended = sum.blended || weights.blended(vertex);
        sum.of_bone[character.binding.bone[vertex]] += nearest_bonus;
        for (int entry = weights.first[vertex]; entry < weights.first[vertex + 1]; ++entry)
            sum.of_bone[weights.bone[entry]] += weights.weight[entry];
    }
    return sum;
}

int heaviest(const std::vector<double>& weights)
{
    return static_cast<int>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

}  // namespace

std::vector<BonePlace> bones_at_rest(const pbs::Skeleton& skeleton)
{
    std::vector<BonePlace> bones;
    for (const pbs::Bone& bone : skeleton.bones) bones.push_back({bone.name, parent_of(skeleton, bone), bone.head, bone.tail});
    return bones;
}

void add_bones(std::vector<PosedBone>& bones, int frame, double time_s, const pbs::Skeleton& skeleton, const pbs::Pose& pose)
{
    for (std::size_t j = 0; j < skeleton.bones.size(); ++j) {
        const pbs::Bone& bone = skeleton.bones[j];
        bones.push_back({frame, time_s, {bone.name, parent_of(skeleton, bone), pose[j] * bone.head, pose[j] * bone.tail}});
    }
}

std::vector<BoundVertex> bound_vertices(const pbs::Character& character)
{
    const pbs::BoneBinding& binding = character.binding;
    const std::vector<bool> jiggles = pbs::jiggle_zone(binding);
    std::vector<BoundVertex> vertices;
    for (std::size_t v = 0; v < binding.bone.size(); ++v)
        vertices.push_back({int(v), character.skeleton.bones[binding.bone[v]].name, binding.parameter(v), binding.distance(v),
                            bool(character.blended[v]), jiggles[v]});
    return vertices;
}

double CostRecord::seconds(const std::string& part) const
{
    const auto found = seconds_.find(part);
    return found == seconds_.end() ? 0.0 : found->second;
}

nlohmann::json CostRecord::json() const
{
    nlohmann::json seconds = seconds_, cpu_seconds = cpu_seconds_;
    seconds["total"] = stopwatch_.seconds();
    cpu_seconds["total"] = process_cpu_s() - cpu_start_s_;
    seconds["deformers"] = deformers_;
    cpu_seconds["deformers"] = cpu_deformers_;
    return {{"seconds", seconds},
            {"cpu_seconds", cpu_seconds},
            {"peak_memory_mb", 1e-6 * peak_memory_bytes()},
            {"shared_objects", loaded_shared_objects()}};
}

const analysis::Columns<DeformerDistance> distance_columns =
    MEMBER_COLUMNS(DeformerDistance, frame, time_s, deformer, other, of, points, rms_mm, largest_mm);

void DistanceRecord::add(int frame, double time_s, const std::string& label, const std::string& owner, const pbs::Positions& points)
{
    if (frame != frame_) before_.clear();
    frame_ = frame;
    for (const auto& [other, there] : before_) {
        const Eigen::VectorXd squares = (points - there).rowwise().squaredNorm();
        distances_.push_back({frame, time_s, label, other, owner, static_cast<int>(points.rows()), 1e3 * std::sqrt(squares.mean()),
                              1e3 * std::sqrt(squares.maxCoeff())});
    }
    before_.emplace_back(label, points);
}

using Changes = analysis::Columns<RegionChange>;
const Changes region_columns =
    MEMBER_COLUMNS(RegionChange, deformer, kind) + within(&RegionChange::bones, region_bone_columns) +
    MEMBER_COLUMNS(RegionChange, rest_share_pct, change_pct, abs_change_pct, lowest_pct, highest_pct, own_change_pct, frames);

BodyRegions regions_by_bone(const pbs::Character& character)
{
    const pbs::Weights weights = pbs::paper_weights(character.binding, character.skeleton);
    BodyRegions regions{"bone", {}, {}};
    for (const auto& bone : character.skeleton.bones) regions.bones.push_back({bone.name});
    for (Eigen::Index tet = 0; tet < character.mesh.tets.rows(); ++tet)
        regions.of_tet.push_back(heaviest(weights_of_tet(character, weights, tet).of_bone));
    return regions;
}

BodyRegions regions_by_joint(const pbs::Character& character)
{
    const auto& bones = character.skeleton.bones;
    const pbs::Weights weights = pbs::paper_weights(character.binding, character.skeleton);
    BodyRegions regions{"joint", {}, {}};
    std::map<RegionBones, int> index_of;
    for (Eigen::Index tet = 0; tet < character.mesh.tets.rows(); ++tet) {
        TetWeights sum = weights_of_tet(character, weights, tet);
        regions.of_tet.push_back(-1);
        if (!sum.blended) continue;
        const int first = heaviest(sum.of_bone);
        sum.of_bone[first] = 0.0;
        const int second = heaviest(sum.of_bone);
        const RegionBones two = {bones[std::min(first, second)].name, bones[std::max(first, second)].name};
        const auto [entry, is_new] = index_of.emplace(two, static_cast<int>(regions.bones.size()));
        if (is_new) regions.bones.push_back(two);
        regions.of_tet.back() = entry->second;
    }
    return regions;
}

RegionRecord::RegionRecord(const pbs::Character& character)
{
    for (const BodyRegions& regions : {regions_by_bone(character), regions_by_joint(character)})
        kinds_.push_back({regions, analysis::RegionMetrics(character.mesh.rest, character.mesh.tets, regions.of_tet)});
}

void RegionRecord::add(const std::string& label, const pbs::Positions& positions)
{
    if (!positions.allFinite()) return;
    auto sums = std::ranges::find_if(sums_, [&](const auto& of_one) { return of_one.front().deformer == label; });
    const bool is_first = sums == sums_.end();
    if (is_first) {
        sums = sums_.emplace(sums_.end());
        for (const Kind& kind : kinds_)
            for (const RegionBones& bones : kind.regions.bones) sums->push_back({label, kind.regions.kind, bones});
    }
    auto first = sums->begin();  // region of the kind
    for (const Kind& kind : kinds_) {
        const auto changes = kind.region_metrics.measure(positions);
        for (std::size_t r = 0; r < changes.size(); ++r) {
            const double to_pct = 100.0 / kind.region_metrics.rest_volume_m3(), change_pct = to_pct * changes[r].change_m3;
            RegionChange& sum = first[r];
            sum.rest_share_pct = to_pct * changes[r].rest_m3;
            sum.change_pct += change_pct;
            sum.abs_change_pct += to_pct * changes[r].abs_change_m3;
            sum.lowest_pct = is_first ? change_pct : std::min(sum.lowest_pct, change_pct);
            sum.highest_pct = is_first ? change_pct : std::max(sum.highest_pct, change_pct);
            ++sum.frames;
        }
        first += kind.regions.bones.size();
    }
}

std::vector<RegionChange> RegionRecord::changes() const
{
    std::vector<RegionChange> changes;
    for (const auto& sums : sums_)
        for (RegionChange change : sums) {
            if (change.rest_share_pct == 0.0) continue;  // a bone that carries no tet
            change.own_change_pct = 100.0 * change.change_pct / change.frames / change.rest_share_pct;
            change.change_pct /= change.frames;
            change.abs_change_pct /= change.frames;
            changes.push_back(change);
        }
    return changes;
}

nlohmann::json model_record(const pbs::Character& character)
{
    const pbs::RiggedModel& model = *character.artist->model;
    const pbs::RiggedBody& body = model.body;
    nlohmann::json record = {{"file", pbs::file_name(model.rig.file)}, {"containers", body.containers}};
    for (const auto* list : {"joints", "joints_dropped", "meshes", "animations"}) record[list] = nlohmann::json::array();
    for (const pbs::Bone& bone : body.skeleton.bones) record["joints"].push_back(bone.name);
    for (const pbs::DroppedJoint& joint : body.dropped)
        record["joints_dropped"].push_back({{"name", joint.name}, {"reason", joint.reason}});
    for (const pbs::RigMesh& mesh : body.binding.meshes) record["meshes"].push_back(mesh.name);
    for (const pbs::RigAnimation& animation : model.rig.animations) record["animations"].push_back(animation.name);
    record["animation"] = model.animation ? nlohmann::json(model.animation->name) : nlohmann::json();
    record["bind_pose_deg"] = body.bind_pose_deg;
    record["metres_per_unit"] = body.binding.metres_per_unit;
    record["extent_m"] = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).maxCoeff();
    if (!body.skeleton.bones.empty())
        record["weights_transferred_pct"] = pbs::carried_weight(body.skin, character.artist->weights, *character.surface,
                                                                character.mesh.tets, static_cast<int>(body.skeleton.bones.size()))
                                                .share_pct();
    return record;
}

const analysis::Columns<EmbeddedPoint> embedding_columns = [] {
    auto columns = MEMBER_COLUMNS(EmbeddedPoint, point, tet);
    for (const int k : {0, 1, 2, 3})
        columns.emplace_back(
            "barycentric_" + std::to_string(k), [k](auto& at) -> auto& { return at.barycentric[k]; });
    return columns;
}();

analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface)
{
    std::vector<EmbeddedPoint> points;
    for (int point = 0; point < surface.tet.size(); ++point) {
        const auto share = surface.barycentric.row(point);
        points.push_back({point, surface.tet(point), {share(0), share(1), share(2), share(3)}});
    }
    return table_of(embedding_columns, points);
}

void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const std::string& folder)
{
    pbs::write_vtp(folder + "/surface_rest.vtp", pbs::embedded_positions(surface, mesh.rest, mesh.tets), surface.triangles);
    embedding_table(surface).write(folder + "/embedding.csv");
}

}  // namespace experiments
