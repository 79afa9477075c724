# The program, its modules, and what it reads: bin/, lib/pbskin/ and share/pbskin/. A build has the same folders, so that the program
# looks in one place, beside its own executable.
set(data_folder share/pbskin)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${data_folder})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/paper_figures ${PROJECT_BINARY_DIR}/${data_folder}/paper_figures SYMBOLIC)

set(programs pbskin)
set(modules pbskin_native_plain)
foreach(target IN ITEMS pbskin_gmsh pbskin_fem)
    if(TARGET ${target})
        list(APPEND modules ${target})
    endif()
endforeach()
if(TARGET pbskin_distributed)
    list(APPEND programs pbskin_distributed)
endif()
install(TARGETS ${programs} RUNTIME DESTINATION bin COMPONENT program)
install(TARGETS ${modules} LIBRARY DESTINATION lib/pbskin COMPONENT program)

# The scripts that draw, with the viewer where it was built; its sources stay behind.
install(DIRECTORY paper_figures DESTINATION ${data_folder} COMPONENT program
    PATTERN __pycache__ EXCLUDE PATTERN node_modules EXCLUDE PATTERN viewer/src EXCLUDE PATTERN viewer/*.json EXCLUDE
    PATTERN viewer/*.mjs EXCLUDE PATTERN viewer/.npmrc EXCLUDE)
install(DIRECTORY experiments/scenes DESTINATION ${data_folder} COMPONENT program FILES_MATCHING PATTERN *.toml)
install(FILES CITATION.cff experiments/claims.toml DESTINATION ${data_folder} COMPONENT program)
