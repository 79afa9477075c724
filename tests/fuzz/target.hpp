// What the fuzz targets share. A target defines try_input: its result is sound, or an InputError.
#pragma once

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace fuzz {

void try_input(const std::string& bytes);

inline void expect(bool sound)
{
    if (!sound) std::abort();
}

// The path of a file with these bytes.
inline std::string written(const std::string& name, const std::string& bytes)
{
    static const test_support::ScratchFolder folder;
    return folder.file(name, bytes);
}

}  // namespace fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        fuzz::try_input({reinterpret_cast<const char*>(data), size});
    } catch (const pbs::InputError&) {
    }
    return 0;
}
