# lensprof: the front door. `make help` lists the targets.
SHELL := /bin/bash
.DEFAULT_GOAL := build
.PHONY: help page wheels platforms deb deb-try recipes release-check deps test-deps build program profiles demo check test sanitize soak bench bench-apply bench-fleet bench-frei0r bench-store bench-lookup bench-knowledge bench-fields bench-online install abi abi-baseline abi-headers lint format docs docs-update gallery clean

JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
WERROR ?= OFF
# Made by profiles/tools; never formatted.
TABLES := (emor|prior|typical)_table\.

help: ## list the targets
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /  make \1\t/' | expand -t 20

deps: ## install the packages of packages.txt that are missing
	@cmake/install-packages.sh packages.txt

test-deps: deps ## install what only tests and benchmarks need (packages-test.txt)
	@cmake/install-packages.sh packages-test.txt

build: ## build the library and the program build/lensprof
	cmake --preset release -DLENSPROF_WERROR=$(WERROR)
	cmake --build --preset release -j $(JOBS)

profiles: program ## a database of the installed Lensfun data (liblensfun-data-v1): build/lensfun.db
	@cmake/install-packages.sh packages-profiles.txt
	rm -f build/lensfun.db.part
	build/lensprof profile import --db build/lensfun.db.part /usr/share/lensfun/version_1/*.xml
	mv build/lensfun.db.part build/lensfun.db
	cp profiles/lensfun-LICENSE.txt build/lensfun.db.LICENSE.txt
	@echo 'try: build/lensprof query --db build/lensfun.db --lens "Canon EF 24-70mm f/2.8L USM" --focal 40 --aperture 3.2'

program: deps ## build the program alone: build/lensprof
	cmake --preset release -DLENSPROF_TESTS=OFF >/dev/null
	cmake --build --preset release -j $(JOBS) --target lensprof_program

demo: program ## the whole job, from pictures to a page about them: rendered ones, or yours with PHOTOS=folder
	examples/demo.sh "$(PHOTOS)"

check: test-deps build ## the quick tests, a few minutes
	ctest --preset check -j $(JOBS)

# Warnings end the project's own test run, with GCC and, in the sanitizer build, with clang.
test: WERROR := ON
test: test-deps build ## all tests of the release build but the campaigns of `make soak`
	ctest --preset all -j $(JOBS)

sanitize: WERROR := ON
sanitize: test-deps ## build and run the C and C++ tests under address and undefined behaviour sanitizers
	cmake --preset sanitize -DLENSPROF_WERROR=$(WERROR)
	cmake --build --preset sanitize -j $(JOBS)
	ctest --preset sanitize -j $(JOBS)

soak: test-deps build ## the campaigns in full, and under sanitizers: nightly, an hour or more
	ctest --preset soak -j $(JOBS)
	cmake --preset sanitize
	cmake --build --preset sanitize -j $(JOBS) --target all soak_tests
	ctest --preset soak-sanitize -j $(JOBS)

bench: test-deps build ## compare accuracy and speed with other programs
	tests/bench/run.sh
	$(MAKE) bench-apply
	$(MAKE) bench-store
	$(MAKE) bench-lookup

bench-apply: build ## measure how fast profiles are applied, compared with memcpy, Lensfun, OpenCV and a plain loop
	@cmake/install-packages.sh packages-bench.txt
	tests/bench/apply.sh

bench-fleet: build ## measure lensprof.fleet: a plain loop, and Dask with one and two workers
	tests/bench/fleet.sh

bench-frei0r: build ## measure the video filter in FFmpeg, compared with no filter, FFmpeg's vignette and liblensfun
	@cmake/install-packages.sh packages-test.txt
	tests/bench/frei0r.sh

bench-store: build ## measure the store with 100 000 profiles
	tests/bench/store.sh

bench-lookup: build ## measure lookups between stored settings on Lensfun's data, compared with Lensfun's rule
	@cmake/install-packages.sh packages-test.txt
	tests/bench/run.sh --lookup

wheels: ## make the wheels of all platforms and the photograph library's in dist/ (TARGETS="linux-x86_64 ..." makes some)
	@cmake/install-packages.sh packages-wheels.txt
	packaging/wheels/build.py $(TARGETS)
	$(if $(TARGETS),,packaging/wheels/build.py --photo)

deb: deps ## build the Debian packages of what is committed: build/deb
	@cmake/install-packages.sh packages-profiles.txt
	@cmake/install-packages.sh packages-deb.txt
	packaging/debian/build.sh

deb-try: deb ## install them in a minimal Debian 12, run their tests there, and remove them; needs root
	packaging/debian/build.sh --try

recipes: ## set version and hash in the recipes of conda-forge, Homebrew and vcpkg, and check them
	@cmake/install-packages.sh packages-wheels.txt
	packaging/wheels/build.py --sdist
	packaging/recipes/recipes.py
	packaging/recipes/recipes.py --try

release-check: ## what must hold before a release: versions, CHANGELOG, ABI, wheels, sources, hashes
	packaging/release_check.py

page: ## make the page in the browser, one file: build/page/lensprof.html
	@cmake/install-packages.sh packages-wheels.txt
	@cmake/install-packages.sh packages-page.txt
	bindings/web/build.sh

platforms: wheels page build ## run the wheels on other systems (Debian 11 and 13, arm64, musl, Windows), languages, fleets, the page
	@cmake/install-packages.sh packages-platforms.txt
	tests/browser/run.sh build/page/lensprof.html build/lensprof || [ $$? = 77 ]
	packaging/wheels/try.sh || [ $$? = 77 ]
	tests/bindings/run.sh build/liblensprof.so || [ $$? = 77 ]
	tests/python/fleet.sh

SEQUENCES ?= 60

bench-knowledge: build ## measure what prior knowledge of camera and lens gains (SEQUENCES=N)
	@cmake/install-packages.sh packages-test.txt
	tests/bench/run.sh --only knowledge --sequences $(SEQUENCES)

bench-fields: build ## measure one shading of many pictures compared with BaSiC (basicpy of PyPI, in build/basicpy: 6 GB)
	test -x build/basicpy/bin/python || python3 -m venv build/basicpy
	build/basicpy/bin/pip install -q basicpy==2.0.0 scipy
	LENSPROF_LIBRARY=build/liblensprof.so PYTHONPATH=bindings/python build/basicpy/bin/python -B tests/bench/fields.py

bench-online: build ## measure the fit of a camera that runs: cost per frame, coverage of its errors, drift, the batch fit
	@tests/bench/online.sh

install: deps ## install under PREFIX (default /usr/local), with the database of `make profiles` where that was made
	cmake --preset release -DLENSPROF_TESTS=OFF >/dev/null
	cmake --build --preset release -j $(JOBS)
	cmake --install build --prefix $(PREFIX)

abi-baseline: ## write tests/install/abi-baseline.xml again, after a compatible change of the ABI
	python3 tests/install/abi_check.py write

abi-headers: ## save the public headers as those of this release, whose programs all later libraries must serve
	mkdir -p tests/install/headers-0.3/lensprof
	cp include/lensprof/*.h tests/install/headers-0.3/lensprof/

abi: ## generate the tables of all bindings and abi_dump.c from the public headers (package python3-pycparser)
	python3 bindings/tools/make_abi.py

lint: test-deps ## format, cppcheck, clang's warnings and clang-tidy over all sources: some ten minutes
	@cmake/install-packages.sh packages-lint.txt
	cmake --preset release -B build/lint -DLENSPROF_JOIN=OFF -DLENSPROF_TESTS=OFF >/dev/null
	tests/lint/lint.sh build/lint

format: ## format C and C++ with .clang-format (package clang-format)
	git ls-files -co --exclude-standard '*.c' '*.h' '*.cpp' '*.hpp' | grep -vE '$(TABLES)' | xargs clang-format -i

docs: ## the manual with the API reference, and the page if it was made: build/docs/index.html (packages-docs.txt)
	@cmake/install-packages.sh packages-docs.txt
	mkdir -p build && rm -rf build/docs build/docs-api
	doxygen docs/Doxyfile
	mkdocs build --quiet --strict
	mv build/docs-api build/docs/api
	test ! -e build/page/lensprof.html || cp build/page/lensprof.html build/docs/
	@echo 'open build/docs/index.html'

# After a change of the program's help, its output or the schema; look at the difference before you commit it.
gallery: program ## draw the picture of the README again: docs/gallery.svg
	python3 -B docs/tools/gallery.py build/lensprof docs/gallery.svg

docs-update: ## write generated pages and the outputs in the tutorials again
	@test -f build/CMakeCache.txt || $(MAKE) build
	cmake --build build -j $(JOBS) --target lensprof lensprof_program lensprof_core_archive
	python3 -B docs/tools/commands.py . build/lensprof
	python3 -B docs/tools/schema.py .
	python3 -B docs/tools/draw_gamma.py docs/explanation/gamma.svg
	python3 -B tests/docs/run_tutorials.py --build build --python "$$(sed -n 's/^LENSPROF_PYTHON_WITH_NUMPY:INTERNAL=//p' build/CMakeCache.txt)" \
		--update docs/tutorials/*.md docs/howto/hugin-project.md docs/howto/your-lens-*.md

clean: ## remove build/
	rm -rf build
