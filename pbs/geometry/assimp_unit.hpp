// The unit of a file that assimp has read.
#pragma once

#include <assimp/scene.h>

namespace pbs {

// FBX states its unit in centimetres. COLLADA's is in the root's transform, and the other formats have none.
inline double metres_per_unit(const aiScene& scene)
{
    constexpr double metres_per_centimetre = 0.01;
    double centimetres = 0.0;
    float single = 0.0F;
    if (!scene.mMetaData) return 1.0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return metres_per_centimetre * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", single)) return metres_per_centimetre * static_cast<double>(single);
    return 1.0;
}

}  // namespace pbs
