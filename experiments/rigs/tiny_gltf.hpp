// tinygltf under a namespace of our own. libdraco, which assimp loads, holds another version of it under the same
// names, and the dynamic linker would mix the two. Its implementation is compiled once, in gltf_model.cpp, without
// images.
#pragma once

#define tinygltf pbs_tinygltf
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>
