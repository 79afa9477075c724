#define TINYGLTF_IMPLEMENTATION
#include "pbs/rig/tiny_gltf.hpp"
