# The front door. Everything is built by CMake presets (CMakePresets.json) into build/; pictures go to out/.

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help demo test laws bench fuzz asan tsan tidy format examples docs clean install-dependencies release
MAKEFLAGS += --no-print-directory

FUZZ_SECONDS ?= 1200
export CTEST_PARALLEL_LEVEL ?= $(shell nproc)

raymo := build/release/apps/raymo/raymo
demo_model := examples/flange.raymo
demo_options := --size 900x540
demo_picture := out/demo.png

help: ## this list
	@echo "RAYMO: solids as exact as their equations"
	@echo
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1|\2/p' Makefile | while IFS='|' read -r target text; do \
	    printf '%-30s%s\n' "$$target" "$$text"; done

demo: release ## install what is missing, build, and draw the picture of the README
	@mkdir -p $(dir $(demo_picture))
	@if [ $(demo_picture) -nt $(raymo) ] && [ $(demo_picture) -nt $(demo_model) ]; then \
	    echo "$(demo_picture) is newer than the program and $(demo_model)"; \
	else \
	    set -x; $(raymo) render $(demo_model) $(demo_options) -o $(demo_picture); \
	fi
	@echo "The picture is $(CURDIR)/$(demo_picture)"

test: ## install what is missing, build, and pass the tests
	@scripts/install-dependencies build test
	@cmake --workflow --preset dev

laws: ## the laws of every solid, with the full number of rays
	@scripts/install-dependencies build test
	@[ -e build/dev/build.ninja ] || cmake --preset dev
	@cmake --build --preset dev --target raymo_laws
	@build/dev/tests/laws/raymo_laws --full

bench: ## measure against POV-Ray, with a gate on equal answers
	@scripts/install-dependencies build bench
	@cmake --workflow --preset bench
	@bench/run build/bench

fuzz: ## let libFuzzer attack the language for FUZZ_SECONDS (1200)
	@scripts/install-dependencies build lint
	@cmake --workflow --preset fuzz
	@scripts/fuzz build/fuzz $(FUZZ_SECONDS)

asan: ## the tests under the address and undefined-behaviour sanitizers
	@scripts/install-dependencies build test lint
	@cmake --workflow --preset asan

tsan: ## the tests under the thread sanitizer
	@scripts/install-dependencies build test lint
	@cmake --workflow --preset tsan

tidy: ## a second compiler with warnings as errors, then clang-tidy
	@scripts/install-dependencies build test lint
	@cmake --workflow --preset tidy
	@run-clang-tidy-19 -quiet -p build/tidy '/(raymo|apps)/'

format: ## format the sources
	@scripts/install-dependencies lint
	@scripts/sources | xargs clang-format-14 -i

examples: release ## draw the pictures of the examples
	@scripts/draw-examples $(raymo)

docs: examples demo ## rewrite the pages and pictures that follow from the sources
	@scripts/install-dependencies build test
	@[ -e build/dev/build.ninja ] || cmake --preset dev
	@cmake --build --preset dev --target manual_solids
	@build/dev/tests/house/manual_solids write docs/manual
	@tests/house/manual_pictures.py $(raymo) docs/manual --renew
	@cp $(demo_picture) docs/demo.png

clean: ## remove everything that was built
	rm -rf build out

install-dependencies: ## install the Debian packages that building and testing need
	@scripts/install-dependencies build test

release:
	@scripts/install-dependencies build
	@[ -e build/release/build.ninja ] || cmake --preset release
	@cmake --build --preset release --target raymo
