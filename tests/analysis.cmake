# Tests of the ruler.
foreach(name IN ITEMS frame_metrics state_hash atomic_file csv_table provenance)
    pbs_test(unit analysis/${name} analysis)
endforeach()
pbs_test(properties analysis/frame_metrics analysis)
