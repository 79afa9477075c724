# The headers as pages, with their shapes, units, errors and sources: the target `doc` writes BUILD/doc/html/index.html.
find_package(Doxygen 1.9)
if(NOT DOXYGEN_FOUND)
    return()
endif()
set(DOXYGEN_PROJECT_NAME pbs)
set(DOXYGEN_PROJECT_BRIEF "Position based skinning, its metrics and its reference")
set(DOXYGEN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/doc)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/README.md)
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_STRIP_FROM_INC_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_FULL_PATH_NAMES YES)
set(DOXYGEN_FILE_PATTERNS *.hpp)  # and the README below, which is listed by name
set(DOXYGEN_FILTER_PATTERNS "*.hpp=awk -f ${PROJECT_SOURCE_DIR}/cmake/documentation/comments.awk"
    "*.md=sed -E -f ${PROJECT_SOURCE_DIR}/cmake/documentation/links.sed")
set(DOXYGEN_MARKDOWN_SUPPORT NO)   # since the comments are plain text
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_EXTRACT_LOCAL_CLASSES NO)
set(DOXYGEN_HIDE_UNDOC_RELATIONS NO)
set(DOXYGEN_SOURCE_BROWSER YES)
set(DOXYGEN_FILTER_SOURCE_FILES NO)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_CLASS_GRAPH NO)
set(DOXYGEN_USE_MATHJAX NO)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
doxygen_add_docs(doc ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/pbs ${PROJECT_SOURCE_DIR}/reference_fem
    ${PROJECT_SOURCE_DIR}/analysis COMMENT "Writing the documentation of the headers")
