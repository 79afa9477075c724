// A user's own deformer: a program that reads poses and writes positions, or a shared library with the functions of pbskin_deformer.h.
#pragma once

#include "experiments/deformers/deformer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace experiments {

// Of an [[external]] table: either a command or a library.
struct ExternalOptions {
    std::vector<std::string> command;  // the program and its arguments, files with their absolute paths
    std::string library;               // path
    bool has_memory = false;           // it gets every time step, not only the frames
};

// A program runs once for all poses that the run foresees, and again where a pose was not foreseen. pbs::InputErrors tell what is wrong
// with the program, with its end if it fails, or with the files that it wrote.
std::unique_ptr<Deformer> make_program_deformer(const ExternalOptions& options);

// pbs::InputErrors: a library that cannot be loaded or lacks a function, and one that reports a failure.
std::unique_ptr<Deformer> make_library_deformer(const ExternalOptions& options);

}  // namespace experiments
