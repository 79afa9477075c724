#include "pbs/character/clip.hpp"

#include "pbs/geometry/assimp_files.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

namespace pbs {
namespace {

constexpr double shortest_frame_s = 1e-6, longest_frame_s = 1e3;
constexpr double farthest = 1e9;  // [clip's units]
constexpr int deepest_nesting = 500;
constexpr double free_key_rate_hz = 120.0;   // motions whose keys are not frames are sampled at this rate
constexpr double default_tick_rate_hz = 25;  // assimp's word for files that state none
constexpr int most_frames = 10'000'000;      // a day at 115 Hz

// The word that follows `label` after `from`; empty where there is none. `place` becomes where it was looked for.
std::string word_after(const std::string& text, const std::string& label, std::size_t& place)
{
    const std::size_t found = text.find(label, place);
    if (found == std::string::npos) return {};
    place = found + label.size();
    std::string word;
    std::istringstream(text.substr(place, 80)) >> word;
    return word;
}

double number_of(const std::string& word)
{
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    return *end == '\0' ? number : std::nan("");
}

void check_nesting(const std::string& text, std::size_t header_end, const std::string& path)
{
    int depth = 0;
    for (std::size_t place = 0; place < header_end; ++place) {
        depth += text[place] == '{' ? 1 : text[place] == '}' ? -1 : 0;
        if (depth > deepest_nesting)
            throw InputError(path, line_at(text, place), "JOINT", "", "nested deeper than " + std::to_string(deepest_nesting) + " joints");
    }
}

// Words after the frame time's line: the numbers of all frames, so many channels each. Fewer is assimp's to refuse; of more it reads a
// part.
void check_rows(const std::string& text, std::size_t place, double frames, const std::string& path)
{
    double channels = 0.0, words = 0.0;
    for (std::size_t at = 0; at < text.size();) {
        const std::string count = word_after(text, "CHANNELS", at);
        if (count.empty()) break;
        channels += number_of(count);
    }
    std::istringstream rest(text.substr(std::min(text.find('\n', place), text.size())));
    for (std::string word; rest >> word;) ++words;
    if (words > frames * channels)
        throw InputError(path, line_at(text, place) + 1, "motion", std::to_string(static_cast<long long>(words)) + " numbers",
                         "expected Frames times channels: " + std::to_string(static_cast<long long>(frames * channels)));
}

Eigen::Quaterniond to_eigen(const aiQuaternion& q)
{
    return Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
}
Vec3 to_eigen(const aiVector3D& v)
{
    return {v.x, v.y, v.z};
}

// A node of the file's hierarchy in the zero pose, and what moves it.
struct Node {
    Eigen::Isometry3d rest_local, rest_global;
    const aiNodeAnim* channel = nullptr;
};

Eigen::Isometry3d rigid_part(const aiMatrix4x4& transformation)
{
    aiVector3D scale, position;
    aiQuaternion rotation;
    transformation.Decompose(scale, rotation, position);
    return Eigen::Translation3d(to_eigen(position)) * to_eigen(rotation);
}

void collect_nodes(const aiNode* node, int parent, const std::map<std::string, const aiNodeAnim*>& channels, Clip& clip,
                   std::vector<Node>& nodes)
{
    const std::string name = node->mName.C_Str();
    Node own{rigid_part(node->mTransformation), Eigen::Isometry3d::Identity()};
    own.rest_global = parent < 0 ? own.rest_local : nodes[parent].rest_global * own.rest_local;
    if (const auto found = channels.find(name); found != channels.end()) own.channel = found->second;
    const int index = static_cast<int>(nodes.size());
    nodes.push_back(own);
    clip.joints.push_back(name);
    clip.parent.push_back(parent);
    for (unsigned child = 0; child < node->mNumChildren; ++child) collect_nodes(node->mChildren[child], index, channels, clip, nodes);
}

// The two keys around `tick` and how far it lies between them.
template <typename Key>
std::pair<const Key*, const Key*> keys_around(const Key* keys, unsigned count, double tick, double& between)
{
    const Key* after = std::upper_bound(keys, keys + count, tick, [](double time, const Key& key) { return time < key.mTime; });
    const Key* before = after == keys ? keys : after - 1;
    if (after == keys + count) after = before;
    between = after->mTime > before->mTime ? (tick - before->mTime) / (after->mTime - before->mTime) : 0.0;
    return {before, after};
}

Eigen::Quaterniond rotation_at(const Node& node, double tick)
{
    if (!node.channel || node.channel->mNumRotationKeys == 0) return Eigen::Quaterniond(node.rest_local.linear());
    double between = 0.0;
    const auto [before, after] = keys_around(node.channel->mRotationKeys, node.channel->mNumRotationKeys, tick, between);
    return between > 0.0 ? to_eigen(before->mValue).slerp(between, to_eigen(after->mValue)) : to_eigen(before->mValue);
}

Vec3 position_at(const Node& node, double tick)
{
    if (!node.channel || node.channel->mNumPositionKeys == 0) return node.rest_local.translation();
    double between = 0.0;
    const auto [before, after] = keys_around(node.channel->mPositionKeys, node.channel->mNumPositionKeys, tick, between);
    return between > 0.0 ? Vec3((1.0 - between) * to_eigen(before->mValue) + between * to_eigen(after->mValue)) : to_eigen(before->mValue);
}

// Expressed in world axes of the zero pose: G_parent L(t) G^-1, G the rest rotations; L(t) itself where those are the identity, as in BVH.
void sample_frame(const std::vector<Node>& nodes, double tick, int frame, Clip& clip)
{
    std::vector<Eigen::Quaterniond> local;
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        const Eigen::Quaterniond own(nodes[j].rest_global.linear());
        const Eigen::Quaterniond above =
            clip.parent[j] < 0 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(nodes[clip.parent[j]].rest_global.linear());
        local.push_back(above * rotation_at(nodes[j], tick) * own.conjugate());
        if (!local.back().coeffs().allFinite())
            throw InputError(clip.name, 0, "frame " + std::to_string(frame), clip.joints[j], "its rotation is not a finite number");
    }
    clip.local.push_back(local);

