// Any bytes as the output of the clip reader's process, for two skeletons: poses of finite numbers, or an InputError.
#include "pbs/character/clip_bytes.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

using pbs::Vec3;

const pbs::Skeleton arm = {{{"upper", -1, Vec3(-1, 0, 0), Vec3::Zero()}, {"forearm", 0, Vec3::Zero(), Vec3(1, 0, 0)}}};
const pbs::Skeleton leg = {{{"pelvis", -1, Vec3(0, 1, 0), Vec3(0, 0.9, 0)}, {"thigh.L", 0, Vec3(0, 0.9, 0), Vec3(0, 0.5, 0)}}};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    for (const pbs::Skeleton& skeleton : {arm, leg}) try {
            const pbs::Clip clip = pbs::unpacked_clip(std::string(reinterpret_cast<const char*>(data), size), "clip.bvh");
            pbs::ClipSampling sampling;
            sampling.duration_s = std::min(1.0, (clip.frames() - 2) * clip.frame_time_s);
            const pbs::Motion motion = pbs::retarget(clip, skeleton, sampling);
            for (const pbs::Pose& pose : motion.steps)
                for (const auto& bone : pose)
                    if (!bone.matrix().allFinite()) std::abort();
        } catch (const pbs::InputError&) {
        }
    return 0;
}
