#!/bin/bash
# Builds the manual in a separate folder: mkdocs in strict mode, Doxygen without warnings, and pages that must exist.
# usage: build_manual.sh SOURCE_DIR; skipped if mkdocs with Material or Doxygen is missing (packages-docs.txt)
set -euo pipefail
cd "$1"
for program in mkdocs doxygen git; do
    command -v "$program" > /dev/null || { echo "skipped: needs $program (packages-docs.txt)"; exit 77; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdocs build --quiet --strict --site-dir "$work/site" 2> "$work/log" || {
    cat "$work/log"
    grep -q "Unrecognised theme" "$work/log" && { echo "skipped: needs mkdocs-material"; exit 77; }
    exit 1
}
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $work"; } | doxygen - || { echo "Doxygen has warnings"; exit 1; }
for page in index tutorials/photographer explanation/lookup reference/schema bindings/python/README glossary; do
    [ -f "$work/site/$page.html" ] || [ -f "$work/site/${page%README}index.html" ] || { echo "no page $page"; exit 1; }
done
# The filter must turn the plain comments of the headers into text of functions and members.
grep -q "Prepares a plan in" "$work/docs-api/apply_8h.html" || { echo "apply.h is not documented"; exit 1; }
! grep -l "@verbatim\|@endverbatim" "$work"/docs-api/*.html || { echo "formulas are not rendered"; exit 1; }