    const auto moved = std::find_if(nodes.begin(), nodes.end(), [](const Node& node) { return node.channel != nullptr; });
    const int above = clip.parent[moved - nodes.begin()];
    const Vec3 position = position_at(*moved, tick);
    clip.root.row(frame) = above < 0 ? position : Vec3(nodes[above].rest_global * position);
    if (!clip.root.row(frame).allFinite())
        throw InputError(clip.name, 0, "frame " + std::to_string(frame), clip.joints[moved - nodes.begin()],
                         "its position is not a finite number");
}

const aiScene& import(Assimp::Importer& importer, const std::string& path)
{
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene& scene = read_scene(importer, path, 0, "no clip that assimp can read: ");
    if (scene.mNumAnimations == 0 || scene.mAnimations[0]->mNumChannels == 0) throw InputError(path, 0, "", "", "holds no motion");
    return scene;
}

template <typename Key>
void check_times(const std::string& path, const std::string& joint, const Key* keys, unsigned count)
{
    for (unsigned k = 0; k < count; ++k)
        if (!std::isfinite(keys[k].mTime) || (k > 0 && keys[k].mTime < keys[k - 1].mTime))
            throw InputError(path, 0, joint + ", time of key " + std::to_string(k), std::to_string(keys[k].mTime),
                             "expected finite times that do not go back");
}

std::vector<Node> read_hierarchy(const aiScene& scene, Clip& clip)
{
    std::map<std::string, const aiNodeAnim*> channels;
    const aiAnimation& motion = *scene.mAnimations[0];
    for (unsigned c = 0; c < motion.mNumChannels; ++c) {
        const aiNodeAnim& channel = *motion.mChannels[c];
        const std::string joint = channel.mNodeName.C_Str();
        check_times(clip.name, joint, channel.mRotationKeys, channel.mNumRotationKeys);
        check_times(clip.name, joint, channel.mPositionKeys, channel.mNumPositionKeys);
        channels[joint] = &channel;
    }
    std::vector<Node> nodes;
    collect_nodes(scene.mRootNode, -1, channels, clip, nodes);
    std::set<std::string> seen;
    for (const std::string& joint : clip.joints)
        if (!seen.insert(joint).second) throw InputError(clip.name, 0, "JOINT", joint, "two joints have this name");
    clip.zero_pose.resize(static_cast<Eigen::Index>(nodes.size()), 3);
    for (std::size_t j = 0; j < nodes.size(); ++j) clip.zero_pose.row(j) = nodes[j].rest_global.translation();
    if (!clip.zero_pose.allFinite()) throw InputError(clip.name, 0, "OFFSET", "", "expected finite numbers");
    if (std::none_of(nodes.begin(), nodes.end(), [](const Node& node) { return node.channel; }))
        throw InputError(clip.name, 0, "", "", "its motion moves none of its joints");
    return nodes;
}

Clip clip_by_assimp(const std::string& path, bool bvh)
{
    Assimp::Importer importer;
    const aiScene& scene = import(importer, path);

    Clip clip;
    clip.name = path;
    const std::vector<Node> nodes = read_hierarchy(scene, clip);
    const aiAnimation& motion = *scene.mAnimations[0];
    const double tick_rate_hz = motion.mTicksPerSecond > 0.0 ? motion.mTicksPerSecond : default_tick_rate_hz;
    const double ticks_per_frame = bvh ? 1.0 : tick_rate_hz / free_key_rate_hz;
    clip.frame_time_s = ticks_per_frame / tick_rate_hz;
    const double frames = std::floor(motion.mDuration / ticks_per_frame + 1e-6) + 1.0;
    if (!(frames >= 1.0 && frames <= most_frames))
        throw InputError(path, 0, "frames", std::to_string(frames), "expected 1 to " + std::to_string(most_frames));
    clip.root.resize(static_cast<Eigen::Index>(frames), 3);
    for (int frame = 0; frame < static_cast<int>(frames); ++frame) sample_frame(nodes, frame * ticks_per_frame, frame, clip);
    return clip;
}

}  // namespace

