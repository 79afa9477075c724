#include "experiments/run/solved_frames.hpp"

#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/process/terminal.hpp"

#include <array>
#include <cstring>
#include <filesystem>
#include <utility>

namespace experiments {
namespace {

constexpr double between_writings_s = 1.0;

std::string hash_of(const pbs::Pose& pose)
{
    analysis::StateHash hash;
    for (const Eigen::Isometry3d& bone : pose)
        hash.add_bytes(bone.data(), static_cast<std::size_t>(bone.matrix().size()) * sizeof(double));
    return hash.hex();
}

nlohmann::json json_of(const SolvedFrame& frame)
{
    nlohmann::json entry = {{"seconds", frame.step.seconds}, {"iterations", frame.step.iterations}};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(frame.positions.data());
    entry["positions"] =
        nlohmann::json::binary({bytes, bytes + static_cast<std::size_t>(frame.positions.size()) * sizeof(double)});
    if (frame.lowest_det_f) entry["lowest_det_f"] = *frame.lowest_det_f;
    entry["tips"] = nlohmann::json::array();
    for (const CreaseTip& tip : frame.tips)
        entry["tips"].push_back({tip.at_rest.x(), tip.at_rest.y(), tip.at_rest.z(), tip.radius_m});
    return entry;
}

// nlohmann::json::exception where the entry is damaged.
SolvedFrame frame_in(const nlohmann::json& entry, Eigen::Index vertices)
{
    SolvedFrame frame;
    const std::vector<std::uint8_t>& bytes = entry.at("positions").get_binary();
    frame.positions.resize(vertices, 3);
    if (bytes.size() != static_cast<std::size_t>(frame.positions.size()) * sizeof(double))
        throw nlohmann::json::other_error::create(0, "another number of positions", &entry);
    std::memcpy(frame.positions.data(), bytes.data(), bytes.size());
    frame.step.seconds = entry.at("seconds");
    frame.step.iterations = entry.at("iterations");
    if (entry.contains("lowest_det_f")) frame.lowest_det_f = entry.at("lowest_det_f");
    for (const std::array<double, 4>& tip : entry.at("tips").get<std::vector<std::array<double, 4>>>())
        frame.tips.push_back({{tip[0], tip[1], tip[2]}, tip[3]});
    return frame;
}

}  // namespace

SolvedFrames::SolvedFrames(std::string file, std::string key, double budget_s)
    : file_(std::move(file)), key_(std::move(key)), budget_s_(budget_s)
{
}

std::vector<std::optional<SolvedFrame>> SolvedFrames::find(const std::vector<pbs::Pose>& poses, Eigen::Index vertices)
{
    const std::vector<std::optional<SolvedFrame>> none(poses.size());
    frames_ = nlohmann::json::object();
    with_contact_.reset();
    if (file_.empty() || !std::filesystem::exists(file_)) return none;
    std::vector<std::optional<SolvedFrame>> found = none;
    try {
        nlohmann::json kept = nlohmann::json::from_cbor(analysis::read_text(file_));
        if (kept.at("key") != key_) return none;
        if (const nlohmann::json& frame = kept.at("with_contact"); !frame.is_null()) {
            if (kept.at("budget_s").get<double>() < budget_s_) return none;  // which may suffice for contact
            with_contact_ = FrameNotReached{frame.at("frame"), frame.at("cpu_seconds"), frame.at("bone")};
        }
        nlohmann::json& frames = kept.at("frames");
        for (std::size_t k = 0; k < poses.size(); ++k)
            if (const auto entry = frames.find(hash_of(poses[k])); entry != frames.end())
                found[k] = frame_in(*entry, vertices);
        frames_ = std::move(frames);
    } catch (const nlohmann::json::exception&) {
        warn({file_ + ": this file of solved frames is damaged: they are solved again"});
        return none;
    }
    return found;
}

void SolvedFrames::begin_without_contact(const FrameNotReached& frame)
{
    with_contact_ = frame;
    frames_ = nlohmann::json::object();
}

void SolvedFrames::add(const pbs::Pose& pose, const SolvedFrame& frame)
{
    if (!file_.empty())
        if (const std::string hash = hash_of(pose); !frames_.contains(hash)) frames_[hash] = json_of(frame);
    if (since_writing_.seconds() > between_writings_s) write();
}

void SolvedFrames::write()
{
    since_writing_ = {};
    if (file_.empty()) return;
    nlohmann::json kept = {{"key", key_}, {"budget_s", budget_s_}, {"with_contact", nullptr}, {"frames", frames_}};
    if (with_contact_) kept["with_contact"] = *with_contact_;
    const std::vector<std::uint8_t> bytes = nlohmann::json::to_cbor(kept);
    analysis::write_text_atomically(file_, {bytes.begin(), bytes.end()});
}

}  // namespace experiments
