# Benchmarks by Google Benchmark: built with the tests, run by hand; a busy machine must not fail a test.
find_package(benchmark REQUIRED)
add_executable(benchmark_step benchmark/pbs/solver/step.cpp)
target_link_libraries(benchmark_step PRIVATE pbs_character pbs_method benchmark::benchmark)
set_target_properties(benchmark_step PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_executable(benchmark_blend benchmark/pbs/skinning/blend.cpp)
target_link_libraries(benchmark_blend PRIVATE pbs_character pbs_method benchmark::benchmark)
set_target_properties(benchmark_blend PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