bool is_bvh(const std::string& text, const std::string& path)
{
    constexpr std::string_view mark = "\xef\xbb\xbf", first_word = "HIERARCHY";
    const std::size_t word = text.find_first_not_of(" \t\r\n\v\f", text.starts_with(mark) ? mark.size() : 0);
    return lower_extension(path) == ".bvh" || (word != std::string::npos && text.compare(word, first_word.size(), first_word) == 0);
}

void check_bvh_header(const std::string& text, const std::string& path)
{
    std::size_t place = std::min(text.rfind("MOTION"), text.size());
    check_nesting(text, place, path);

    const std::string frames = word_after(text, "Frames:", place);
    const double number = number_of(frames);
    if (!frames.empty() && !(number >= 1.0 && number == std::floor(number)))
        throw InputError(path, line_at(text, place), "Frames", frames, "expected a whole number of frames, 1 or more");
    if (number > static_cast<double>(text.size()) / 2.0)
        throw InputError(path, line_at(text, place), "Frames", frames, "the file is too short to hold them");

    const std::string frame_time = word_after(text, "Time:", place);
    const double seconds = number_of(frame_time);
    if (!frame_time.empty() && !(seconds >= shortest_frame_s && seconds <= longest_frame_s))
        throw InputError(path, line_at(text, place), "Frame Time", frame_time, "expected a time from 1e-6 to 1000 s");
    check_rows(text, place, number, path);
}

void check_clip(const Clip& clip)
{
    const auto require_near = [&](const Positions& points) {
        if (!(points.array().abs() <= farthest).all())
            throw InputError(clip.name, 0, "positions", "", "expected finite numbers of at most 1e9");
    };
    require_near(clip.zero_pose);
    for (const auto& frame : clip.local)
        for (const Eigen::Quaterniond& rotation : frame)
            if (!(std::abs(rotation.norm() - 1.0) < 1e-3))
                throw InputError(clip.name, 0, "", "", "damaged: the reader's answer is not a whole clip");
    require_near(clip.root);
    if (!(clip.frame_time_s >= shortest_frame_s && clip.frame_time_s <= longest_frame_s))
        throw InputError(clip.name, 0, "frame time", std::to_string(clip.frame_time_s), "expected 1e-6 to 1000 s");
}

Clip read_clip(const std::string& path)
{
    const std::string text = read_text_file(path);
    const bool bvh = is_bvh(text, path);
    if (bvh) check_bvh_header(text, path);
    Clip clip = read_guarded(path, [&](const std::string& file) { return clip_by_assimp(file, bvh); });
    check_clip(clip);
    return clip;
}

}  // namespace pbs
