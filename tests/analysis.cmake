# Tests of the ruler.
find_package(GSL REQUIRED)
foreach(name IN ITEMS frame_metrics error_norms cross_section surface_volume statistics bootstrap
        state_hash atomic_file csv_table provenance)
    pbs_test(unit analysis/${name} analysis)
endforeach()
pbs_test(properties analysis/frame_metrics analysis)
pbs_test(verification analysis/bootstrap analysis GSL::gsl)
pbs_test(verification analysis/line_fit analysis GSL::gsl)
