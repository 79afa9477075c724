// An independent reader of BVH for tests: every number by its place in the file, every rotation as a product of elementary matrices.
#pragma once

#include <Eigen/Geometry>

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

Bvh read(const std::string& path);

// Global joint frames for one row of channels, and for all channels zero.
std::vector<Eigen::Isometry3d> forward(const Bvh& bvh, const std::vector<double>& channels);
std::vector<Eigen::Isometry3d> zero_pose(const Bvh& bvh);

}  // namespace bvh_kinematics
