// An independent reader of BVH for tests: every number by its place in the file, every rotation as a product of
// elementary matrices.
#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace bvh_kinematics {

struct Joint {
    std::string name;  // "EndSite_<parent>" for end sites, as assimp names them
    int parent = -1;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    std::vector<std::string> channels;
    int first_channel = 0;
};

struct Bvh {
    std::vector<Joint> joints;
    double frame_time_s = 0.0;
    std::vector<std::vector<double>> frames;
};

inline Eigen::Isometry3d elementary(const std::string& channel, double value)
{
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(channel[0] - 'X');
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    if (channel.substr(1) == "position")
        transform.translation() = value * axis;
    else
        transform.linear() = Eigen::AngleAxisd(value * M_PI / 180.0, axis).toRotationMatrix();
    return transform;
}

inline Bvh read(const std::string& path)
{
    std::ifstream file(path);
    Bvh bvh;
    std::vector<int> open;
    int channels = 0, frames = 0;
    for (std::string word; file >> word && word != "Time:";) {
        if (word == "ROOT" || word == "JOINT" || word == "End") {
            Joint joint;
            file >> joint.name;
            joint.parent = open.empty() ? -1 : open.back();
            if (word == "End") joint.name = "EndSite_" + bvh.joints[joint.parent].name;
            bvh.joints.push_back(joint);
        } else if (word == "{") {
            open.push_back(static_cast<int>(bvh.joints.size()) - 1);
        } else if (word == "}") {
            open.pop_back();
        } else if (word == "OFFSET") {
            Eigen::Vector3d& offset = bvh.joints.back().offset;
            file >> offset(0) >> offset(1) >> offset(2);
        } else if (word == "CHANNELS") {
            int count = 0;
            file >> count;
            bvh.joints.back().channels.resize(count);
            bvh.joints.back().first_channel = channels;
            for (std::string& channel : bvh.joints.back().channels) file >> channel;
            channels += count;
        } else if (word == "Frames:") {
            file >> frames;
        }
    }
    file >> bvh.frame_time_s;
    bvh.frames.assign(frames, std::vector<double>(channels));
    for (auto& frame : bvh.frames)
        for (double& value : frame) file >> value;
    return bvh;
}

// Global joint frames for one row of channels.
inline std::vector<Eigen::Isometry3d> forward(const Bvh& bvh, const std::vector<double>& channels)
{
    std::vector<Eigen::Isometry3d> global;
    for (const Joint& joint : bvh.joints) {
        // then they replace the offset
        const bool moves = !joint.channels.empty() && joint.channels[0].substr(1) == "position";
        Eigen::Isometry3d own = Eigen::Isometry3d::Identity();
        if (!moves) own.translation() = joint.offset;
        for (std::size_t c = 0; c < joint.channels.size(); ++c)
            own = own * elementary(joint.channels[c], channels[joint.first_channel + static_cast<int>(c)]);
        global.push_back(joint.parent < 0 ? own : global[joint.parent] * own);
    }
    return global;
}

}  // namespace bvh_kinematics
