#include "pbs/character/folded_skeleton.hpp"

#include "pbs/character/skeleton_order.hpp"

#include <algorithm>

namespace pbs {
namespace {

bool is_paired(const FoldedBone& bone)
{
    return bone.name.find('*') != std::string::npos;
}

std::string on_side(std::string name, char side)
{
    std::replace(name.begin(), name.end(), '*', side);
    return name;
}

}  // namespace

Skeleton fold_skeleton(const std::vector<FoldedBone>& bones, const std::string& file,
                       const std::function<Vec3(const std::string& point)>& point_named)
{
    std::vector<NamedJoint> joints;
    for (const char side : {'*', 'L', 'R'})
        for (const FoldedBone& bone : bones) {
            if (is_paired(bone) == (side == '*')) continue;
            const auto mean = [&](const std::vector<std::string>& points) -> Vec3 {
                Vec3 sum = Vec3::Zero();
                for (const std::string& point : points) sum += point_named(on_side(point, side));
                return sum / static_cast<double>(points.size());
            };
            joints.push_back({on_side(bone.name, side), on_side(bone.parent, side), mean(bone.head), mean(bone.tail)});
        }
    return order_skeleton(joints, file);
}

}  // namespace pbs
