# Tests of the ruler.
find_package(GSL REQUIRED)
foreach(name IN ITEMS frame_metrics error_norms cross_section surface_volume statistics bootstrap grid_convergence
        stability_outcome state_hash atomic_file csv_table provenance
        claims case_record case_row verdict claims_report claims_table text_columns measurement)
    pbs_test(unit analysis/${name} analysis)
endforeach()
pbs_test(unit analysis/pareto_front analysis)
pbs_test(unit analysis/edge_strain analysis)
pbs_test(unit analysis/check/check_judgement analysis)
pbs_test(unit analysis/check/github_report analysis)
pbs_test(unit analysis/region_volume analysis)
foreach(name IN ITEMS section_outline smoothness)
    pbs_test(unit analysis/${name} analysis)
endforeach()
pbs_test(properties analysis/frame_metrics analysis)
pbs_test(verification analysis/bootstrap analysis GSL::gsl)
pbs_test(verification analysis/line_fit analysis GSL::gsl)
pbs_test(verification analysis/damped_oscillation analysis)
pbs_test(verification analysis/grid_convergence analysis)
pbs_test(unit analysis/minimise analysis GSL::gsl)

# The project's own claims, read by the tests of claims and verdicts.
foreach(name IN ITEMS claims verdict)
    target_compile_definitions(test_unit_analysis_${name} PRIVATE PBS_CLAIMS_FILE="${PROJECT_SOURCE_DIR}/experiments/verdicts/claims.toml")
endforeach()
