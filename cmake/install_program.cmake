# The program, its modules and its data: bin/, lib/pbskin/ and share/pbskin/. A build has the same folders, so that the
# program finds them relative to its own executable.
set(data_folder share/pbskin)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/${data_folder})
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/paper_figures ${PROJECT_BINARY_DIR}/${data_folder}/paper_figures SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/experiments/references ${PROJECT_BINARY_DIR}/${data_folder}/references SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/experiments/records/full ${PROJECT_BINARY_DIR}/${data_folder}/records SYMBOLIC)

set(programs pbskin)
set(modules pbskin_native_plain)
foreach(target IN ITEMS pbskin_cholmod pbskin_fem pbskin_verification)
    if(TARGET ${target})
        list(APPEND modules ${target})
    endif()
endforeach()
install(TARGETS ${programs} RUNTIME DESTINATION bin COMPONENT program)
install(TARGETS ${modules} LIBRARY DESTINATION lib/pbskin COMPONENT program)

# The scripts that draw, with the viewer if it was built, but without the sources of the viewer.
install(DIRECTORY paper_figures DESTINATION ${data_folder} COMPONENT program
    PATTERN __pycache__ EXCLUDE PATTERN readme EXCLUDE PATTERN node_modules EXCLUDE PATTERN viewer/src EXCLUDE
    PATTERN viewer/*.json EXCLUDE PATTERN viewer/*.mjs EXCLUDE PATTERN viewer/.npmrc EXCLUDE)
install(DIRECTORY experiments/scenes DESTINATION ${data_folder} COMPONENT program FILES_MATCHING PATTERN *.toml
    PATTERN *.obj)
install(DIRECTORY experiments/references DESTINATION ${data_folder} COMPONENT program PATTERN references/export EXCLUDE)
install(DIRECTORY experiments/records/full/ DESTINATION ${data_folder}/records COMPONENT program
    PATTERN claims.json EXCLUDE PATTERN report.html EXCLUDE)
install(DIRECTORY experiments/deformers/external/examples DESTINATION ${data_folder} COMPONENT program)
install(FILES experiments/deformers/external/pbskin_deformer.h DESTINATION include COMPONENT program)
install(FILES CITATION.cff experiments/verdicts/claims.toml DESTINATION ${data_folder} COMPONENT program)

# Parameter sweeps, as bin/pbskin-sweep.
install(DIRECTORY experiments/sweeps DESTINATION ${data_folder} COMPONENT program USE_SOURCE_PERMISSIONS
    PATTERN __pycache__ EXCLUDE)
file(CREATE_LINK ../${data_folder}/sweeps/sweep.py ${PROJECT_BINARY_DIR}/pbskin-sweep SYMBOLIC)
install(FILES ${PROJECT_BINARY_DIR}/pbskin-sweep DESTINATION bin COMPONENT program)

# The manual pages, the manual of scene files and the completions, which the program generates.
find_program(PBS_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(PBS_PYTHON)
    set(pages_folder ${PROJECT_BINARY_DIR}/pages)
    set(pages_script ${PROJECT_SOURCE_DIR}/experiments/command_line/pages)
    add_custom_command(OUTPUT ${pages_folder}/pbskin.1 ${pages_folder}/pbskin-scene.5 ${pages_folder}/scene_manual.md
            ${pages_folder}/pbskin ${pages_folder}/_pbskin
        COMMAND $<TARGET_FILE:pbskin> --describe > command_line.json
        COMMAND ${PBS_PYTHON} -B ${pages_script}/make_pages.py command_line.json ${pages_folder} ${PROJECT_VERSION}
        DEPENDS pbskin ${pages_script}/make_pages.py ${pages_script}/man_page.py ${pages_script}/bash_completion.py
            ${pages_script}/zsh_completion.py ${pages_script}/scene_manual.py
        COMMENT "Writing the manual pages and the completions" VERBATIM)
    add_custom_target(pbskin_pages ALL DEPENDS ${pages_folder}/pbskin.1)
    install(FILES ${pages_folder}/pbskin.1 DESTINATION share/man/man1 COMPONENT program)
    install(FILES ${pages_folder}/pbskin-scene.5 DESTINATION share/man/man5 COMPONENT program)
    install(FILES ${pages_folder}/pbskin DESTINATION share/bash-completion/completions COMPONENT program)
    install(FILES ${pages_folder}/_pbskin DESTINATION share/zsh/site-functions COMPONENT program)
endif()
